#include "ibrdf/solvers/bench/embedding_figures.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <vector>

#include "ibrdf/base/format.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/brdf/flow_brdf.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/io/atomic_file.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/io/png.h"
#include "ibrdf/solvers/bench/embedding_map.h"
#include "ibrdf/solvers/bench/embedding_pages.h"
#include "ibrdf/solvers/bench/model_materials.h"
#include "ibrdf/solvers/bench/results_table.h"
#include "ibrdf/solvers/bench/sphere_studio.h"
#include "ibrdf/solvers/bench/sweep_files.h"
#include "ibrdf/solvers/problem/open_model.h"

namespace ibrdf {
namespace {

constexpr int kNeighbours = 5;
constexpr int kRows = 8;  // of neighbours.png
constexpr int kWalkSteps = 9;

// Colours blend as logarithms; a channel without colour has none in between.
std::vector<double> Blend(const std::vector<double>& a,
                          const std::vector<double>& b, double t) {
  std::vector<double> blend(a.size());
  for (size_t i = 0; i < a.size(); ++i) {
    blend[i] = a[i] == b[i] ? a[i] : (1.0 - t) * a[i] + t * b[i];
  }
  return blend;
}

// Log ratio of the reflectance at the mirror direction to that 40 degrees off.
double Gloss(const BrdfGrid& brdf) {
  const double theta_d = kPi / 9, phi_d = kPi / 2;
  return std::log(brdf.Evaluate(0.0, theta_d, phi_d).mean() /
                  brdf.Evaluate(2 * theta_d, theta_d, phi_d).mean());
}

std::string Csv(const EmbeddingMap& map, const Eigen::MatrixXd& points,
                const std::vector<ModelMaterial>& materials,
                const std::vector<std::vector<Neighbour>>& nearest) {
  std::string text = "material,norm,pc1,pc2";
  for (int k = 1; k <= kNeighbours; ++k) {
    const std::string i = std::to_string(k);
    text += ",neighbour_" + i + ",distance_" + i;
  }
  text += "\n";
  for (size_t i = 0; i < materials.size(); ++i) {
    text += materials[i].name + "," + NumberCell(points.row(i).norm()) + "," +
            NumberCell(map.scores(i, 0)) + "," + NumberCell(map.scores(i, 1));
    for (int k = 0; k < kNeighbours; ++k) {
      const bool there = k < static_cast<int>(nearest[i].size());
      text += "," + (there ? materials[nearest[i][k].index].name : "") + "," +
              (there ? NumberCell(nearest[i][k].distance) : "");
    }
    text += "\n";
  }
  return text;
}

std::string VarianceCsv(const Eigen::VectorXd& variance) {
  std::string text = "component,share,cumulative\n";
  double sum = 0.0;
  for (int k = 0; k < variance.size(); ++k) {
    sum += variance[k];
    text += std::to_string(k + 1) + "," + NumberCell(variance[k]) + "," +
            NumberCell(sum) + "\n";
  }
  return text;
}

class Figures {
 public:
  Figures(const EmbeddingOptions& options, NeuralBrdfModel model,
          std::vector<ModelMaterial> materials)
      : options_(options),
        model_(std::move(model)),
        materials_(std::move(materials)),
        lobes_(model_, 3, grid_, options.num_threads),
        studio_(options.sphere_size, grid_, options.num_threads) {}

  Status Draw(int from, int to) {
    const size_t n = materials_.size();
    const int size = model_.shape.code_size();
    Eigen::MatrixXd points(n, 3 * size);
    std::vector<double> gloss;
    for (size_t i = 0; i < n; ++i) {
      if (options_.stop != nullptr && *options_.stop) {
        return Status(StatusCode::kInterrupted, "interrupted");
      }
      if (options_.report && i % 16 == 0) {
        options_.report("sphere " + std::to_string(i + 1) + " / " +
                        std::to_string(n));
      }
      const float* code = model_.codes.data() +
                          static_cast<size_t>(materials_[i].first_code) * size;
      for (int k = 0; k < 3 * size; ++k) points(i, k) = code[k];
      const BrdfGrid brdf =
          lobes_.Grid(MaterialLobes(model_, materials_[i].first_code).data());
      gloss.push_back(Gloss(brdf));
      spheres_.push_back({materials_[i].name, studio_.Render(brdf)});
    }
    const EmbeddingMap map = PrincipalAxes(points);
    const auto nearest = NearestNeighbours(points, kNeighbours);
    IBRDF_RETURN_IF_ERROR(WriteFileAtomically(
        Out("embedding.csv"), Csv(map, points, materials_, nearest)));
    IBRDF_RETURN_IF_ERROR(
        WriteFileAtomically(Out("variance.csv"), VarianceCsv(map.variance)));
    IBRDF_RETURN_IF_ERROR(WritePng(MapPage(map, spheres_, studio_.exposure()),
                                   Out("embedding.png")));

    std::vector<int> order(n);
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return gloss[a] < gloss[b]; });
    IBRDF_RETURN_IF_ERROR(WritePng(Walk(points, from < 0 ? order.front() : from,
                                        to < 0 ? order.back() : to),
                                   Out("walk.png")));
    return Neighbours(order, nearest);
  }

