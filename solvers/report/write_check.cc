#include "ibrdf/solvers/report/write_check.h"

#include "ibrdf/io/atomic_file.h"
#include "ibrdf/io/png.h"
#include "ibrdf/solvers/report/check_json.h"
#include "ibrdf/solvers/report/check_picture.h"

namespace ibrdf {

std::vector<std::string> CheckPaths(const std::string& folder) {
  return {folder + "/check.json", folder + "/check.png"};
}

Status WriteCheck(const Problem& problem, const PhotographedObject& object,
                  const std::string& folder) {
  IBRDF_RETURN_IF_ERROR(WriteFileAtomically(
      folder + "/check.json", CheckJson(object.look->check, object.warnings)));
  const CheckPictureInput input{"Check of " + problem.image.file,
                                object.radiance, object.points, *object.look,
                                Image()};
  return WritePng(DrawCheck(input), folder + "/check.png");
}

}  // namespace ibrdf
