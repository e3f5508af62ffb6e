#include "ibrdf/solvers/marginal/marginal_reflectance.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/brdf/matte_split.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/light/log_map.h"
#include "ibrdf/solvers/priors/directional_lights.h"

namespace ibrdf {
namespace {

// Radians, of DirectionalLightSlopes: below a bin of the grid for most
// half-vectors.
constexpr double kDirectionalLightStep = 1e-3;

// The least radiance under a map of 1, on white: a point whose whole sky is
// hidden has 1e-4 left at the horizon, which the steps of VisibilityGrid cut.
constexpr double kLeastSeen = 1e-3;

// Adds which of some bins, whose points come from first_point on, a map of
// constant radiance lights.
void AddLitCells(const NormalBins& bins, int first_bin, int num_bins,
                 int first_point, const Transport& transport,
                 std::vector<bool>* lit) {
  BrdfGrid white;
  white.shape = transport.grid_shape();
  white.values.assign(3 * white.shape.num_nodes(), 1.0f);
  const std::vector<float> map(
      size_t{3} * transport.map_height() * transport.map_width(), 1.0f);
  std::vector<double> L_o(size_t{3} * transport.num_points());
  transport.Render(white, map.data(), L_o.data());
  for (int i = first_bin; i < first_bin + num_bins; ++i) {
    lit->push_back(
        std::any_of(L_o.begin() + 3 * (bins.first[i] - first_point),
                    L_o.begin() + 3 * (bins.first[i + 1] - first_point),
                    [](double e) { return e > kLeastSeen; }));
  }
}

// log mean I - log mean(I / e^a) of the bins' points [3 * bins]: the paint of
// a bin, of which it need not hold one alone.
Eigen::VectorXd MeanPaint(const std::vector<ShadingPoint>& points,
                          const Observations& observed,
                          const std::vector<double>& log_albedo,
                          const MarginalResolution& resolution,
                          const NormalBins& binned) {
  if (log_albedo.empty()) return {};
  std::vector<double> unpainted = observed.radiance;
  for (size_t i = 0; i < unpainted.size(); ++i) {
    unpainted[i] *= std::exp(-log_albedo[i]);
  }
  Observations without = MakeObservations(std::move(unpainted));
  without.valid = observed.valid;
  return ToEigen(binned.log_radiance) -
         ToEigen(BinByNormal(points, without, resolution.bins).log_radiance);
}

// The mean normals of the bins' points [bins][3], not normalised.
Eigen::MatrixX3d MeanNormals(const NormalBins& bins) {
  Eigen::MatrixX3d normals = Eigen::MatrixX3d::Zero(bins.num_bins(), 3);
  for (int i = 0; i < bins.num_bins(); ++i) {
    for (int k = bins.first[i]; k < bins.first[i + 1]; ++k) {
      normals.row(i) += bins.points[k].normal.cast<double>().transpose() /
                        (bins.first[i + 1] - bins.first[i]);
    }
  }
  return normals;
}

// Those of the values [3 * bins], or of none, whose bins are to be kept.
Eigen::VectorXd KeepRows(const Eigen::VectorXd& values,
                         const std::vector<bool>& keep) {
  std::vector<double> kept;
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    if (keep[k % keep.size()]) kept.push_back(values[k]);
  }
  return ToEigen(kept);
}

}  // namespace

