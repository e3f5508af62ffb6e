// Values of the ACES curve of RobIR and of sRGB as a table; see README.md.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <vector>

#include "ibrdf/image/response_curve.h"

namespace ibrdf {
namespace {

ResponseCurve Aces(double gamma) {
  ResponseDefinition definition;
  definition.kind = ResponseKind::kAces;
  definition.parameter = gamma;
  return ResponseCurve(definition);
}

ResponseCurve Srgb() {
  ResponseDefinition definition;
  definition.kind = ResponseKind::kSrgb;
  return ResponseCurve(definition);
}

void PrintTable(const std::vector<double>& gammas, double most, int steps) {
  std::printf("x,srgb");
  for (const double gamma : gammas) std::printf(",aces_%g", gamma);
  std::printf("\n");
  const ResponseCurve srgb = Srgb();
  for (int i = 0; i <= steps; ++i) {
    const double x = most * i / steps;
    std::printf("%.6g,%.6g", x, srgb.Encode(x));
    for (const double gamma : gammas) {
      std::printf(",%.6g", Aces(gamma).Encode(x));
    }
    std::printf("\n");
  }
}

}  // namespace
}  // namespace ibrdf

int main(int argc, char** argv) {
  std::vector<double> gammas = {0.1, 0.2, 0.35, 0.42, 0.5, 1.0};
  double most = 8.0;
  int steps = 8000;
  CLI::App app("Prints sRGB and ACES curves at steps of radiance.");
  app.add_option("--gammas", gammas, "of the ACES curves")->delimiter(',');
  app.add_option("--most", most, "the last x")->check(CLI::PositiveNumber);
  app.add_option("--steps", steps)->check(CLI::Range(1, 1000000));
  CLI11_PARSE(app, argc, argv);
  ibrdf::PrintTable(gammas, most, steps);
  return 0;
}
