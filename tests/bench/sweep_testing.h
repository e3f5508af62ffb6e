// A sweep's folders with one small table and three small maps, and a program in
// place of the solver.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/brdf/sample_merl.h"
#include "ibrdf/io/exr.h"
#include "ibrdf/io/map_file.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/solvers/bench/solver_sweep.h"
#include "tests/support/render_testing.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace testing {

class SweepTest : public ::testing::Test {
 protected:
  SweepTest() {
    std::filesystem::create_directories(dir_.File("data"));
    std::filesystem::create_directories(dir_.File("maps"));
    CHECK(WriteMerl(SampleMerl(Glossy(0.3, 0.5, 15.0)),
                    dir_.File("data/paint.binary"))
              .ok());
    for (const char* name : {"a", "b", "c"}) {
      CHECK(WriteExr(SmoothMap(8, 16),
                     dir_.File(std::string("maps/") + name + ".exr"))
                .ok());
    }
    WriteSolver(R"({"metrics": {"misfit": 0.25, "brdf_log_rmse": null,
        "illumination_relative_log_rmse": 0.125, "seconds": 9},
        "posterior": {"brdf_log_rmse_expected": 0.375}})",
                0);
  }

  // Counts its calls in DIR/calls, writes result.json, the paint as brdf.binary
  // and DIR/estimate.exr, where that is, as illumination.exr, runs `command`,
  // and exits with `exit_code`.
  void WriteSolver(const std::string& json, int exit_code,
                   const std::string& command = "echo 'error: of the case'") {
    WriteBytes(
        dir_.File("solver"),
        "#!/bin/sh\n"
        "echo call >> '" +
            dir_.File("calls") +
            "'\n"
            "while [ $# -gt 0 ]; do [ \"$1\" = --out ] && out=$2; shift; done\n"
            "[ -e '" +
            dir_.File("estimate.exr") + "' ] && cp '" +
            dir_.File("estimate.exr") +
            "' \"$out/illumination.exr\"\n"
            "cp '" +
            dir_.File("data/paint.binary") +
            "' \"$out/brdf.binary\"\n"
            "echo '" +
            json + "' > \"$out/result.json\"\n" + command +
            "\n"
            "exit " +
            std::to_string(exit_code) + "\n");
    std::filesystem::permissions(dir_.File("solver"),
                                 std::filesystem::perms::owner_all);
  }

  void Apply(SolverSweepOptions* options) const {
    Apply(static_cast<SweepOptions*>(options));
    options->solver_program = dir_.File("solver");
  }
  void Apply(SweepOptions* options) const {
    options->data = dir_.File("data");
    options->maps = dir_.File("maps");
    options->out = dir_.File("out");
    options->size = 8;
    options->command = "the command";
  }

  static Status Run(const SolverSweepOptions& options,
                    const StatusOr<SolverSweep>& sweep) {
    return sweep.ok() ? RunSolverSweep(options, *sweep) : sweep.status();
  }

  size_t Calls() const {
    return std::filesystem::exists(dir_.File("calls"))
               ? ReadBytes(dir_.File("calls")).size() / 5
               : 0;
  }
  std::string Results() const { return dir_.File("out/results.csv"); }
  std::vector<ResultsRow> Rows(const std::vector<std::string>& columns) const {
    return ReadResults(Results(), columns).value();
  }
  static std::string Cell(const std::vector<std::string>& columns,
                          const ResultsRow& row, const std::string& column) {
    return row.at(std::find(columns.begin(), columns.end(), column) -
                  columns.begin());
  }
  // As a kill in the middle of a row leaves it.
  void CutResults() const {
    const std::string csv = ReadBytes(Results());
    WriteBytes(Results(), csv.substr(0, csv.size() - 3));
  }

  const TempDir dir_;
};

}  // namespace testing
}  // namespace ibrdf
