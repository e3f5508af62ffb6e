#include "solvers/marginal/marginal_reflectance.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

namespace ibrdf {
namespace {

double Colour(double log_colour, int channel) {
  return std::exp(std::min(log_colour, LobeModel::kMaxLogColour)) *
         kMerlScale[channel];
}

}  // namespace

std::vector<float> RelativeMap(const double* log_radiance, int num_texels) {
  const size_t t = num_texels;
  const double highest = *std::max_element(log_radiance, log_radiance + 3 * t);
  std::vector<float> map(3 * t);
  for (size_t i = 0; i < t; ++i) {
    for (size_t c = 0; c < 3; ++c) {
      map[3 * i + c] =
          static_cast<float>(std::exp(log_radiance[c * t + i] - highest));
    }
  }
  return map;
}

MarginalReflectance::MarginalReflectance(
    const NeuralBrdfModel& model, int num_lobes,
    const std::vector<ShadingPoint>& points,
    const std::vector<double>& radiance, const LightProcess& process,
    const MarginalResolution& resolution, int num_threads)
    : resolution_(resolution),
      cells_(GroupByNormal(points, radiance, resolution.cells)) {
  CHECK_GT(cells_.num_cells(), 0);
  TransportOptions options;
  options.grid = resolution.grid;
  options.num_threads = num_threads;
  options.quadrature.near_rings = resolution.near_rings;
  options.quadrature.near_ring_samples = resolution.near_ring_samples;
  options.visibility = resolution.visibility;
  transport_ = std::make_unique<Transport>(cells_.points, resolution.map_height,
                                           resolution.map_width, options);
  lobes_ = std::make_unique<LobeModel>(model, num_lobes, resolution.grid,
                                       num_threads);
  likelihood_ = std::make_unique<MarginalLikelihood>(
      cells_.log_radiance, process, resolution.map_height, resolution.map_width,
      num_threads);
}

MarginalReflectance::FloatMatrix MarginalReflectance::CellMatrix(
    const float* field) const {
  FloatMatrix by_point(static_cast<Eigen::Index>(cells_.points.size()),
                       likelihood_->num_texels());
  transport_->LightMatrix(field, by_point.data());
  FloatMatrix by_cell(cells_.num_cells(), by_point.cols());
  for (int i = 0; i < cells_.num_cells(); ++i) {
    const int begin = cells_.first[i], count = cells_.first[i + 1] - begin;
    by_cell.row(i) = by_point.middleRows(begin, count).colwise().mean();
  }
  return by_cell;
}

void MarginalReflectance::CellMatrixGradient(const FloatMatrix& adjoint,
                                             float* gradient) const {
  FloatMatrix by_point(static_cast<Eigen::Index>(cells_.points.size()),
                       adjoint.cols());
  for (int i = 0; i < cells_.num_cells(); ++i) {
    const int begin = cells_.first[i], count = cells_.first[i + 1] - begin;
    by_point.middleRows(begin, count).rowwise() =
        adjoint.row(i) / static_cast<float>(count);
  }
  transport_->LightMatrixGradient(by_point.data(), gradient);
}

std::vector<MarginalReflectance::FloatMatrix>
MarginalReflectance::ShapeMatrices(const std::vector<float>& fields,
                                   int stride) const {
  const size_t nodes = lobes_->grid_shape().num_nodes();
  std::vector<FloatMatrix> shapes;
  for (int k = 0; k < lobes_->num_lobes(); ++k) {
    shapes.push_back(CellMatrix(&fields[k * stride * nodes]));
  }
  return shapes;
}

std::array<RowMatrix, 3> MarginalReflectance::Coloured(
    const double* parameters, const std::vector<FloatMatrix>& shapes) const {
  std::array<RowMatrix, 3> matrices;
  for (int c = 0; c < 3; ++c) {
    matrices[c].setZero(shapes[0].rows(), shapes[0].cols());
    for (size_t k = 0; k < shapes.size(); ++k) {
      const double* lobe = parameters + k * lobes_->lobe_size();
      matrices[c] +=
          Colour(lobe[lobes_->code_size() + c], c) * shapes[k].cast<double>();
    }
  }
  return matrices;
}

std::array<RowMatrix, 3> MarginalReflectance::Matrices(
    const double* parameters) const {
  std::vector<float> fields;
  lobes_->Tabulate(parameters, false, &fields);
  return Coloured(parameters, ShapeMatrices(fields, 1));
}

MarginalValue MarginalReflectance::Evaluate(
    const double* parameters, const Eigen::VectorXd& noise,
    const LightScales& scales, double tolerance, LightMode* mode,
    std::vector<double>* gradient) const {
  const int num_lobes = lobes_->num_lobes(), size = lobes_->code_size();
  const int stride = gradient != nullptr ? 1 + size : 1;
  const size_t nodes = lobes_->grid_shape().num_nodes();
  std::vector<float> fields;
  lobes_->Tabulate(parameters, gradient != nullptr, &fields);
  const std::vector<FloatMatrix> shapes = ShapeMatrices(fields, stride);
  MarginalGradient by_matrix;
  const MarginalValue value = likelihood_->Evaluate(
      Coloured(parameters, shapes), noise, scales, tolerance, mode,
      gradient != nullptr ? &by_matrix : nullptr);
  if (gradient == nullptr || !value.ok) return value;
  gradient->assign(lobes_->num_parameters() + LightScales::kCount, 0.0);
  std::vector<float> by_node(nodes);
  for (int k = 0; k < num_lobes; ++k) {
    const double* lobe = parameters + k * lobes_->lobe_size();
    double* out = gradient->data() + k * lobes_->lobe_size();
    FloatMatrix adjoint = FloatMatrix::Zero(shapes[k].rows(), shapes[k].cols());
    for (int c = 0; c < 3; ++c) {
      const double colour = Colour(lobe[size + c], c);
      adjoint += (colour * by_matrix.matrices[c]).cast<float>();
      if (!(lobe[size + c] < LobeModel::kMaxLogColour)) continue;  // clamped
      out[size + c] =
          colour *
          by_matrix.matrices[c].cwiseProduct(shapes[k].cast<double>()).sum();
    }
    CellMatrixGradient(adjoint, by_node.data());
    for (int d = 0; d < size; ++d) {
      const float* derivative = &fields[(k * stride + 1 + d) * nodes];
      double sum = 0.0;
      for (size_t i = 0; i < nodes; ++i) {
        sum += static_cast<double>(by_node[i]) * derivative[i];
      }
      out[d] = sum;
    }
  }
  std::copy(by_matrix.scales.begin(), by_matrix.scales.end(),
            gradient->end() - LightScales::kCount);
  return value;
}

RowMatrix MarginalReflectance::LogRadianceJacobian(
    const double* parameters, const std::vector<float>& fields,
    const LightMode& mode) const {
  const int num_lobes = lobes_->num_lobes(), size = lobes_->code_size();
  const int num_fields = num_lobes * (1 + size);
  const Eigen::Index P = cells_.num_cells();
  const size_t nodes = lobes_->grid_shape().num_nodes();
  std::vector<const float*> field(num_fields);
  for (int i = 0; i < num_fields; ++i) field[i] = &fields[i * nodes];
  // The level of the light cancels in the ratios below.
  const std::vector<float> map =
      RelativeMap(mode.l.data(), likelihood_->num_texels());
  std::vector<float> by_point(size_t{3} * cells_.points.size() * num_fields);
  transport_->RenderLobes(field.data(), num_fields, map.data(),
                          by_point.data());
  RowMatrix jacobian = RowMatrix::Zero(3 * P, lobes_->num_parameters());
  std::vector<double> sum(size_t{3} * num_fields);
  for (Eigen::Index i = 0; i < P; ++i) {
    std::fill(sum.begin(), sum.end(), 0.0);
    for (int p = cells_.first[i]; p < cells_.first[i + 1]; ++p) {
      const float* out = &by_point[p * sum.size()];
      for (size_t k = 0; k < sum.size(); ++k) sum[k] += out[k];
    }
    for (int c = 0; c < 3; ++c) {
      double radiance = 0.0;
      for (int k = 0; k < num_lobes; ++k) {
        const double* lobe = parameters + k * lobes_->lobe_size();
        radiance += Colour(lobe[size + c], c) * sum[3 * k * (1 + size) + c];
      }
      for (int k = 0; k < num_lobes; ++k) {
        const double log_colour =
            parameters[k * lobes_->lobe_size() + size + c];
        const double share = Colour(log_colour, c) / radiance;
        const double* of_lobe = &sum[3 * k * (1 + size) + c];
        double* row = &jacobian(c * P + i, k * lobes_->lobe_size());
        for (int d = 0; d < size; ++d) row[d] = share * of_lobe[3 * (1 + d)];
        if (log_colour < LobeModel::kMaxLogColour) {
          row[size + c] = share * of_lobe[0];
        }
      }
    }
  }
  return jacobian;
}

Eigen::MatrixXd MarginalReflectance::Information(const double* parameters,
                                                 const Eigen::VectorXd& noise,
                                                 const LightScales& scales,
                                                 const LightMode& mode) const {
  std::vector<float> fields;
  lobes_->Tabulate(parameters, true, &fields);
  const RowMatrix G = LogRadianceJacobian(parameters, fields, mode);
  if (!G.allFinite()) return {};
  return likelihood_->Information(
      Coloured(parameters, ShapeMatrices(fields, 1 + lobes_->code_size())),
      noise, scales, mode, G);
}

}  // namespace ibrdf