MarginalReflectance::MarginalReflectance(
    const LobeFactory& lobes, const std::vector<ShadingPoint>& points,
    const Observations& observed, const LightProcess& process,
    const MarginalResolution& resolution, int num_threads,
    std::vector<Eigen::Vector3d> directional_lights,
    const std::optional<PaintPrior>& paint, int num_materials)
    : resolution_(resolution),
      binned_(BinByNormal(points, observed, resolution.bins)),
      directional_lights_(std::move(directional_lights)) {
  CHECK_GT(binned_.num_bins(), 0);
  blocks_ = MakeBlocks(num_materials, num_threads);
  Eigen::VectorXd mean_paint;
  if (paint) {
    mean_paint = MeanPaint(points, observed, paint->mean, resolution, binned_);
  }
  if (resolution.visibility != nullptr) {
    // No light explains radiance where none of the map is seen.
    std::vector<bool> lit;
    for (const Block& block : blocks_) {
      if (block.transport == nullptr) continue;
      AddLitCells(binned_, block.first_bin, block.num_bins, block.first_point,
                  *block.transport, &lit);
    }
    const auto count = std::count(lit.begin(), lit.end(), true);
    if (count > 0 && count < binned_.num_bins()) {
      binned_ = KeepBins(binned_, lit);
      mean_paint = KeepRows(mean_paint, lit);
      blocks_ = MakeBlocks(num_materials, num_threads);
    }
  }
  lobes_ = lobes(resolution.grid);
  CHECK(!paint || num_materials == 1);
  Eigen::MatrixXd covariance;
  if (paint) {
    covariance = AlbedoCovariance(
        paint->albedo, LogChroma(binned_.log_radiance), MeanNormals(binned_));
  }
  likelihood_ = std::make_unique<MarginalLikelihood>(
      LogRadianceData{binned_.log_radiance, binned_.log_low, binned_.log_high},
      process, resolution.map_height, resolution.map_width,
      static_cast<int>(directional_lights_.size()), num_threads,
      std::move(covariance), std::move(mean_paint));
  const std::vector<float> ones(lobes_->grid_shape().num_nodes(), 1.0f);
  for (Block& block : blocks_) {
    if (block.transport == nullptr) continue;
    block.uniform = std::move(TexelMatrices(block, {ones.data()})[0]);
  }
}

std::vector<MarginalReflectance::Block> MarginalReflectance::MakeBlocks(
    int num_materials, int num_threads) const {
  TransportOptions options;
  options.grid = resolution_.grid;
  options.num_threads = num_threads;
  options.quadrature = resolution_.quadrature;
  options.visibility = resolution_.visibility;
  std::vector<Block> blocks;
  int bin = 0;
  for (int material = 0; material < num_materials; ++material) {
    Block block;
    block.first_bin = bin;
    block.first_point = binned_.first[bin];
    while (bin < binned_.num_bins() &&
           (num_materials == 1 ||
            binned_.points[binned_.first[bin]].material == material)) {
      ++bin;
    }
    block.num_bins = bin - block.first_bin;
    block.num_points = binned_.first[bin] - block.first_point;
    if (block.num_points > 0) {
      const auto first = binned_.points.begin() + block.first_point;
      block.transport = std::make_unique<Transport>(
          std::vector<ShadingPoint>(first, first + block.num_points),
          resolution_.map_height, resolution_.map_width, options);
    }
    blocks.push_back(std::move(block));
  }
  CHECK_EQ(bin, binned_.num_bins());
  return blocks;
}

Eigen::VectorXd MarginalReflectance::WithDirectionalLights(
    const Eigen::VectorXd& lobes) const {
  CHECK_EQ(lobes.size(), num_lobe_parameters());
  Eigen::VectorXd all = Eigen::VectorXd::Zero(num_parameters());
  all.head(lobes.size()) = lobes;
  return all;
}

std::vector<Eigen::Vector3d> MarginalReflectance::DirectionalLightDirections(
    const double* parameters) const {
  std::vector<Eigen::Vector3d> directions;
  const double* offsets = parameters + num_lobe_parameters();
  for (const Eigen::Vector3d& directional_light : directional_lights_) {
    directions.push_back(MovedDirectionalLight(directional_light, offsets));
    offsets += 2;
  }
  return directions;
}

DirectionalLightResponses MarginalReflectance::DirectionalLights(
    const double* parameters) const {
  return DirectionalLightResponses(binned_, resolution_.grid,
                                   resolution_.visibility.get(),
                                   DirectionalLightDirections(parameters));
}

