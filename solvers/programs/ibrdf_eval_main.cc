// Metrics between two files, as JSON on stdout.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "ibrdf/solvers/programs/common_flags.h"
#include "ibrdf/solvers/programs/evaluate_files.h"

namespace ibrdf {
namespace {

void Print(const NamedMetrics& metrics) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const auto& [name, value] : metrics) {
    // JSON has no infinity: the PSNR of equal images is null.
    json[name] = std::isfinite(value) ? nlohmann::ordered_json(value)
                                      : nlohmann::ordered_json();
  }
  std::printf("%s\n", json.dump(2).c_str());
}

int Main(int argc, char** argv) {
  CLI::App app(
      "Metrics between an estimate A and a reference B, as JSON on stdout; "
      "logarithms are natural. A value that does not exist is null.");
  CommonFlags flags;
  AddCommonFlags(&app, &flags);
  app.require_subcommand(1);
  app.fallthrough();

  std::string estimate, reference, mask;
  const auto add = [&](const char* name, const char* help, const char* kind) {
    CLI::App* command = app.add_subcommand(name, help);
    command->add_option("A", estimate, std::string("estimate: ") + kind)
        ->required();
    command->add_option("B", reference, std::string("reference: ") + kind)
        ->required();
    return command;
  };
  const CLI::App* brdf =
      add("brdf",
          "log-RMSE in raw MERL units over bins where B's red is > 0: as is, "
          "after the best scale per channel (aligned), and with both "
          "directions within 80 degrees of the normal (below80)",
          "MERL .binary table");
  const CLI::App* illumination =
      add("illumination",
          "log-RMSE weighted by solid angle, divided by B's log range: as is, "
          "after the best scale per channel (aligned), and with equal weights "
          "(unweighted)",
          "equirectangular map, .exr or .hdr, both of one size");
  CLI::App* image =
      add("image",
          "log-RMSE; PSNR in dB after the best scale; DSSIM of log(1 + x) with "
          "an 11x11 Gaussian window, sigma 1.5 pixels",
          "image, .exr or .hdr, both of one size");
  image->add_option("--mask", mask,
                    "PNG, nonzero = compared; default: all pixels");

  return RunProgram(&app, argc, argv, [&]() -> Status {
    const StatusOr<NamedMetrics> metrics =
        brdf->parsed() ? EvaluateBrdfFiles(estimate, reference)
        : illumination->parsed()
            ? EvaluateIlluminationFiles(estimate, reference)
            : EvaluateImageFiles(estimate, reference, mask);
    if (!metrics.ok()) return metrics.status();
    Print(*metrics);
    return OkStatus();
  });
}

}  // namespace
}  // namespace ibrdf

int main(int argc, char** argv) { return ibrdf::Main(argc, argv); }
