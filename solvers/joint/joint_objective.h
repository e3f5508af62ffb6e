// The one objective of the joint estimate, with every derivative product that a
// solver may take.
#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "ibrdf/solvers/costs/log_likelihood.h"
#include "ibrdf/solvers/joint/light_block.h"
#include "ibrdf/solvers/joint/lobe_block.h"

namespace ibrdf {

// A block that is known is empty.
struct JointState {
  std::vector<double> lobes;  // as LobeModel
  std::vector<float> light;   // parameters of the IlluminationModel
};

// What the objective is made of. All that is pointed to must outlive it.
struct JointTerms {
  const Observations* observed = nullptr;
  RobustLogLikelihood likelihood;
  // Reflectance, unknown: `transport`, `lobes` and their prior.
  const Transport* transport = nullptr;
  const LobeModel* lobes = nullptr;
  LobePrior lobe_prior;
  // Known: its transport of light (then `lobes` is null).
  const LinearTransport* known_brdf = nullptr;
  // Illumination, unknown: its model and priors, see LightBlock.
  IlluminationModel* illumination = nullptr;
  std::vector<float> light_mean;
  double light_sigma = 1.0;
  std::vector<LightPrior*> light_priors;
  // Known: [H, W, 3] (then `illumination` is null).
  std::vector<float> known_map;
};

// Nats.
struct JointCost {
  double likelihood = 0.0;  // NaN where the radiance is not finite
  double reflectance_prior = 0.0;
  double illumination_prior = 0.0;
  double misfit = 0.0;  // mean |log L_o - log I|, no part of the total
  double total() const {
    return likelihood + reflectance_prior + illumination_prior;
  }
};

enum class JointBlocks { kBoth, kLobes, kLight };

// Vectors of parameters are [lobes; light], of the free blocks alone; those of
// radiance and residuals are [points * 3]. At most one block is known. Not
// thread-safe (it is parallel inside); same bits for any number of threads.
class JointObjective {
 public:
  explicit JointObjective(JointTerms terms);

  const JointTerms& terms() const { return terms_; }
  bool lobes_unknown() const { return lobes_.has_value(); }
  bool light_unknown() const { return light_.has_value(); }
  void set_likelihood(const RobustLogLikelihood& l) {
    terms_.likelihood = l;
    has_point_ = false;
  }
  void set_light_mean(std::vector<float> mean);

  // Which unknown blocks derivatives are taken in and solvers move; at first
  // all. The cost has the terms of both whatever is held.
  void Free(JointBlocks blocks);
  JointBlocks free_blocks() const { return free_; }
  int num_lobe_parameters() const;   // 0 if held or known
  int num_light_parameters() const;  // 0 if held or known
  int size() const { return num_lobe_parameters() + num_light_parameters(); }
  int num_residuals() const {
    return static_cast<int>(terms_.observed->radiance.size());
  }
  // That of the priors' diagonal Gaussians: the metric of the free blocks.
  Eigen::VectorXd InverseVariance() const;
  Eigen::VectorXd ToVector(const JointState& state) const;
  // `state` with its free blocks replaced by x.
  JointState FromVector(const Eigen::VectorXd& x, JointState state) const;
  JointState Moved(const JointState& state, const Eigen::VectorXd& step,
                   double length) const;

  JointCost Evaluate(const JointState& state);
  // Radiance and map of the state that was last given.
  const std::vector<double>& radiance() const { return L_o_; }
  const std::vector<float>& map() const { return map_; }
  // The map of a state, [H, W, 3], and the transport of its reflectance, which
  // holds until the lobes change.
  std::vector<float> MapOf(const JointState& state);
  const LinearTransport& OperatorOf(const JointState& state);

  // Cost and gradient [size] by reverse passes; no point for products is left,
  // and an earlier one is lost. NaN cost: the gradient is not set.
  JointCost Gradient(const JointState& state, Eigen::VectorXd* gradient);

  // Makes the state the point of everything below, until the next Gradient,
  // Linearise, Free or change of the terms. The lobes' tangent fields
  // are rendered here, once, not for each product. A NaN cost leaves no point.
  JointCost Linearise(const JointState& state);

  const Eigen::VectorXd& gradient() const { return gradient_; }
  const std::vector<double>& residuals() const { return derivatives_.residual; }
  // dL_o along v [size]; gradient [size] of sum adjoint . L_o.
  Eigen::VectorXd RadianceJvp(const Eigen::VectorXd& v);
  Eigen::VectorXd RadianceVjp(const Eigen::VectorXd& adjoint);
  // The same of the likelihood's residuals, whose squares / 2 are its cost.
  Eigen::VectorXd ResidualJvp(const Eigen::VectorXd& v);
  Eigen::VectorXd ResidualVjp(const Eigen::VectorXd& adjoint);
  // (J^T W J + H of the priors) v, W the reweighted squares' (see
  // LikelihoodDerivatives).
  Eigen::VectorXd Product(const Eigen::VectorXd& v);
  // The lobes' block of that matrix, [num_lobe_parameters]^2.
  Eigen::MatrixXd LobeHessian() const;
  // Of the light's block; null where it is held or its model has none.
  std::unique_ptr<LightPreconditioner> PreconditionerOfLight() const;
  // The priors' share of gradient() and Product().
  Eigen::VectorXd PriorGradient();
  Eigen::VectorXd PriorProduct(const Eigen::VectorXd& v);

 private:
  JointCost Render(const JointState& state, bool linearise,
                   LikelihoodDerivatives* derivatives);
  // by_map [H, W, 3] of sum adjoint . L_o at the last operator.
  std::vector<float> ByMap(const double* adjoint) const;
  const LinearTransport& Operator() const {
    if (!lobes_unknown()) return *terms_.known_brdf;
    return *operator_;
  }
  void CheckPoint() const;
  // Of some of the points, evenly taken; none where the transport has no rows.
  InformationRows SampledInformation() const;

  JointTerms terms_;
  std::optional<LobeBlock> lobes_;
  std::optional<LightBlock> light_;
  JointBlocks free_ = JointBlocks::kBoth;
  std::vector<double> operator_lobes_;  // what operator_ was made from
  std::optional<LightOperator> operator_;

  std::vector<double> L_o_;
  std::vector<float> map_;
  // The point of products.
  bool has_point_ = false;
  LikelihoodDerivatives derivatives_;
  RowMatrix lobe_jacobian_;  // [points * 3, lobe parameters]
  Eigen::VectorXd lobe_prior_gradient_;
  Eigen::MatrixXd lobe_prior_hessian_;
  Eigen::VectorXd gradient_;
};

}  // namespace ibrdf
