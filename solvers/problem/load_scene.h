// The known parts of a problem: its shape, light and reflectance.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/brdf/disney.h"
#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/image/image.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/surface/surface_atlas.h"

namespace ibrdf {

// `warnings` receives sentences for the user; it may be null.

// The geometry of a problem before its camera; reads its mesh, normal map or
// depth. width, height: of the image, pixels.
StatusOr<Scene> LoadScene(const Problem& problem, int width, int height,
                          std::vector<std::string>* warnings = nullptr);

struct TexturedSurface {
  Scene scene = Scene::UnitSphere();
  SurfaceAtlas atlas;
};

// The sphere or mesh of CheckTextures, whose hits have the texture coordinates
// of the atlas: those of the file, or charts of our own. At least one texel.
StatusOr<TexturedSurface> LoadTexturedSurface(
    const Problem& problem, std::vector<std::string>* warnings);

// The known illumination in the library's frame: the file (ReadMap), or the sky
// made into a map of the problem's size. `frame` receives that of the file.
StatusOr<Image> LoadKnownIllumination(
    const IlluminationSpec& illumination,
    std::vector<std::string>* warnings = nullptr, MapFrame* frame = nullptr);

// Rendered in place of all below.
inline constexpr double kMinRoughness = 0.03;
// The BRDF of the numbers; textures are not looked at.
Disney PrincipledBrdf(const PrincipledSpec& spec);

// The known reflectance as a table: the file, or the analytic BRDF at the bin
// centres.
StatusOr<MerlTable> LoadKnownReflectance(const ReflectanceSpec& reflectance);

}  // namespace ibrdf