 private:
  std::string Out(const std::string& name) const {
    return options_.out + "/" + name;
  }

  Rgb8Image Walk(const Eigen::MatrixXd& points, int from, int to) const {
    const std::vector<double> a =
        MaterialLobes(model_, materials_[from].first_code);
    const std::vector<double> b =
        MaterialLobes(model_, materials_[to].first_code);
    std::vector<NamedSphere> steps;
    for (int i = 0; i < kWalkSteps; ++i) {
      const double t = i / (kWalkSteps - 1.0);
      steps.push_back({Format("t = %.3g", t),
                       studio_.Render(lobes_.Grid(Blend(a, b, t).data()))});
    }
    return WalkPage(steps, materials_[from].name, materials_[to].name,
                    (points.row(from) - points.row(to)).norm(),
                    studio_.exposure());
  }

  Status Neighbours(const std::vector<int>& order,
                    const std::vector<std::vector<Neighbour>>& nearest) const {
    std::vector<NeighbourRow> rows;
    const int count = std::min<int>(kRows, static_cast<int>(order.size()));
    for (int r = 0; r < count; ++r) {
      // From end to end of the order by gloss.
      const size_t at = count > 1 ? r * (order.size() - 1) / (count - 1) : 0;
      NeighbourRow row;
      row.material = spheres_[order[at]];
      for (const Neighbour& neighbour : nearest[order[at]]) {
        row.neighbours.push_back(spheres_[neighbour.index]);
        row.distances.push_back(neighbour.distance);
      }
      const std::string file =
          options_.data.empty()
              ? ""
              : FindFile(options_.data, row.material.name, {".binary"});
      if (!file.empty()) {
        const StatusOr<MerlTable> table = ReadMerl(file);
        if (!table.ok()) return table.status();
        row.measured = studio_.Render(BrdfGrid::FromMerl(*table, grid_));
      }
      rows.push_back(std::move(row));
    }
    return WritePng(NeighbourPage(rows, studio_.exposure()),
                    Out("neighbours.png"));
  }

  const EmbeddingOptions& options_;
  const NeuralBrdfModel model_;
  const std::vector<ModelMaterial> materials_;
  const BrdfGridShape grid_;
  const FlowLobes lobes_;
  const SphereStudio studio_;
  std::vector<NamedSphere> spheres_;
};

// Index of a material; -1 where `name` is empty.
StatusOr<int> FindMaterial(const std::vector<ModelMaterial>& materials,
                           const std::string& option, const std::string& name) {
  if (name.empty()) return -1;
  for (size_t i = 0; i < materials.size(); ++i) {
    if (materials[i].name == name) return static_cast<int>(i);
  }
  return InvalidInput("command line: " + option,
                      "the model holds no material " + name);
}

}  // namespace

Status DrawEmbedding(const EmbeddingOptions& options) {
  StatusOr<OpenedModel> opened = OpenModel(options.model);
  if (!opened.ok()) return opened.status();
  const auto materials = ListModelMaterials(opened->model, opened->path);
  if (!materials.ok()) return materials.status();
  if (materials->size() < 2) {
    return InvalidInput(opened->path + ": names",
                        "expected two materials or more");
  }
  for (const ModelMaterial& m : *materials) {
    IBRDF_RETURN_IF_ERROR(CheckCaseName(m.name));
  }
  const StatusOr<int> from = FindMaterial(*materials, "--from", options.from);
  if (!from.ok()) return from.status();
  const StatusOr<int> to = FindMaterial(*materials, "--to", options.to);
  if (!to.ok()) return to.status();
  std::error_code error;
  std::filesystem::create_directories(options.out, error);
  if (error) return InvalidInput(options.out, error.message());
  return Figures(options, std::move(opened->model), *materials)
      .Draw(*from, *to);
}

}  // namespace ibrdf
