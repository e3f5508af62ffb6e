#include "ibrdf/solvers/programs/bench_embedding.h"

#include <CLI/CLI.hpp>
#include <memory>

#include "ibrdf/solvers/bench/embedding_figures.h"

namespace ibrdf {

void AddEmbeddingExperiment(CLI::App* app, BenchSession* session) {
  const auto options = std::make_shared<EmbeddingOptions>();
  const auto run = [options, session]() -> Status {
    options->num_threads = session->common.threads;
    options->report = session->Report();
    options->stop = session->stop;
    return DrawEmbedding(*options);
  };
  CLI::App* embedding = AddExperiment(
      app, "embedding",
      "A model's materials as spheres: embedding.png by principal axes, "
      "walk.png between two, neighbours.png; embedding.csv and variance.csv.",
      session, run);
  options->model = "default";
  embedding->add_option("--model", options->model, "model file, or default")
      ->capture_default_str();
  embedding->add_option("--data", options->data,
                        "folder of MERL .binary tables, shown beside");
  embedding->add_option("--out", options->out, "folder of results")->required();
  embedding->add_option("--from", options->from,
                        "material where the walk starts; default: most matte");
  embedding->add_option("--to", options->to,
                        "material where it ends; default: glossiest");
}

}  // namespace ibrdf