MarginalReflectance::Fields MarginalReflectance::Tabulate(
    const double* parameters, bool derivatives) const {
  Fields fields(num_materials());
  for (int m = 0; m < num_materials(); ++m) {
    lobes_->Tabulate(parameters + m * lobes_->num_parameters(), derivatives,
                     &fields[m]);
  }
  return fields;
}

std::vector<RowMatrix> MarginalReflectance::DirectionalLightSlopes(
    const double* parameters, const Fields& fields, int stride) const {
  const size_t nodes = lobes_->grid_shape().num_nodes();
  const int num_lobes = lobes_->num_lobes();
  const auto num_directional_lights =
      static_cast<Eigen::Index>(directional_lights_.size());
  std::vector<RowMatrix> slopes(
      num_materials() * num_lobes,
      RowMatrix::Zero(binned_.num_bins(), 2 * num_directional_lights));
  if (num_directional_lights == 0) return slopes;
  for (int axis = 0; axis < 2; ++axis) {
    for (const double step : {kDirectionalLightStep, -kDirectionalLightStep}) {
      std::vector<double> moved(parameters, parameters + num_parameters());
      for (Eigen::Index k = 0; k < num_directional_lights; ++k) {
        moved[num_lobe_parameters() + 2 * k + axis] += step;
      }
      const DirectionalLightResponses responses =
          DirectionalLights(moved.data());
      for (size_t i = 0; i < slopes.size(); ++i) {
        const Block& block = blocks_[i / num_lobes];
        const float* const field =
            &fields[i / num_lobes][i % num_lobes * stride * nodes];
        const RowMatrix of =
            responses.Of(field).middleRows(block.first_bin, block.num_bins);
        for (Eigen::Index k = 0; k < num_directional_lights; ++k) {
          slopes[i]
              .col(2 * k + axis)
              .segment(block.first_bin, block.num_bins) +=
              of.col(k) / (2.0 * step);
        }
      }
    }
  }
  return slopes;
}

std::vector<double> MarginalReflectance::LogRadiance(
    const double* parameters, const LightMode& mode) const {
  const int H = resolution_.map_height, W = resolution_.map_width;
  const Eigen::Index t = likelihood_->num_texels(),
                     n = likelihood_->num_sources();
  const std::vector<Eigen::Vector3d> directional_lights =
      DirectionalLightDirections(parameters);
  std::vector<double> out;
  out.reserve(3 * t);
  for (int c = 0; c < 3; ++c) {
    const double* l = mode.l.data() + c * n;
    for (Eigen::Index i = 0; i < t; ++i) out.push_back(l[i] + mode.level);
    for (size_t k = 0; k < directional_lights.size(); ++k) {
      double row = 0.0, column = 0.0;
      MapPosition(directional_lights[k], H, W, &row, &column);
      const int r = std::clamp(static_cast<int>(row), 0, H - 1);
      const int x = std::clamp(static_cast<int>(column), 0, W - 1);
      double& texel = out[c * t + r * W + x];
      texel = std::log(std::exp(texel) + std::exp(l[t + k] + mode.level) *
                                             kDirectionalLightSolidAngle /
                                             TexelSolidAngle(r, H, W));
    }
  }
  return out;
}

std::vector<MarginalReflectance::FloatMatrix>
MarginalReflectance::TexelMatrices(
    const Block& block, const std::vector<const float*>& fields) const {
  const Eigen::Index t = likelihood_->num_texels();
  std::vector<FloatMatrix> by_point(fields.size(),
                                    FloatMatrix(block.num_points, t));
  std::vector<float*> out;
  for (FloatMatrix& matrix : by_point) out.push_back(matrix.data());
  block.transport->LightMatrices(fields, out);
  std::vector<FloatMatrix> by_bin(fields.size(),
                                  FloatMatrix(block.num_bins, t));
  const int* const first = &binned_.first[block.first_bin];
  for (size_t k = 0; k < fields.size(); ++k) {
    for (int i = 0; i < block.num_bins; ++i) {
      by_bin[k].row(i) =
          by_point[k]
              .middleRows(first[i] - block.first_point, first[i + 1] - first[i])
              .colwise()
              .mean();
    }
  }
  return by_bin;
}

