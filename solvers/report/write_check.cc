#include "ibrdf/solvers/report/write_check.h"

#include <utility>

#include "ibrdf/io/atomic_file.h"
#include "ibrdf/io/map_file.h"
#include "ibrdf/io/output_paths.h"
#include "ibrdf/io/png.h"
#include "ibrdf/solvers/drawing/map_picture.h"
#include "ibrdf/solvers/drawing/tone_map.h"
#include "ibrdf/solvers/problem/load_scene.h"
#include "ibrdf/solvers/problem/load_sheet.h"
#include "ibrdf/solvers/report/check_json.h"
#include "ibrdf/solvers/report/check_picture.h"

namespace ibrdf {
namespace {

constexpr int kBallPixels = 256;

// In its file's frame.
StatusOr<StoredMap> KnownLight(const IlluminationSpec& illumination) {
  if (!illumination.sky) {
    return ReadStoredMap(illumination.known_file, illumination.frame);
  }
  StatusOr<Image> sky = LoadKnownIllumination(illumination);
  if (!sky.ok()) return sky.status();
  return StoredMap{*std::move(sky), kLibraryMapFrame, {}};
}

// Linear, in [0, 1].
Image DisplayColours(const Rgb8Image& picture) {
  Image colours(picture.width, picture.height);
  for (size_t k = 0; k < colours.rgb.size(); ++k) {
    colours.rgb[k] = static_cast<float>(DecodeSrgb(picture.rgb[k] / 255.0));
  }
  return colours;
}

}  // namespace

std::vector<std::string> CheckPaths(const std::string& folder) {
  return {folder + "/check.json", folder + "/check.png",
          folder + "/check_light.png"};
}

Status WriteCheck(const Problem& problem, const PhotographedObject& object,
                  const std::string& folder) {
  IBRDF_RETURN_IF_ERROR(WriteFileAtomically(
      folder + "/check.json", CheckJson(object.look->check, object.warnings)));
  CheckPictureInput input{"Check of " + PhotographsName(problem),
                          object.radiance, object.points, *object.look,
                          Image()};
  const std::string light_path = folder + "/check_light.png";
  if (!problem.illumination.known()) {
    // One of an earlier solve would speak of another light.
    RemoveEarlier(problem, folder, {"check_light.png"});
  } else {
    const StatusOr<StoredMap> light = KnownLight(problem.illumination);
    if (!light.ok()) return light.status();
    input.mirror_ball =
        DisplayColours(DrawMirrorBall(light->image, light->frame, kBallPixels));
    IBRDF_RETURN_IF_ERROR(
        WritePng(DrawMapFrame(light->image, light->frame), light_path));
  }
  return WritePng(DrawCheck(input), folder + "/check.png");
}

}  // namespace ibrdf
