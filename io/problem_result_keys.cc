// The keys of what is made of an estimate or a scene: `truth`, `texture`,
// `uncertainty`, `noise` and `quality`.
#include <string>

#include "ibrdf/io/problem_schema_rows.h"
#include "ibrdf/io/problem_section_keys.h"

namespace ibrdf {
namespace problem_keys {
namespace {

constexpr int kMaxTextureSide = 4096;
constexpr int kMaxOrder = 10;

}  // namespace

Keys TruthKeys() {
  return {
      Row("truth",
          "The truth, where it is known. The results then have metrics against "
          "it.")
          .UsedBy(kUsedBySolve),
      Row("truth.brdf", "True BRDF, a MERL table.")
          .Path(".binary")
          .UsedBy(kUsedBySolve)
          .Example("true_brdf.binary"),
      Row("truth.illumination", "True environment map.")
          .Path(kMapFiles)
          .UsedBy(kUsedBySolve)
          .Example("true_map.exr"),
      Row("truth.frame", "The frame of the true map, as `illumination.frame`.")
          .Choice("auto", AutoOrMapFrames())
          .Needs("truth.illumination")
          .UsedBy(kUsedBySolve)};
}

Keys TextureKeys() {
  const std::string needs = "problem: textures";
  Keys keys = {
      Row("texture",
          "The picture that the surface is mapped to: by the mesh's own "
          "texture coordinates, else by charts of ours; of a sphere by "
          "longitude and latitude."),
      Row("texture.width", "Its width.")
          .Integer(1, kMaxTextureSide, "256")
          .Unit("texels"),
      Row("texture.height", "Its height.")
          .Integer(1, kMaxTextureSide, "256")
          .Unit("texels"),
      Row("uncertainty",
          "What `ibrdf_uncertainty` takes the views to tell of a texel "
          "([theory](theory.md))."),
      Row("uncertainty.evaluator", "The model of what a texel reflects.")
          .Choice(
              "angular",
              {{"angular",
                "Radiance at every view, with Fresnel's reflectance and "
                "masking; roughness, gloss and albedo are unknown."},
               {"spectrum",
                "The power of each degree of the harmonics, as published "
                "(Wiersma et al. 2025); roughness and gloss are unknown."}}),
      Row("uncertainty.order", "Highest degree of the harmonics.")
          .Integer(1, kMaxOrder, "5"),
      Row("uncertainty.sigma",
          "Standard deviation of radiance: what noise and a simple model may "
          "miss. `auto`: 0.07 with `angular`, 0.05 with `spectrum`.")
          .AutoOrNumber(kPositive)
          .Unit("mean radiance of the light"),
      Row("uncertainty.shadows", "Whether the object hides light from itself.")
          .Choice(
              "mirror",
              {{"none", "It hides none, as published."},
               {"mirror",
                "Light that it hides in the mirror direction is left out, and "
                "what it hides of the irradiance."}}),
      Row("uncertainty.prior",
          "How probable roughness and gloss are before a photograph.")
          .Choice("uniform",
                  {{"uniform", "All values alike."},
                   {"materials",
                    "As the 100 materials of the MERL database have them."}})};
  for (ProblemKey& key : keys) {
    key.used_by = kUsedByTextures;
    if (!key.Parent().empty()) key.needs = needs;
  }
  return keys;
}

Keys RenderKeys() {
  return {Row("noise",
              "Standard deviation of the log-normal noise that a render is "
              "multiplied by.")
              .Number(kUnitInterval, "0")
              .Unit("natural log")
              .UsedBy(kUsedByRender),
          Row("quality", "How exactly the image is rendered.")
              .Choice("reference",
                      {{"preview",
                        "One sample per pixel, four where neighbours differ, "
                        "and a coarser quadrature."},
                       {"reference",
                        "Four samples per pixel and a fine quadrature."}})
              .UsedBy(kUsedByRender)};
}

}  // namespace problem_keys
}  // namespace ibrdf