std::vector<MarginalReflectance::FloatMatrix> MarginalReflectance::CellMatrices(
    const Block& block, const DirectionalLightResponses& directional_lights,
    const std::vector<const float*>& fields) const {
  std::vector<FloatMatrix> cells(
      fields.size(), FloatMatrix(block.num_bins, likelihood_->num_sources()));
  if (block.transport == nullptr) return cells;
  std::vector<const float*> others;
  std::vector<FloatMatrix*> of_others;
  const Eigen::Index t = likelihood_->num_texels();
  for (size_t k = 0; k < fields.size(); ++k) {
    cells[k].rightCols(directional_lights.num_directional_lights()) =
        directional_lights.Of(fields[k])
            .middleRows(block.first_bin, block.num_bins)
            .cast<float>();
    if (IsUniform(fields[k])) {
      cells[k].leftCols(t) = block.uniform;
    } else {
      others.push_back(fields[k]);
      of_others.push_back(&cells[k]);
    }
  }
  const std::vector<FloatMatrix> texels = TexelMatrices(block, others);
  for (size_t k = 0; k < others.size(); ++k) {
    of_others[k]->leftCols(t) = texels[k];
  }
  return cells;
}

bool MarginalReflectance::IsUniform(const float* field) const {
  return std::all_of(field, field + lobes_->grid_shape().num_nodes(),
                     [](float value) { return value == 1.0f; });
}

void MarginalReflectance::CellMatrixGradient(
    const Block& block, const DirectionalLightResponses& directional_lights,
    const FloatMatrix& adjoint, float* gradient) const {
  if (block.transport == nullptr) {
    std::fill_n(gradient, lobes_->grid_shape().num_nodes(), 0.0f);
    return;
  }
  const Eigen::Index t = likelihood_->num_texels();
  FloatMatrix by_point(block.num_points, t);
  const int* const first = &binned_.first[block.first_bin];
  for (int i = 0; i < block.num_bins; ++i) {
    const int count = first[i + 1] - first[i];
    by_point.middleRows(first[i] - block.first_point, count).rowwise() =
        adjoint.row(i).head(t) / static_cast<float>(count);
  }
  block.transport->LightMatrixGradient(by_point.data(), gradient);
  const int lights = directional_lights.num_directional_lights();
  FloatMatrix of_lights = FloatMatrix::Zero(binned_.num_bins(), lights);
  of_lights.middleRows(block.first_bin, block.num_bins) =
      adjoint.rightCols(lights);
  directional_lights.AddGradient(of_lights, gradient);
}

std::vector<MarginalReflectance::FloatMatrix>
MarginalReflectance::ShapeMatrices(
    const DirectionalLightResponses& directional_lights, const Fields& fields,
    int stride) const {
  const size_t nodes = lobes_->grid_shape().num_nodes();
  std::vector<FloatMatrix> shapes;
  for (int m = 0; m < num_materials(); ++m) {
    std::vector<const float*> of_material;
    for (int k = 0; k < lobes_->num_lobes(); ++k) {
      of_material.push_back(&fields[m][k * stride * nodes]);
    }
    for (FloatMatrix& cells :
         CellMatrices(blocks_[m], directional_lights, of_material)) {
      shapes.push_back(std::move(cells));
    }
  }
  return shapes;
}

std::array<RowMatrix, 3> MarginalReflectance::Coloured(
    const double* parameters, const std::vector<FloatMatrix>& shapes) const {
  const int num_lobes = lobes_->num_lobes();
  std::array<RowMatrix, 3> matrices;
  for (RowMatrix& matrix : matrices) {
    matrix.setZero(binned_.num_bins(), shapes[0].cols());
  }
  for (int m = 0; m < num_materials(); ++m) {
    const Block& block = blocks_[m];
    const Eigen::Array3Xd colours = MixtureOf(m, parameters).Colours();
    for (int c = 0; c < 3; ++c) {
      for (int k = 0; k < num_lobes; ++k) {
        matrices[c].middleRows(block.first_bin, block.num_bins) +=
            colours(c, k) * shapes[m * num_lobes + k].cast<double>();
      }
    }
  }
  return matrices;
}

