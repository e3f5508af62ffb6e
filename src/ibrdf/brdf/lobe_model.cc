#include "ibrdf/brdf/lobe_model.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/flow/coupling_flow_reference.h"

namespace ibrdf {
namespace {

// exp(exponent * log q) without overflow of float: a density above e^80 is no
// reflectance.
float Shape(double exponent, double log_density) {
  return static_cast<float>(std::exp(std::min(exponent * log_density, 80.0)));
}

double Colour(double log_colour) {
  return std::exp(std::min(log_colour, LobeModel::kMaxLogColour));
}

}  // namespace

LobeModel::LobeModel(const NeuralBrdfModel& model, int num_lobes,
                     const BrdfGridShape& grid, int num_threads)
    : model_(model),
      flow_(model.shape, model.weights),
      num_lobes_(num_lobes),
      grid_(grid),
      num_threads_(num_threads) {
  CHECK_GE(num_lobes, 1);
  const int n = grid.num_nodes();
  nodes_.resize(3 * static_cast<size_t>(n));
  for (int node = 0; node < n; ++node) {
    const Eigen::Vector3d x = grid.NodePoint(node);
    for (int i = 0; i < 3; ++i) {
      nodes_[static_cast<size_t>(i) * n + node] = static_cast<float>(x[i]);
    }
  }
}

void LobeModel::Tabulate(const double* parameters, bool derivatives,
                         std::vector<float>* fields) const {
  const size_t n = grid_.num_nodes();
  const int stride = derivatives ? 1 + code_size() : 1;
  fields->resize(n * stride * num_lobes_);
  std::vector<float> code(code_size());
  for (int k = 0; k < num_lobes_; ++k) {
    const double* z = parameters + static_cast<size_t>(k) * lobe_size();
    std::copy(z, z + code_size(), code.begin());
    float* value = fields->data() + static_cast<size_t>(k) * stride * n;
    if (derivatives) {
      flow_.LogDensityWithGradient(nodes_.data(), static_cast<int64_t>(n),
                                   code.data(), num_threads_, value, value + n,
                                   nullptr);
    } else {
      flow_.LogDensity(nodes_.data(), static_cast<int64_t>(n), code.data(),
                       num_threads_, value, nullptr);
    }
    for (size_t i = 0; i < n; ++i) value[i] = Shape(model_.exponent, value[i]);
    for (int d = 1; d < stride; ++d) {
      float* derivative = value + d * n;
      for (size_t i = 0; i < n; ++i) {
        derivative[i] *= static_cast<float>(model_.exponent) * value[i];
      }
    }
  }
}

void LobeModel::TabulateReference(const double* parameters, bool derivatives,
                                  std::vector<float>* fields) const {
  const size_t n = grid_.num_nodes();
  const int stride = derivatives ? 1 + code_size() : 1;
  fields->resize(n * stride * num_lobes_);
  const CouplingFlowReference<double> flow(model_.shape, model_.weights.data());
  for (int k = 0; k < num_lobes_; ++k) {
    const double* z = parameters + static_cast<size_t>(k) * lobe_size();
    float* value = fields->data() + static_cast<size_t>(k) * stride * n;
    ParallelFor(static_cast<int64_t>(n), num_threads_, [&](int64_t i, int) {
      const double x[3] = {nodes_[i], nodes_[n + i], nodes_[2 * n + i]};
      double u[3];
      std::vector<double> dz(code_size());
      const double log_density =
          derivatives
              ? flow.LogDensityWithGradient(x, z, nullptr, dz.data(), nullptr)
              : flow.LogDensity(x, z, u);
      value[i] = Shape(model_.exponent, log_density);
      for (int d = 1; d < stride; ++d) {
        value[d * n + i] =
            static_cast<float>(model_.exponent * value[i] * dz[d - 1]);
      }
    });
  }
}

BrdfGrid LobeModel::Combine(const double* parameters,
                            const std::vector<float>& fields,
                            int stride) const {
  BrdfGrid grid(grid_);
  const size_t n = grid_.num_nodes();
  for (int k = 0; k < num_lobes_; ++k) {
    const float* shape = fields.data() + static_cast<size_t>(k) * stride * n;
    for (int c = 0; c < 3; ++c) {
      const double a =
          parameters[static_cast<size_t>(k) * lobe_size() + code_size() + c];
      const float colour = static_cast<float>(Colour(a) * kMerlScale[c]);
      float* out = grid.Channel(c);
      for (size_t i = 0; i < n; ++i) out[i] += colour * shape[i];
    }
  }
  return grid;
}

MerlTable LobeModel::ToMerl(const double* parameters) const {
  std::vector<int> bins;
  for (int i = 0; i < kMerlThetaH; ++i) {
    for (int j = 0; j < kMerlThetaD; ++j) {
      for (int k = 0; k < kMerlPhiD; ++k) {
        if (MerlBinAboveHorizon(i, j, k))
          bins.push_back(MerlTable::Bin(i, j, k));
      }
    }
  }
  const size_t n = bins.size();
  std::vector<float> x(3 * n), value(n), code(code_size());
  for (size_t p = 0; p < n; ++p) {
    const Eigen::Vector3d cube =
        ToUnitCube(MerlThetaH(bins[p] / (kMerlThetaD * kMerlPhiD)),
                   MerlThetaD(bins[p] / kMerlPhiD % kMerlThetaD),
                   MerlPhiD(bins[p] % kMerlPhiD));
    for (int i = 0; i < 3; ++i) x[i * n + p] = static_cast<float>(cube[i]);
  }
  MerlTable table;
  table.raw.assign(size_t{3} * kMerlBins, -1.0);
  for (int c = 0; c < 3; ++c) {
    for (const int bin : bins) table.raw[size_t{kMerlBins} * c + bin] = 0.0;
  }
  for (int k = 0; k < num_lobes_; ++k) {
    const double* lobe = parameters + static_cast<size_t>(k) * lobe_size();
    std::copy(lobe, lobe + code_size(), code.begin());
    flow_.LogDensity(x.data(), static_cast<int64_t>(n), code.data(),
                     num_threads_, value.data(), nullptr);
    for (size_t p = 0; p < n; ++p) {
      const double shape = Shape(model_.exponent, value[p]);
      for (int c = 0; c < 3; ++c) {
        table.raw[size_t{kMerlBins} * c + bins[p]] +=
            Colour(lobe[code_size() + c]) * shape;
      }
    }
  }
  return table;
}

}  // namespace ibrdf
