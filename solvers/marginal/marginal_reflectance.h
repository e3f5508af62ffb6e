// The marginal likelihood as a function of lobes.
#pragma once
#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "ibrdf/brdf/lobe_model.h"
#include "ibrdf/solvers/marginal/directional_responses.h"
#include "ibrdf/solvers/marginal/marginal_likelihood.h"
#include "ibrdf/solvers/observation/normal_bins.h"
#include "ibrdf/solvers/priors/albedo_prior.h"
#include "ibrdf/transport/transport.h"

namespace ibrdf {

struct MarginalResolution {
  NormalBinOptions bins;
  int map_width = 32, map_height = 16;
  BrdfGridShape grid = {48, 20, 12};
  // Coarser than a render's, as the texels are.
  QuadratureOptions quadrature = {8.0, 16.0, 12, 32};
  std::shared_ptr<const Visibility> visibility = nullptr;  // of the points
};

// Parameters: the lobes' as LobeModel's, then of each directional light where
// it is (MovedDirectionalLight's offsets). Immutable but for what its callers
// keep; may be used from several threads.
class MarginalReflectance {
 public:
  // CHECKs that at least one point can be used. paint: the albedo varies over
  // the points, as this prior says, and a bin's mean is that of its points'
  // radiance without it; unset: it does not.
  MarginalReflectance(const LobeFactory& lobes,
                      const std::vector<ShadingPoint>& points,
                      const Observations& observed, const LightProcess& process,
                      const MarginalResolution& resolution, int num_threads,
                      std::vector<Eigen::Vector3d> directional_lights = {},
                      const std::optional<PaintPrior>& paint = std::nullopt);

  const LobeModel& lobes() const { return *lobes_; }
  const MarginalLikelihood& likelihood() const { return *likelihood_; }
  const NormalBins& bins() const { return binned_; }
  const MarginalResolution& resolution() const { return resolution_; }

  int num_parameters() const {
    return lobes_->num_parameters() +
           2 * static_cast<int>(directional_lights_.size());
  }
  // Parameters of lobes, with all directional lights where the constructor was
  // told.
  Eigen::VectorXd WithDirectionalLights(const Eigen::VectorXd& lobes) const;
  std::vector<Eigen::Vector3d> DirectionalLightDirections(
      const double* parameters) const;

  // As MarginalLikelihood::Evaluate. With gradient != nullptr it receives
  // [num_parameters + hyperparameters].
  MarginalValue Evaluate(const double* parameters, const DataErrors& errors,
                         const LightHyperparameters& hyperparameters,
                         double tolerance, LightMode* mode,
                         std::vector<double>* gradient) const;

  // As MarginalLikelihood::Information at the mode of these parameters.
  Eigen::MatrixXd Information(const double* parameters,
                              const DataErrors& errors,
                              const LightHyperparameters& hyperparameters,
                              const LightMode& mode) const;

  // The matrices T_c of parameters, and those of what paint scales (MattePart
  // of each lobe); empty ones without paint.
  std::array<RowMatrix, 3> MatteMatrices(const double* parameters) const;
  std::array<RowMatrix, 3> Matrices(const double* parameters) const;
  // Log radiance of the texels [3][H W], a directional light's light in the
  // texel that it is in.
  std::vector<double> LogRadiance(const double* parameters,
                                  const LightMode& mode) const;

 private:
  using FloatMatrix = DirectionalLightResponses::Matrix;
  // d log L_o / d parameters [3 * bins][num_parameters], the light held.
  RowMatrix LogRadianceJacobian(
      const double* parameters, const std::vector<float>& fields,
      const DirectionalLightResponses& directional_lights,
      const LightMode& mode) const;
  DirectionalLightResponses DirectionalLights(const double* parameters) const;
  // d DirectionalLights().Of(field) by the directional lights' offsets,
  // [bins][2 directional lights]: by central differences, as the fields are
  // linear between their nodes.
  std::vector<RowMatrix> DirectionalLightSlopes(
      const double* parameters, const std::vector<float>& fields,
      int stride) const;
  // The matrix of each lobe's shape, the first of its `stride` fields.
  std::vector<FloatMatrix> ShapeMatrices(
      const DirectionalLightResponses& directional_lights,
      const std::vector<float>& fields, int stride) const;
  // T_c of lobes of those shapes and the parameters' colours.
  std::array<RowMatrix, 3> Coloured(
      const double* parameters, const std::vector<FloatMatrix>& shapes) const;
  // [bins][sources] of a scalar field, and its transpose.
  FloatMatrix CellMatrix(const DirectionalLightResponses& directional_lights,
                         const float* field) const;
  void CellMatrixGradient(const DirectionalLightResponses& directional_lights,
                          const FloatMatrix& adjoint, float* gradient) const;

  MarginalResolution resolution_;
  NormalBins binned_;
  std::vector<Eigen::Vector3d> directional_lights_;
  std::unique_ptr<Transport> transport_;
  std::unique_ptr<const LobeModel> lobes_;
  std::unique_ptr<MarginalLikelihood> likelihood_;
};

}  // namespace ibrdf
