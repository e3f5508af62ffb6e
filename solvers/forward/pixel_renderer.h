// Pixels of a planned render.
#pragma once
#include <memory>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/image/image.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/forward/forward_scene.h"
#include "ibrdf/solvers/forward/known_brdf.h"
#include "ibrdf/solvers/forward/render_plan.h"
#include "ibrdf/solvers/forward/split_radiance.h"
#include "ibrdf/transport/radiance_renderer.h"

namespace ibrdf {

// How the points came to their radiance.
struct PixelCounts {
  size_t points = 0;
  size_t interpolated = 0;  // points, by their normal from others
  size_t refined = 0;       // pixels that were sampled anew
};

// One sample per pixel in a preview, whose pixels are sampled anew where their
// centre does not stand for them; all samples at once at reference quality.
// References are kept.
class PixelRenderer {
 public:
  // `progress` may be empty.
  PixelRenderer(const Problem& problem, const ForwardScene& scene,
                const PlannedRender& planned, int num_threads,
                const RadianceRenderer::Progress& progress);

  // All passes; 0 outside the object. kInterrupted where `progress` stops it.
  StatusOr<Image> Render();

  const PixelCounts& counts() const { return counts_; }

 private:
  // Shares of the progress, [begin, end].
  struct Span {
    double begin, end;
  };

  StatusOr<Image> RenderPoints(const std::vector<ShadingPoint>& points,
                               const Span& span);
  // Radiance of the unpainted object, and that of its matte part.
  Status RenderUnpainted(const std::vector<ShadingPoint>& points,
                         const Span& span, double* L_o);
  Status RenderMatte(const std::vector<ShadingPoint>& points, const Span& span,
                     double* L_o);
  // By a split of the reflectance that is kept for later points.
  Status RenderByNormals(const KnownBrdf& brdf,
                         const std::vector<ShadingPoint>& points,
                         const Span& span, std::unique_ptr<SplitRadiance>* kept,
                         double* L_o);
  bool ByNormals() const;
  // The progress of a call that goes through `span`.
  RadianceRenderer::Progress Within(const Span& span) const;
  // Renders the pixels anew whose centre does not stand for them.
  Status Refine(const Span& span, Image* image);

  const Problem& problem_;
  const ForwardScene& scene_;
  const PlannedRender& planned_;
  const int num_threads_;
  const RadianceRenderer::Progress& progress_;
  PixelCounts counts_;
  // The object's radiance, and its matte part's; null before they are asked
  // for.
  std::unique_ptr<SplitRadiance> split_, matte_split_;
};

}  // namespace ibrdf
