// What ways to render a scene cost: seconds of one idle core, predicted from
// counts. No clock decides, so that a scene is rendered alike anywhere.
#pragma once

namespace ibrdf {

double QuadratureSeconds(double points);
double HarmonicSeconds(int order, double points);
// spread: Gaussians beside those of bright spots.
double GaussianSeconds(int spread, double points);
// By normal, where harmonics up to `order` hold the radiance; order < 0: it has
// more detail than is known.
double ReflectanceMapSeconds(int order);

}  // namespace ibrdf
