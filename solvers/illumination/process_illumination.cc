#include "ibrdf/solvers/illumination/process_illumination.h"

#include <glog/logging.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "ibrdf/solvers/illumination/azimuthal_preconditioner.h"
#include "ibrdf/solvers/priors/directional_lights.h"
#include "ibrdf/solvers/priors/light_spectrum.h"

namespace ibrdf {
namespace {

// A factor's diagonal gets it, against the rounding of the highest frequencies
// at the poles.
constexpr double kJitter = 1e-10;

// Texels: a process of more would take minutes and gigabytes.
constexpr int kMostSide = 256;

class ProcessIllumination final : public IlluminationModel {
 public:
  ProcessIllumination(int width, int height, const LightProcess& process,
                      const LightHyperparameters& hyperparameters,
                      const std::vector<Eigen::Vector3d>& directional_lights)
      : IlluminationModel({width, height}),
        spectrum_(ProcessSpectrum(height, width, process).At(hyperparameters)),
        axes_(ColourAxes()),
        directional_light_texels_(
            NearDirectionalLights(directional_lights, height, width)) {
    const Eigen::Matrix3d local =
        std::exp(hyperparameters.log_amplitude) * process.Local();
    const Eigen::Matrix3d level = width * process.Level();
    for (int kind = 0; kind < 2; ++kind) {
      const Eigen::Vector3d axis = axes_.row(kind);
      directional_light_std_[kind] =
          std::sqrt(axis.dot(process.DirectionalLight() * axis));
      for (int k = 0; k < spectrum_.num_frequencies(); ++k) {
        RowMatrix factor = axis.dot(local * axis) * spectrum_.block(k);
        if (k == 0) factor.array() += axis.dot(level * axis);
        factor.diagonal() *= 1.0 + kJitter;
        CHECK(Factorise(&factor)) << "frequency " << k;
        factors_[kind].push_back(factor.triangularView<Eigen::Lower>());
      }
    }
  }

  int num_parameters() const override {
    return num_outputs() +
           3 * static_cast<int>(directional_light_texels_.size());
  }
  std::vector<float> ConstantMap(const double* log_radiance) const override {
    std::vector<float> w(num_parameters(), 0.0f);
    ShiftChannels(log_radiance, w.data());
    return w;
  }
  std::vector<float> PriorStd() const override {
    return std::vector<float>(num_parameters(), 1.0f);
  }
  void Forward(const float* parameters, LogMap* log_map) override {
    const int H = height(), W = width();
    RowMatrix coefficients(3 * H, W), axes;
    for (int a = 0; a < 3; ++a) {
      for (int j = 0; j < W; ++j) {
        coefficients.col(j).segment(a * H, H).noalias() =
            Factor(a, j).triangularView<Eigen::Lower>() *
            Eigen::Map<const Eigen::VectorXf>(parameters + Index(a, j), H)
                .cast<double>();
      }
    }
    MultiplyTransposed(coefficients, spectrum_.basis(), &axes);
    ForDirectionalLightTexels([&](int a, int texel, double std, int parameter) {
      axes(a * H + texel / W, texel % W) += std * parameters[parameter];
    });
    log_map->Reshape(size());
    for (int c = 0; c < 3; ++c) {
      log_map->Plane(c) = (axes_(0, c) * axes.middleRows(0, H) +
                           axes_(1, c) * axes.middleRows(H, H) +
                           axes_(2, c) * axes.middleRows(2 * H, H))
                              .cast<float>();
    }
  }
  // Linear: the products are the same everywhere.
  void Linearise(const float* parameters, LogMap* log_map) override {
    Forward(parameters, log_map);
  }
  void Jvp(const float* tangent, LogMap* d_log_map) override {
    Forward(tangent, d_log_map);
  }
  void Vjp(const LogMap& adjoint, float* gradient) override {
    const int H = height(), W = width();
    RowMatrix axes = RowMatrix::Zero(3 * H, W), coefficients;
    for (int a = 0; a < 3; ++a) {
      for (int c = 0; c < 3; ++c) {
        axes.middleRows(a * H, H) +=
            axes_(a, c) * adjoint.Plane(c).cast<double>();
      }
    }
    ForDirectionalLightTexels([&](int a, int texel, double std, int parameter) {
      gradient[parameter] =
          static_cast<float>(std * axes(a * H + texel / W, texel % W));
    });
    Multiply(axes, spectrum_.basis(), &coefficients);
    for (int a = 0; a < 3; ++a) {
      for (int j = 0; j < W; ++j) {
        Eigen::Map<Eigen::VectorXf>(gradient + Index(a, j), H) =
            (Factor(a, j).transpose().triangularView<Eigen::Upper>() *
             coefficients.col(j).segment(a * H, H))
                .cast<float>();
      }
    }
  }
  // Of a row the sines and cosines of one frequency are two samples: a turned
  // map has any mixture of them.
  std::unique_ptr<LightPreconditioner> Preconditioner(
      const std::function<InformationRows()>& rows) const override {
    const InformationRows information = rows();
    if (information.num_points == 0) return nullptr;
    const int frequencies = spectrum_.num_frequencies();
    std::vector<Eigen::MatrixXd> blocks(
        3 * static_cast<size_t>(frequencies),
        Eigen::MatrixXd::Zero(height(), height()));
    for (int c = 0; c < 3; ++c) {
      const std::vector<Eigen::MatrixXd> of_texels =
          AzimuthalMean(information.of_channel[c], information.num_points);
      for (int a = 0; a < 3; ++a) {
        for (int k = 0; k < frequencies; ++k) {
          blocks[a * frequencies + k] +=
              axes_(a, c) * axes_(a, c) * of_texels[k];
        }
      }
    }
    for (int a = 0; a < 3; ++a) {
      for (int k = 0; k < frequencies; ++k) {
        const Eigen::MatrixXd factor = factors_[a == 0 ? 0 : 1][k];
        Eigen::MatrixXd& block = blocks[a * frequencies + k];
        block = (factor.transpose() * block * factor).eval();
      }
    }
    return std::make_unique<AzimuthalPreconditioner>(
        width(), std::move(blocks), DirectionalLightInformation(information));
  }
  void ShiftChannels(const double* shift, float* parameters) const override {
    const int H = height();
    const Eigen::Vector3d by_axis =
        axes_ * Eigen::Vector3d(shift[0], shift[1], shift[2]);
    for (int a = 0; a < 3; ++a) {
      Eigen::VectorXd w = Eigen::VectorXd::Constant(
          H, by_axis[a] * std::sqrt(static_cast<double>(width())));
      Factor(a, 0).triangularView<Eigen::Lower>().solveInPlace(w);
      Eigen::Map<Eigen::VectorXf>(parameters + Index(a, 0), H) +=
          w.cast<float>();
    }
  }

