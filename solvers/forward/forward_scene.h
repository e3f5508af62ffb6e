// The files of a renderable problem, read.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/image/image.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/forward/known_brdf.h"
#include "ibrdf/solvers/forward/known_paint.h"
#include "ibrdf/solvers/forward/known_texture.h"

namespace ibrdf {

// What the camera sees.
struct ViewPoints {
  // By view angle: points of one angle share their work when they are rendered
  // together.
  std::vector<ShadingPoint> points;
  Mask mask;  // pixels with a point
  Scene scene = Scene::UnitSphere();
};

struct ForwardScene {
  ViewPoints view;
  Image map;                        // the illumination
  KnownBrdf brdf;                   // its Lookup() refers to this
  std::optional<KnownPaint> paint;  // over it
  // Set: in place of `brdf`, which is then its mean over the points; and the
  // material of the point of least roughness.
  std::optional<KnownTexture> texture;
  BrdfFunction sharpest;
  // What the object shows itself: the BRDF's, or a paint's mean; empty where
  // nothing casts shadows.
  BrdfGrid grid;
  // Whether the object may see itself as in a mirror: it casts shadows, and its
  // lobe is narrower than kNarrowLobe.
  bool narrow_lobe = false;
  std::vector<std::string> warnings;  // of the inputs: sentences for the user
};

// What all views share.
struct ForwardInputs {
  Scene scene = Scene::UnitSphere();
  Image map;
  KnownBrdf brdf;
  std::optional<KnownTexture> texture;  // in its place
  std::vector<std::string> warnings;
};

// Sorts points by the angle between normal and view.
void SortByAngle(std::vector<ShadingPoint>* points);

// SamplesPerSide(problem.quality) squared points per pixel. `warnings`: as of
// LoadScene.
StatusOr<ViewPoints> FindViewPoints(
    const Problem& problem, int num_threads = 0,
    std::vector<std::string>* warnings = nullptr);

// Two at reference quality; one in a preview, which samples some pixels anew
// with as many as the reference (PixelRenderer::Refine).
inline constexpr int kMostSamplesPerSide = 2;
int SamplesPerSide(RenderQuality quality);

// What a render returns whose progress stops it.
Status RenderInterrupted(const Problem& problem);

// Reads geometry, illumination and reflectance. CheckRenderable first.
StatusOr<ForwardInputs> LoadForwardInputs(const Problem& problem);

// Before the problem's camera.
StatusOr<ForwardScene> PlaceForwardScene(const Problem& problem,
                                         ForwardInputs inputs, int num_threads);

}  // namespace ibrdf