std::array<RowMatrix, 3> MarginalReflectance::Matrices(
    const double* parameters) const {
  return Coloured(parameters, ShapeMatrices(DirectionalLights(parameters),
                                            Tabulate(parameters, false), 1));
}

std::array<RowMatrix, 3> MarginalReflectance::MatteMatrices(
    const double* parameters) const {
  if (!likelihood_->has_paint()) return {};
  return Coloured(parameters,
                  ShapeMatrices(DirectionalLights(parameters),
                                {MatteShapes(*lobes_, parameters)}, 1));
}

MarginalValue MarginalReflectance::Expand(
    const double* parameters, const DataErrors& errors,
    const LightHyperparameters& hyperparameters, double tolerance,
    const Expansion* near, LightMode* mode, Expansion* expansion) const {
  *expansion = Expansion();
  expansion->parameters.assign(parameters, parameters + num_parameters());
  expansion->shapes = ShapeMatrices(DirectionalLights(parameters),
                                    Tabulate(parameters, false), 1);
  return likelihood_->Expand(Coloured(parameters, expansion->shapes), errors,
                             hyperparameters, tolerance,
                             near != nullptr ? near->likelihood.get() : nullptr,
                             mode, &expansion->likelihood);
}

void MarginalReflectance::TabulateDerivatives(Expansion* at) const {
  CHECK(at->likelihood != nullptr);
  if (at->fields.empty()) at->fields = Tabulate(at->parameters.data(), true);
}

std::vector<double> MarginalReflectance::Gradient(Expansion* at) const {
  TabulateDerivatives(at);
  const double* const parameters = at->parameters.data();
  const MarginalGradient by_matrix = likelihood_->Gradient(*at->likelihood);
  const DirectionalLightResponses directional_lights =
      DirectionalLights(parameters);
  const std::vector<RowMatrix> slopes =
      DirectionalLightSlopes(parameters, at->fields, 1 + lobes_->code_size());
  std::vector<double> gradient(num_parameters() + LightHyperparameters::kCount);
  for (int m = 0; m < num_materials(); ++m) {
    AddGradient(m, parameters, at->fields[m], directional_lights, at->shapes,
                slopes, by_matrix, gradient.data());
  }
  std::copy(by_matrix.hyperparameters.begin(), by_matrix.hyperparameters.end(),
            gradient.end() - LightHyperparameters::kCount);
  return gradient;
}

MarginalValue MarginalReflectance::Evaluate(
    const double* parameters, const DataErrors& errors,
    const LightHyperparameters& hyperparameters, double tolerance,
    LightMode* mode, std::vector<double>* gradient) const {
  Expansion at;
  const MarginalValue value = Expand(parameters, errors, hyperparameters,
                                     tolerance, nullptr, mode, &at);
  if (gradient != nullptr && value.ok) *gradient = Gradient(&at);
  return value;
}