 private:
  // of(axis, texel, standard deviation, parameter) of what the directional
  // lights add.
  template <typename Of>
  void ForDirectionalLightTexels(const Of& of) const {
    int parameter = num_outputs();
    for (int a = 0; a < 3; ++a) {
      for (const DirectionalLightTexel& near : directional_light_texels_) {
        of(a, near.texel, directional_light_std_[a == 0 ? 0 : 1] * near.weight,
           parameter++);
      }
    }
  }

  // J^T W J of a channel's texels by frequency, the mean over all turns about
  // the vertical, mirrored and not.
  std::vector<Eigen::MatrixXd> AzimuthalMean(const Eigen::MatrixXf& rows,
                                             int num_points) const {
    std::vector<Eigen::MatrixXd> blocks(
        spectrum_.num_frequencies(), Eigen::MatrixXd::Zero(height(), height()));
    const Eigen::MatrixXf coefficients = rows * spectrum_.basis().cast<float>();
    for (int j = 0; j < width(); ++j) {
      const bool alone = j == 0 || j == width() - 1;
      const Eigen::Map<const Eigen::MatrixXf> of_points(
          coefficients.col(j).data(), height(), num_points);
      blocks[LightSpectrum::FrequencyOf(j)] +=
          ((alone ? 1.0f : 0.5f) * of_points * of_points.transpose())
              .cast<double>();
    }
    return blocks;
  }
  // The diagonal of J^T W J of the directional lights' parameters.
  Eigen::VectorXd DirectionalLightInformation(
      const InformationRows& information) const {
    Eigen::VectorXd diagonal =
        Eigen::VectorXd::Zero(num_parameters() - num_outputs());
    ForDirectionalLightTexels([&](int a, int texel, double std, int parameter) {
      for (int c = 0; c < 3; ++c) {
        double squares = 0.0;
        for (int p = 0; p < information.num_points; ++p) {
          squares +=
              std::pow(information.of_channel[c](p * height() + texel / width(),
                                                 texel % width()),
                       2);
        }
        diagonal[parameter - num_outputs()] +=
            std::pow(std * axes_(a, c), 2) * squares;
      }
    });
    return diagonal;
  }

  // Parameters: [axis][coefficient][row], then the directional lights'
  // [axis][texel].
  size_t Index(int axis, int j) const {
    return (static_cast<size_t>(axis) * width() + j) * height();
  }
  const RowMatrix& Factor(int axis, int j) const {
    return factors_[axis == 0 ? 0 : 1][LightSpectrum::FrequencyOf(j)];
  }

  const LightSpectrum spectrum_;
  const Eigen::Matrix3d axes_;
  // The factors of grey and of chroma, by frequency; lower triangular.
  std::vector<RowMatrix> factors_[2];
  const std::vector<DirectionalLightTexel> directional_light_texels_;
  double directional_light_std_[2];
};

}  // namespace

std::unique_ptr<IlluminationModel> MakeProcessIllumination(
    int width, int height, const LightProcess& process,
    const LightHyperparameters& hyperparameters,
    const std::vector<Eigen::Vector3d>& directional_lights) {
  return std::make_unique<ProcessIllumination>(
      width, height, process, hyperparameters, directional_lights);
}

MapSize ProcessSize(MapSize size) {
  while (std::max(size.width, size.height) > kMostSide) {
    size.width = std::max(size.width / 4 * 2, 8);
    size.height = std::max(size.height / 2, 4);
  }
  return size;
}

}  // namespace ibrdf
