// The files that ibrdf_render writes.
#pragma once
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/solvers/forward/render_scene.h"

namespace ibrdf {

struct RenderOutputs {
  // Empty: not written. With several views `image` is a folder, and there is no
  // `mask`.
  std::string image, mask, illumination, brdf;
};

// Makes folders, and refuses, before time is spent, what cannot be written or
// is a file that the problem reads.
Status CheckRenderOutputs(const Problem& problem, const RenderOutputs& out);
// The same of one of several views, and what its files are: render.exr with
// its picture and mask.png in views/NAME of the folder.
StatusOr<RenderOutputs> CheckViewOutputs(const Problem& problem,
                                         const RenderOutputs& out,
                                         const std::string& view);

// Radiance, a picture of it beside it, and what else is asked for.
Status WriteRenderOutputs(const Problem& problem, const RenderedScene& rendered,
                          const RenderOutputs& out);

}  // namespace ibrdf
