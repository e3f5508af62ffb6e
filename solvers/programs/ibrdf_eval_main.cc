// Metrics between two files, as JSON on stdout; a picture of a map's frame.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ibrdf/solvers/programs/common_flags.h"
#include "ibrdf/solvers/programs/draw_map_file.h"
#include "ibrdf/solvers/programs/evaluate_files.h"

namespace ibrdf {
namespace {

using Json = nlohmann::ordered_json;

Json ToJson(const NamedMetrics& metrics) {
  Json json = Json::object();
  for (const auto& [name, value] : metrics) {
    // JSON has no infinity: the PSNR of equal images is null.
    json[name] = std::isfinite(value) ? Json(value) : Json();
  }
  return json;
}

// What the command line names.
struct Arguments {
  std::string estimate, reference, mask;
  std::string frame_a = "auto", frame_b = "auto";
  double void_beyond = 90.0;
  std::string map, frame = "auto", picture;
};

StatusOr<std::optional<MapFrame>> ReadFrame(const std::string& option,
                                            const std::string& word) {
  if (word == "auto") return std::optional<MapFrame>();
  const StatusOr<MapFrame> frame =
      ParseMapFrame("command line: " + option, word);
  if (!frame.ok()) return frame.status();
  return std::optional<MapFrame>(*frame);
}

StatusOr<Json> EvaluateIllumination(const Arguments& arguments) {
  const auto frame_a = ReadFrame("--frame-a", arguments.frame_a);
  if (!frame_a.ok()) return frame_a.status();
  const auto frame_b = ReadFrame("--frame-b", arguments.frame_b);
  if (!frame_b.ok()) return frame_b.status();
  const StatusOr<IlluminationComparison> compared = EvaluateIlluminationFiles(
      {arguments.estimate, *frame_a}, {arguments.reference, *frame_b});
  if (!compared.ok()) return compared.status();
  PrintWarnings(compared->warnings);
  Json json = ToJson(compared->metrics);
  json["compared_at"] = {compared->compared_at.width,
                         compared->compared_at.height};
  return json;
}

Status DrawFrame(const Arguments& arguments) {
  const auto frame = ReadFrame("--frame", arguments.frame);
  if (!frame.ok()) return frame.status();
  std::vector<std::string> warnings;
  IBRDF_RETURN_IF_ERROR(
      DrawMapFile(arguments.map, *frame, arguments.picture, &warnings));
  PrintWarnings(warnings);
  return OkStatus();
}

void PrintJson(const Json& json) { std::printf("%s\n", json.dump(2).c_str()); }

Status PrintMetrics(const StatusOr<NamedMetrics>& metrics) {
  if (!metrics.ok()) return metrics.status();
  PrintJson(ToJson(*metrics));
  return OkStatus();
}

// Adds a subcommand that compares two files.
CLI::App* AddComparison(CLI::App* app, const char* name, const char* help,
                        const std::string& kind, Arguments* arguments) {
  CLI::App* command = app->add_subcommand(name, help);
  command->add_option("A", arguments->estimate, "estimate: " + kind)
      ->required();
  command->add_option("B", arguments->reference, "reference: " + kind)
      ->required();
  return command;
}

CLI::App* AddIllumination(CLI::App* app, Arguments* arguments) {
  CLI::App* command = AddComparison(
      app, "illumination",
      "log-RMSE weighted by solid angle, divided by B's log range: as is, "
      "after the best scale per channel (aligned), and with equal weights "
      "(unweighted). The finer map is averaged to the size of the coarser one",
      "environment map of floats, such as .exr or .hdr", arguments);
  command
      ->add_option("--frame-a", arguments->frame_a,
                   "frame of A, as illumination.frame of a problem file; "
                   "auto: what the file says, else camera")
      ->capture_default_str();
  command->add_option("--frame-b", arguments->frame_b, "frame of B")
      ->capture_default_str();
  return command;
}

CLI::App* AddFrame(CLI::App* app, Arguments* arguments) {
  CLI::App* command = app->add_subcommand(
      "frame",
      "draws how a map is understood: its directions, and a mirror ball in its "
      "light as the camera sees it");
  command->add_option("MAP", arguments->map, "environment map of floats")
      ->required();
  command->add_option("PICTURE", arguments->picture, ".png to write")
      ->required();
  command
      ->add_option("--frame", arguments->frame,
                   "frame of the map; auto: what the file says, else camera")
      ->capture_default_str();
  return command;
}

int Main(int argc, char** argv) {
  CLI::App app(
      "Metrics between an estimate A and a reference B, as JSON on stdout; "
      "logarithms are natural. A value that does not exist is null.");
  CommonFlags flags;
  AddCommonFlags(&app, &flags);
  app.require_subcommand(1);
  app.fallthrough();

  Arguments arguments;
  CLI::App* brdf = AddComparison(
      &app, "brdf",
      "log-RMSE in raw MERL units over bins where B's red is > 0: as is, "
      "after the best scale per channel (aligned), and with both "
      "directions within 80 degrees of the normal (below80), as is and "
      "aligned",
      "MERL .binary table", &arguments);
  brdf->add_option("--void-beyond", arguments.void_beyond,
                   "bins with a direction further from the normal than this, "
                   "degrees, play no part")
      ->check(CLI::Range(1.0, 90.0))
      ->capture_default_str();
  const CLI::App* illumination = AddIllumination(&app, &arguments);
  CLI::App* image = AddComparison(
      &app, "image",
      "log-RMSE; PSNR in dB after the best scale; DSSIM of log(1 + x) with "
      "an 11x11 Gaussian window, sigma 1.5 pixels",
      "image, .exr or .hdr, both of one size", &arguments);
  image->add_option("--mask", arguments.mask,
                    "PNG, nonzero = compared; default: all pixels");
  CLI::App* albedo = AddComparison(
      &app, "albedo",
      "of an object's pixels: log-RMSE as is and after the best scale per "
      "channel (aligned); aligned PSNR in dB and DSSIM; local mean squared "
      "error (LMSE, Grosse et al. 2009). Pixels without an albedo > 0 are left "
      "out",
      "albedo, .exr, or codes that are linear, both of one size", &arguments);
  albedo->add_option("--mask", arguments.mask,
                     "PNG, nonzero = compared; default: all pixels");
  const CLI::App* frame = AddFrame(&app, &arguments);

  return RunProgram(&app, argc, argv, [&]() -> Status {
    if (frame->parsed()) return DrawFrame(arguments);
    if (brdf->parsed()) {
      return PrintMetrics(EvaluateBrdfFiles(
          arguments.estimate, arguments.reference, arguments.void_beyond));
    }
    if (albedo->parsed()) {
      return PrintMetrics(EvaluateAlbedoFiles(
          arguments.estimate, arguments.reference, arguments.mask));
    }
    if (illumination->parsed()) {
      const StatusOr<Json> json = EvaluateIllumination(arguments);
      if (!json.ok()) return json.status();
      PrintJson(*json);
      return OkStatus();
    }
    return PrintMetrics(EvaluateImageFiles(
        arguments.estimate, arguments.reference, arguments.mask));
  });
}

}  // namespace
}  // namespace ibrdf

int main(int argc, char** argv) { return ibrdf::Main(argc, argv); }
