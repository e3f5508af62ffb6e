#include "ibrdf/solvers/programs/bench_entropy.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <vector>

#include "ibrdf/solvers/entropy_study/best_view_sweep.h"
#include "ibrdf/solvers/entropy_study/entropy_sweep.h"
#include "ibrdf/solvers/entropy_study/material_parameters.h"
#include "ibrdf/solvers/entropy_study/study_cases.h"

namespace ibrdf {
namespace {

struct StudyFlags {
  StudyOptions options;
  OnlyFlag only;
  bool dry_run = false;
};

Status PrintCases(const StudyOptions& options) {
  const StatusOr<std::vector<StudyCase>> cases = ListStudyCases(options);
  if (!cases.ok()) return cases.status();
  for (const StudyCase& c : *cases) {
    std::printf("%s\t%s\t%s\t%u\n", c.name.c_str(), MapKindName(c.kind),
                c.map_path.c_str(), c.seed);
  }
  return OkStatus();
}

CLI::App* AddStudy(CLI::App* app, const char* name, const char* description,
                   const std::shared_ptr<StudyFlags>& flags,
                   BenchSession* session,
                   Status (*study)(const StudyOptions&)) {
  const auto run = [flags, session, study]() -> Status {
    StudyOptions& options = flags->options;
    IBRDF_RETURN_IF_ERROR(flags->only.Parse());
    options.only_index = flags->only.index;
    options.only_count = flags->only.count;
    options.seed = static_cast<unsigned>(session->common.seed);
    options.num_threads = session->common.threads;
    options.report = session->Report();
    options.stop = session->stop;
    return flags->dry_run ? PrintCases(options) : study(options);
  };
  CLI::App* const experiment =
      AddExperiment(app, name, description, session, run);
  StudyOptions& options = flags->options;
  experiment
      ->add_option("--data", options.data,
                   "folder of the meshes (.obj, .ply, .stl, .glb)")
      ->required();
  experiment
      ->add_option("--maps", options.maps,
                   "folder of .hdr or .exr maps, read in the frame ibrdf_0_1 "
                   "whatever they say")
      ->required();
  experiment->add_option("--out", options.out, "folder of results")->required();
  experiment
      ->add_option("--shapes", options.shapes,
                   "comma-separated shapes, which the maps take in turn: "
                   "sphere, torus, or meshes without extension")
      ->delimiter(',')
      ->capture_default_str();
  experiment
      ->add_option("--map-names", options.map_names,
                   "comma-separated maps, without extension; default: all")
      ->delimiter(',');
  experiment
      ->add_option("--rounds", options.rounds,
                   "scenes of each map, each with another shape")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  experiment
      ->add_option("--texels", options.num_texels, "points of each surface")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  experiment
      ->add_option("--only", flags->only.text,
                   "i/n: every n-th scene from the i-th")
      ->capture_default_str();
  experiment->add_flag("--dry-run", flags->dry_run,
                       "print the scenes and stop: name, light, map, seed");
  return experiment;
}

void AddMaterialParameters(CLI::App* app, BenchSession* session) {
  const auto options = std::make_shared<MaterialParametersOptions>();
  CLI::App* const experiment = AddExperiment(
      app, "material-parameters",
      "Roughness, gloss and albedo of measured materials: fits of the "
      "principled BRDF to tables, from which the prior of `uncertainty.prior: "
      "materials` is. The same command goes on where it was stopped.",
      session, [options, session]() -> Status {
        options->report = session->Report();
        options->stop = session->stop;
        return RunMaterialParameters(*options);
      });
  experiment
      ->add_option("--data", options->data, "folder of MERL .binary tables")
      ->required();
  experiment->add_option("--out", options->out, "folder of results")
      ->required();
}

}  // namespace

void AddEntropyExperiments(CLI::App* app, BenchSession* session) {
  const auto entropy = std::make_shared<StudyFlags>();
  AddStudy(app, "entropy",
           "Evaluators of entropy beside that of brute force, on surfaces "
           "under measured maps: how they correlate, with each choice of the "
           "evaluators undone. The same command goes on where it was stopped.",
           entropy, session, RunEntropySweep)
      ->add_flag("--one-material", entropy->options.one_material,
                 "all points have the same material, in place of one each");
  const auto views = std::make_shared<StudyFlags>();
  views->options.num_texels = 60;
  views->options.rounds = 2;
  AddStudy(app, "best-view",
           "Searches for the next view beside farthest points, on surfaces "
           "under measured maps: with how many views they reach the entropy "
           "of twenty farthest points. The same command goes on where it was "
           "stopped.",
           views, session, RunBestViewSweep)
      ->add_flag("--oracle", views->options.oracle,
                 "with a greedy search that knows all photographs before they "
                 "are taken: three times as long");
  AddMaterialParameters(app, session);
}

}  // namespace ibrdf