void MarginalReflectance::AddGradient(
    int material, const double* parameters, const std::vector<float>& fields,
    const DirectionalLightResponses& directional_lights,
    const std::vector<FloatMatrix>& shapes,
    const std::vector<RowMatrix>& slopes, const MarginalGradient& by_matrix,
    double* gradient) const {
  const int num_lobes = lobes_->num_lobes();
  const int stride = 1 + lobes_->code_size();
  const size_t nodes = lobes_->grid_shape().num_nodes();
  const Eigen::Index t = likelihood_->num_texels();
  const Block& block = blocks_[material];
  std::vector<float> by_node(nodes);
  const LobeMixture lobes = MixtureOf(material, parameters);
  const Eigen::Array3Xd colours = lobes.Colours();
  const Eigen::Array3Xd colour_slopes = lobes.ColourSlopes();
  const MutableLobeMixture by_lobe = MixtureOf(material, gradient);
  for (int k = 0; k < num_lobes; ++k) {
    const FloatMatrix& shape = shapes[material * num_lobes + k];
    const RowMatrix& slope = slopes[material * num_lobes + k];
    FloatMatrix adjoint = FloatMatrix::Zero(shape.rows(), shape.cols());
    for (int c = 0; c < 3; ++c) {
      const auto by_row =
          by_matrix.matrices[c].middleRows(block.first_bin, block.num_bins);
      adjoint += (colours(c, k) * by_row).cast<float>();
      by_lobe.log_colour(k)[c] =
          colour_slopes(c, k) * by_row.cwiseProduct(shape.cast<double>()).sum();
    }
    if (lobes.code(k).size() > 0) {
      CellMatrixGradient(block, directional_lights, adjoint, by_node.data());
    }
    for (Eigen::Index i = 0; i < slope.cols(); ++i) {
      gradient[num_lobe_parameters() + i] +=
          adjoint.col(t + i / 2).cast<double>().dot(
              slope.col(i).segment(block.first_bin, block.num_bins));
    }
    for (int d = 0; d < lobes.code(k).size(); ++d) {
      const float* derivative = &fields[(k * stride + 1 + d) * nodes];
      double sum = 0.0;
      for (size_t i = 0; i < nodes; ++i) {
        sum += static_cast<double>(by_node[i]) * derivative[i];
      }
      by_lobe.code(k)[d] = sum;
    }
  }
}

RowMatrix MarginalReflectance::LogRadianceJacobian(
    const double* parameters, const Fields& fields,
    const DirectionalLightResponses& directional_lights,
    const LightMode& mode) const {
  RowMatrix jacobian =
      RowMatrix::Zero(Eigen::Index{3} * binned_.num_bins(), num_parameters());
  const std::vector<RowMatrix> slopes =
      DirectionalLightSlopes(parameters, fields, 1 + lobes_->code_size());
  for (int m = 0; m < num_materials(); ++m) {
    if (blocks_[m].transport == nullptr) continue;
    AddLogRadianceJacobian(m, parameters, fields, directional_lights, slopes,
                           mode, &jacobian);
  }
  return jacobian;
}

