// The keys of the section `reflectance`.
#include <string>

#include "ibrdf/io/problem_schema_rows.h"
#include "ibrdf/io/problem_section_keys.h"

namespace ibrdf {
namespace problem_keys {
namespace {

constexpr int kMaxLobes = 8;

constexpr unsigned kUnknownReflectance = kUsedByJoint | kUsedByReflectance;
constexpr unsigned kKnownReflectance = kUsedByIllumination | kUsedByRender;

Keys UnknownReflectanceKeys() {
  return {
      Row("reflectance",
          "The BRDF of the object: a trained model where it is unknown, else "
          "`known`."),
      Row("reflectance.model",
          "Trained model of unknown BRDFs, from `ibrdf_train`. `default` and "
          "`broad` come with the programs. A folder is taken as `auto`, with "
          "its `default.ibrdf` and `broad.ibrdf`.")
          .Path(".ibrdf", "auto",
                {{"auto",
                  "`default`, or, of one unknown material, the mean of "
                  "`default` and `broad`, by evidence. A known light needs "
                  "`broad` only where `default` leaves more than noise."},
                 {"default", "Trained on MERL: plastic, paint, metal, fabric."},
                 {"broad",
                  "Trained on two databases and on analytic materials, with a "
                  "Lambertian lobe: nearer to paper, felt and what renderers "
                  "make, no nearer to plastic and metal."}})
          .UsedBy(kUnknownReflectance),
      Row("reflectance.lobes",
          "Number of lobes of the flow. Each has a code of the embedding and "
          "an RGB colour. A Lambertian lobe of the model is not counted.")
          .Integer(1, kMaxLobes, "2")
          .UsedBy(kUnknownReflectance),
      Row("reflectance.prior_sigma",
          "Standard deviation of the Gaussian prior of codes. It holds for "
          "lobes that the model has no fits of, and for all with "
          "`solver.estimator: maximum`.")
          .Number(kPositive, "0.5")
          .UsedBy(kUnknownReflectance),
      Row("reflectance.variation",
          "How the reflectance varies over the object.")
          .Choice("auto",
                  {{"auto",
                    "`albedo` where pixels of like normals far apart differ in "
                    "colour, or where colour has sharp edges that paint "
                    "explains better than mirrored light; else `none`."},
                   {"none", "One material."},
                   {"albedo",
                    "One gloss over paint: the albedo of what is matte is "
                    "found at every pixel, in `albedo.exr`."},
                   {"labels",
                    "Several materials, where `reflectance.labels` says."}})
          .UsedBy(kUnknownReflectance),
      Row("reflectance.labels",
          "Image of the materials, of the image's size: pixels of one value "
          "are of one material. At most 16 values on the object, without "
          "smoothed edges. Implies `variation: labels`.")
          .Path(".png", "",
                {{"auto",
                  "The photograph tells how many materials there are, up to "
                  "five, and where; `labels.png` shows them."}})
          .UsedBy(kUnknownReflectance)};
}

Keys KnownReflectanceKeys() {
  return {Row("reflectance.known",
              "The known BRDF: a MERL table, or one of `brdf`, `lambertian`, "
              "`cook_torrance` and `principled`, and perhaps paint over it, "
              "`albedo`.")
              .PathOrMap(".binary")
              .Without("needed")
              .UsedBy(kKnownReflectance),
          Row("reflectance.known.brdf", "A MERL table, to be painted.")
              .Path(".binary")
              .UsedBy(kKnownReflectance),
          Row("reflectance.known.albedo",
              "Paint: an image of the render's size, values >= 0. The matte "
              "part of the BRDF is multiplied by it, pixel by pixel; the gloss "
              "stays ([programs](programs.md#painted-objects)).")
              .Path(".exr, .hdr, .pfm, .tif, .npy")
              .UsedBy(kUsedByRender),
          Row("reflectance.known.unpainted_albedo",
              "What the values of `albedo` are divided by. `auto`: the "
              "hemispherical albedo of the matte part, as for `albedo.exr` of "
              "a result.")
              .AutoOrTriple(kPositive, "1")
              .Needs("reflectance.known.albedo")
              .UsedBy(kUsedByRender),
          Row("reflectance.known.lambertian", "Albedo of a matte surface.")
              .OneOrTriple(kUnitInterval, "")
              .UsedBy(kKnownReflectance)};
}

Keys CookTorranceKeys() {
  const std::string lobe = "reflectance.known.cook_torrance";
  return {
      Row(lobe,
          "A Lambertian part and one microfacet lobe (Cook and Torrance 1982).")
          .UsedBy(kKnownReflectance),
      Row(lobe + ".diffuse", "Albedo of the Lambertian part.")
          .OneOrTriple(kUnitInterval, "0.3")
          .UsedBy(kKnownReflectance),
      Row(lobe + ".specular", "Factor of the microfacet lobe.")
          .OneOrTriple(kNotNegative, "1")
          .UsedBy(kKnownReflectance),
      Row(lobe + ".roughness", "Root mean square slope of the microfacets.")
          .OneOrTriple({1e-3, 10.0, true, true}, "0.1")
          .UsedBy(kKnownReflectance),
      Row(lobe + ".f0", "Reflectance of a microfacet at normal incidence.")
          .OneOrTriple(kUnitInterval, "0.04")
          .UsedBy(kKnownReflectance)};
}

Keys PrincipledKeys() {
  const std::string principled = "reflectance.known.principled";
  return {Row(principled,
              "The principled BRDF's base (Burley 2012): a diffuse part and "
              "one GGX lobe. A render takes textures "
              "([programs](programs.md#textures)).")
              .UsedBy(kKnownReflectance),
          Row(principled + ".base", "Base colour; a PNG texture is in sRGB.")
              .TripleOrPath(kUnitInterval, "0.5")
              .UsedBy(kKnownReflectance),
          Row(principled + ".roughness",
              "Square root of GGX's alpha. Below 0.03 it is rendered as 0.03.")
              .NumberOrPath(kUnitInterval, "0.5")
              .UsedBy(kKnownReflectance),
          Row(principled + ".metallic", "0: dielectric, 1: metal.")
              .NumberOrPath(kUnitInterval, "0")
              .UsedBy(kKnownReflectance),
          Row(principled + ".specular",
              "F0 of the dielectric part divided by 0.08.")
              .NumberOrPath({0.0, 12.5, true, true}, "0.5")
              .UsedBy(kKnownReflectance)};
}

}  // namespace

Keys ReflectanceKeys() {
  return Join({UnknownReflectanceKeys(), KnownReflectanceKeys(),
               CookTorranceKeys(), PrincipledKeys()});
}

}  // namespace problem_keys
}  // namespace ibrdf
