// The keys of the section `image`.
#include <string>

#include "ibrdf/io/image_limits.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/io/problem_schema_rows.h"
#include "ibrdf/io/problem_section_keys.h"

namespace ibrdf {
namespace problem_keys {
namespace {

Keys ImageFileKeys() {
  return {
      Row("image", "The image to explain, or the size of the image to render.")
          .Without("needed")
          .Notes({"A solve needs `file`. A render needs `width` and `height`. "
                  "One problem cannot have both.",
                  "With photographs of several `views` it has neither: each "
                  "view has its file and mask, and the curve is that of all.",
                  "An image has at most " + std::to_string(kMaxImagePixels) +
                      " pixels."}),
      Row("image.file",
          "The image: radiance up to one factor that may be unknown, or codes "
          "that `image.response` makes radiance.")
          .Path(".exr, .hdr, .pfm, .png, .jpg, .tif, .npy")
          .Unit("W/(m² sr)")
          .Without("needed by a solve")
          .UsedBy(kUsedBySolve)
          .Example("photo.exr"),
      Row("image.layer",
          "Layer or part of an OpenEXR file, as `ViewLayer.Combined`.")
          .Text()
          .Without("the beauty part")
          .UsedBy(kPhotographs)};
}

Row ResponseKey() {
  return Row("image.response", "The curve that made the image's values.")
      .Choice("auto",
              {{"auto",
                "What the file says (cICP, ICC, sRGB, gAMA, EXIF). Floats are "
                "linear, 8 bits that say nothing are sRGB; 16 bits that say "
                "nothing are refused."},
               {"linear", "Values are proportional to radiance."},
               {"srgb", "IEC 61966-2-1."},
               {"power", "value = radiance^(1/p)."},
               {"aces",
                "Narkowicz's fit of the ACES curve, scaled by gamma^(-1/5)."},
               {"reinhard", "Reinhard et al. 2002, Eq. 4, by `white`."},
               {"log", "log(1 + mu x) / log(1 + mu)."},
               {"unknown",
                "Found with the rest: sRGB, `power` or `aces`, by evidence. "
                "Files of codes alone."},
               {"unknown_power", "`power`, and p is found."},
               {"unknown_aces", "`aces`, and gamma is found."}})
      .UsedBy(kPhotographs);
}

Keys ResponseKeys() {
  return {ResponseKey(),
          Row("image.response_parameter",
              "p, gamma, white or mu of the response. `auto`: the usual one.")
              .AutoOrNumber(kPositive)
              .UsedBy(kPhotographs),
          Row("image.white",
              "Codes from here on are clipped: of their radiance the least is "
              "known alone. `auto`: the file's largest code.")
              .AutoOrNumber(kPositive)
              .UsedBy(kPhotographs),
          Row("image.black", "The code of no light. `auto`: 0.")
              .AutoOrNumber(kNotNegative)
              .UsedBy(kPhotographs)};
}

Keys BracketKeys() {
  return {Row("image.exposure",
              "Radiance is divided by it: seconds, say, where `image.brackets` "
              "has other exposures.")
              .Number(kPositive, "1")
              .UsedBy(kPhotographs),
          Row("image.brackets",
              "Further pictures of the same view at other exposures, of one "
              "size and curve. A value's radiance is what all pictures allow.")
              .PathList(".png, .jpg, .tif")
              .Without("none")
              .UsedBy(kUsedBySolve),
          Row("image.bracket_exposures", "The exposure of each of them.")
              .NumberList(kPositive)
              .Without("needed by `image.brackets`")
              .UsedBy(kUsedBySolve)};
}

Keys OtherLightKeys() {
  return {Row("images",
              "In place of `image.file`: photographs of one view, each under a "
              "light of its own. The albedo is what they share. Implies "
              "`variation: albedo`.")
              .PathList(".exr, .hdr, .pfm, .png, .jpg, .tif, .npy")
              .Without("one photograph")
              .UsedBy(kUsedByJoint)
              .Notes({"At most " + std::to_string(kMaxOtherLights + 1) +
                      ", of one size, mask and curve, from the same place. The "
                      "reflectance is found from the first."})};
}

Keys MaskAndSizeKeys() {
  return {Row("image.mask",
              "White pixels are the object. Without a mask, all pixels whose "
              "centre sees the geometry are.")
              .Path(".png")
              .UsedBy(kUsedBySolve)
              .Example("mask.png"),
          Row("image.width", "Width of the rendered image.")
              .Integer(1, kMaxImageSide, "")
              .Unit("pixels")
              .Without("needed by a render")
              .UsedBy(kUsedByRender),
          Row("image.height", "Height of the rendered image.")
              .Integer(1, kMaxImageSide, "")
              .Unit("pixels")
              .Without("needed by a render")
              .UsedBy(kUsedByRender)};
}

}  // namespace

Keys ImageKeys() {
  return Join({ImageFileKeys(), ResponseKeys(), BracketKeys(),
               MaskAndSizeKeys(), OtherLightKeys()});
}

}  // namespace problem_keys
}  // namespace ibrdf
