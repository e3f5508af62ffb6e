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

// How the log radiance of bins moves, and how well it is measured.
struct LogRadianceSlopes {
  std::array<RowMatrix, 3> by_light;  // J of a channel [bins][sources]
  RowMatrix by_parameters;            // G [3 * bins][parameters]
  Eigen::VectorXd noise;              // D [3 * bins]
};

// Parameters: the lobes' as LobeModel's, then of each directional light where
// it is (MovedDirectionalLight's offsets). Immutable but for what its callers
// keep; may be used from several threads.
class MarginalReflectance {
  using FloatMatrix = DirectionalLightResponses::Matrix;
  // Fields of each material's lobes (LobeModel::Tabulate).
  using Fields = std::vector<std::vector<float>>;

 public:
  // CHECKs that at least one point can be used. num_materials: of the points
  // (ShadingPoint::material); the lobes are as many for each, one material's
  // after the other's, and light points of their own material alone. paint: the
  // albedo varies over
  // the points, as this prior says, and a bin's mean is that of its points'
  // radiance without it; unset: it does not.
  MarginalReflectance(const LobeFactory& lobes,
                      const std::vector<ShadingPoint>& points,
                      const Observations& observed, const LightProcess& process,
                      const MarginalResolution& resolution, int num_threads,
                      std::vector<Eigen::Vector3d> directional_lights = {},
                      const std::optional<PaintPrior>& paint = std::nullopt,
                      int num_materials = 1);

  const LobeModel& lobes() const { return *lobes_; }  // of one material
  const MarginalLikelihood& likelihood() const { return *likelihood_; }
  const NormalBins& bins() const { return binned_; }
  const MarginalResolution& resolution() const { return resolution_; }

  int num_materials() const { return static_cast<int>(blocks_.size()); }
  // The lobes of all materials have so many.
  int num_lobe_parameters() const {
    return num_materials() * lobes_->num_parameters();
  }
  int num_parameters() const {
    return num_lobe_parameters() +
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

  // What its derivatives at some parameters need.
  struct Expansion {
    std::vector<double> parameters;
    std::vector<FloatMatrix> shapes;
    std::unique_ptr<const MarginalLikelihood::Expansion> likelihood;
    // Of the lobes' with derivatives; empty before one of the two below makes
    // them.
    Fields fields;
  };
  // As Evaluate without a gradient. `expansion` receives the one around the
  // mode where the value is ok. near: as MarginalLikelihood::Expand's.
  MarginalValue Expand(const double* parameters, const DataErrors& errors,
                       const LightHyperparameters& hyperparameters,
                       double tolerance, const Expansion* near, LightMode* mode,
                       Expansion* expansion) const;
  // The gradient of Evaluate, and the Information below, at an expansion.
  std::vector<double> Gradient(Expansion* at) const;
  Eigen::MatrixXd Information(
      Expansion* at, Eigen::MatrixXd* of_hyperparameters = nullptr) const;

  // As MarginalLikelihood::Information at the mode of these parameters.
  Eigen::MatrixXd Information(
      const double* parameters, const DataErrors& errors,
      const LightHyperparameters& hyperparameters, const LightMode& mode,
      Eigen::MatrixXd* of_hyperparameters = nullptr) const;

  // At these parameters under the light of `mode`, whatever the image shows.
  // sigma: as NoiseVariance's. Without paint.
  LogRadianceSlopes Slopes(const double* parameters, double sigma,
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
  // The bins of a material and their points, in a row.
  struct Block {
    int first_bin = 0, num_bins = 0;
    int first_point = 0, num_points = 0;
    std::unique_ptr<Transport> transport;  // of the points; null: none
    FloatMatrix uniform;  // of a shape that is 1, [bins][texels]
  };
  std::vector<Block> MakeBlocks(int num_materials, int num_threads) const;
  Fields Tabulate(const double* parameters, bool derivatives) const;
  void TabulateDerivatives(Expansion* at) const;
  // A material's lobes, in parameters or a gradient.
  template <typename Number>
  auto MixtureOf(int material, Number* parameters) const {
    return lobes_->Mixture(parameters + material * lobes_->num_parameters());
  }
  // Adds a material's part of the gradient. fields: of the material, with
  // derivatives; shapes and slopes: of all lobes.
  void AddGradient(int material, const double* parameters,
                   const std::vector<float>& fields,
                   const DirectionalLightResponses& directional_lights,
                   const std::vector<FloatMatrix>& shapes,
                   const std::vector<RowMatrix>& slopes,
                   const MarginalGradient& by_matrix, double* gradient) const;
  // d log L_o / d parameters [3 * bins][num_parameters], the light held.
  RowMatrix LogRadianceJacobian(
      const double* parameters, const Fields& fields,
      const DirectionalLightResponses& directional_lights,
      const LightMode& mode) const;
  // The rows of a material's bins and the columns of its lobes. slopes: of
  // DirectionalLightSlopes.
  void AddLogRadianceJacobian(
      int material, const double* parameters, const Fields& fields,
      const DirectionalLightResponses& directional_lights,
      const std::vector<RowMatrix>& slopes, const LightMode& mode,
      RowMatrix* jacobian) const;
  DirectionalLightResponses DirectionalLights(const double* parameters) const;
  // d DirectionalLights().Of(field) by the directional lights' offsets,
  // [bins][2 directional lights]: by central differences, as the fields are
  // linear between their nodes.
  std::vector<RowMatrix> DirectionalLightSlopes(const double* parameters,
                                                const Fields& fields,
                                                int stride) const;
  // The matrix of each lobe's shape, the first of its `stride` fields, one
  // material's after the other's: [bins of the material][sources].
  std::vector<FloatMatrix> ShapeMatrices(
      const DirectionalLightResponses& directional_lights, const Fields& fields,
      int stride) const;
  // T_c of lobes of those shapes and the parameters' colours.
  std::array<RowMatrix, 3> Coloured(
      const double* parameters, const std::vector<FloatMatrix>& shapes) const;
  // [bins of a material][texels] of scalar fields.
  std::vector<FloatMatrix> TexelMatrices(
      const Block& block, const std::vector<const float*>& fields) const;
  // [bins of a material][sources] of scalar fields, and the transpose of one.
  std::vector<FloatMatrix> CellMatrices(
      const Block& block, const DirectionalLightResponses& directional_lights,
      const std::vector<const float*>& fields) const;
  // Whether a shape is that of a Lambertian lobe.
  bool IsUniform(const float* field) const;
  void CellMatrixGradient(const Block& block,
                          const DirectionalLightResponses& directional_lights,
                          const FloatMatrix& adjoint, float* gradient) const;

  MarginalResolution resolution_;
  NormalBins binned_;
  std::vector<Eigen::Vector3d> directional_lights_;
  std::vector<Block> blocks_;  // by material
  std::unique_ptr<const LobeModel> lobes_;
  std::unique_ptr<MarginalLikelihood> likelihood_;
};

}  // namespace ibrdf