void MarginalReflectance::AddLogRadianceJacobian(
    int material, const double* parameters, const Fields& fields,
    const DirectionalLightResponses& directional_lights,
    const std::vector<RowMatrix>& slopes, const LightMode& mode,
    RowMatrix* jacobian) const {
  const Block& block = blocks_[material];
  const int num_lobes = lobes_->num_lobes(), size = lobes_->code_size();
  const int num_fields = lobes_->num_fields();
  const Eigen::Index P = binned_.num_bins();
  const size_t nodes = lobes_->grid_shape().num_nodes();
  std::vector<const float*> field(num_fields);
  for (int i = 0; i < num_fields; ++i) field[i] = &fields[material][i * nodes];
  const Eigen::Index t = likelihood_->num_texels(),
                     n = likelihood_->num_sources();
  // The level of the light cancels in the ratios below.
  const RowMatrix texels =
      Eigen::Map<const RowMatrix>(mode.l.data(), 3, n).leftCols(t);
  const double highest = texels.maxCoeff();
  const std::vector<float> map =
      RelativeMap(texels.data(), likelihood_->num_texels());
  const RowMatrix of_directional_lights =
      (Eigen::Map<const RowMatrix>(mode.l.data(), 3, n)
           .rightCols(likelihood_->num_directional_lights())
           .array() -
       highest)
          .exp();
  std::vector<float> by_point(size_t{3} * block.num_points * num_fields);
  block.transport->RenderLobes(field.data(), num_fields, map.data(),
                               by_point.data());
  std::vector<RowMatrix> under_directional_lights;  // of a field [bins][3]
  for (int f = 0; f < num_fields; ++f) {
    under_directional_lights.push_back(directional_lights.Of(field[f]) *
                                       of_directional_lights.transpose());
  }
  const LobeMixture lobes = MixtureOf(material, parameters);
  const Eigen::Array3Xd colours = lobes.Colours();
  const Eigen::Array3Xd colour_slopes = lobes.ColourSlopes();
  std::vector<double> sum(size_t{3} * num_fields);
  for (Eigen::Index i = block.first_bin; i < block.first_bin + block.num_bins;
       ++i) {
    std::fill(sum.begin(), sum.end(), 0.0);
    for (int p = binned_.first[i]; p < binned_.first[i + 1]; ++p) {
      const float* out = &by_point[(p - block.first_point) * sum.size()];
      for (size_t k = 0; k < sum.size(); ++k) sum[k] += out[k];
    }
    const double count = binned_.first[i + 1] - binned_.first[i];
    for (size_t k = 0; k < sum.size(); ++k) {
      sum[k] = sum[k] / count + under_directional_lights[k / 3](i, k % 3);
    }
    for (int c = 0; c < 3; ++c) {
      double radiance = 0.0;
      for (int k = 0; k < num_lobes; ++k) {
        radiance += colours(c, k) * sum[3 * k * (1 + size) + c];
      }
      for (Eigen::Index j = 0; j < slopes[0].cols(); ++j) {
        double& slope = (*jacobian)(c * P + i, num_lobe_parameters() + j);
        for (int k = 0; k < num_lobes; ++k) {
          slope += colours(c, k) * slopes[material * num_lobes + k](i, j);
        }
        slope *= of_directional_lights(c, j / 2) / radiance;
      }
      const MutableLobeMixture row =
          MixtureOf(material, jacobian->row(c * P + i).data());
      for (int k = 0; k < num_lobes; ++k) {
        const double share = colours(c, k) / radiance;
        const double* of_lobe = &sum[3 * k * (1 + size) + c];
        for (int d = 0; d < row.code(k).size(); ++d) {
          row.code(k)[d] = share * of_lobe[3 * (1 + d)];
        }
        row.log_colour(k)[c] = colour_slopes(c, k) / radiance * of_lobe[0];
      }
    }
  }
}

Eigen::MatrixXd MarginalReflectance::Information(
    Expansion* at, Eigen::MatrixXd* of_hyperparameters) const {
  TabulateDerivatives(at);
  const double* const parameters = at->parameters.data();
  const RowMatrix G =
      LogRadianceJacobian(parameters, at->fields, DirectionalLights(parameters),
                          at->likelihood->mode);
  if (!G.allFinite()) return {};
  return likelihood_->Information(*at->likelihood, G, of_hyperparameters);
}

Eigen::MatrixXd MarginalReflectance::Information(
    const double* parameters, const DataErrors& errors,
    const LightHyperparameters& hyperparameters, const LightMode& mode,
    Eigen::MatrixXd* of_hyperparameters) const {
  const Fields fields = Tabulate(parameters, true);
  const DirectionalLightResponses directional_lights =
      DirectionalLights(parameters);
  const RowMatrix G =
      LogRadianceJacobian(parameters, fields, directional_lights, mode);
  if (!G.allFinite()) return {};
  return likelihood_->Information(
      Coloured(parameters, ShapeMatrices(directional_lights, fields,
                                         1 + lobes_->code_size())),
      errors, hyperparameters, mode, G, of_hyperparameters);
}

LogRadianceSlopes MarginalReflectance::Slopes(const double* parameters,
                                              double sigma,
                                              const LightMode& mode) const {
  const Fields fields = Tabulate(parameters, true);
  const DirectionalLightResponses directional_lights =
      DirectionalLights(parameters);
  const std::array<RowMatrix, 3> matrices = Coloured(
      parameters,
      ShapeMatrices(directional_lights, fields, 1 + lobes_->code_size()));
  LogRadianceSlopes out;
  out.by_light = likelihood_->LightJacobian(matrices, mode);
  out.by_parameters =
      LogRadianceJacobian(parameters, fields, directional_lights, mode);
  out.noise = likelihood_->NoiseVariance(matrices, sigma, mode);
  return out;
}

}  // namespace ibrdf
