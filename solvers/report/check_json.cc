#include "ibrdf/solvers/report/check_json.h"

#include <cmath>

#include "ibrdf/base/version.h"

namespace ibrdf {
namespace {

using Json = nlohmann::ordered_json;

Json Finite(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

Json PixelsJson(const PhotographCheck& check) {
  const ObjectPixelCounts& counts = check.counts;
  return {{"object", counts.object},     {"used", counts.used},
          {"clipped", counts.clipped},   {"zero", counts.zero},
          {"negative", counts.negative}, {"not_finite", counts.not_finite},
          {"missing", check.missing}};
}

Json LikeNormalsJson(const LikeNormalsSpread& spread) {
  const bool known = spread.pixels > 0;
  return {{"pixels", spread.pixels},
          {"share_of_pixels", spread.share},
          {"misfit_floor", spread.HasFloor() ? Json(spread.Floor()) : Json()},
          {"log_radiance", known ? Json(spread.log_radiance) : Json()},
          {"log_colour", known ? Json(spread.log_colour) : Json()}};
}

Json MaterialsJson(const PhotographCheck& check) {
  const ColourSpread& colours = check.colours;
  const char* const verdict = !colours.observable ? "cannot be told"
                              : SaysSeveralMaterials(colours)
                                  ? "several materials"
                                  : "may be one material";
  return {
      {"verdict", verdict},
      {"colour_spread", colours.observable ? Json(colours.excess) : Json()},
      {"threshold", kSeveralMaterials},
      {"far", {{"across", colours.far.across}, {"along", colours.far.along}}},
      {"near",
       {{"across", colours.near.across}, {"along", colours.near.along}}},
      {"sharp_colour_edges", check.colour_steps},
      {"pairs", colours.pairs},
      {"share_of_pixels", colours.share},
      {"own_log_colour", {colours.own.x(), colours.own.y()}}};
}

Json NormalsJson(const PhotographCheck& check) {
  Json out = Json::array();
  for (const NormalScore& score : check.normals) {
    out.push_back({{"hypothesis", NameOf(score.hypothesis)},
                   {"disagreement", score.disagreement},
                   {"away", Finite(score.away)},
                   {"outline", Finite(score.outline)},
                   {"curl", Finite(score.curl)}});
  }
  return out;
}

}  // namespace

nlohmann::ordered_json CheckToJson(const PhotographCheck& check) {
  return {
      {"width", check.width},
      {"height", check.height},
      {"mask_pixels", check.has_mask ? Json(check.mask_pixels) : Json()},
      {"overlap", check.overlap.has_value() ? Json(*check.overlap) : Json()},
      {"curve", check.curve},
      {"exposure", check.exposure},
      {"radiance_1_percent", check.radiance_1},
      {"radiance_99_percent", check.radiance_99},
      {"pixels", PixelsJson(check)},
      {"like_normals", LikeNormalsJson(check.like_normals)},
      {"materials", MaterialsJson(check)},
      {"normals", NormalsJson(check)}};
}

std::string CheckJson(const PhotographCheck& check,
                      const std::vector<std::string>& warnings) {
  const Json document = {{"ibrdf_version", kVersion},
                         {"warnings", warnings},
                         {"check", CheckToJson(check)}};
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace ibrdf
