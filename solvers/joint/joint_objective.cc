#include "ibrdf/solvers/joint/joint_objective.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

namespace ibrdf {
namespace {

// Points that a preconditioner is made from.
constexpr int kSampledPoints = 200;

Eigen::Map<const Eigen::ArrayXd> Array(const std::vector<double>& v) {
  return {v.data(), static_cast<Eigen::Index>(v.size())};
}

std::vector<double> AdjointOf(const LikelihoodDerivatives& d) {
  std::vector<double> adjoint(d.residual.size());
  for (size_t i = 0; i < adjoint.size(); ++i) {
    adjoint[i] = d.residual[i] * d.d_residual[i];
  }
  return adjoint;
}

}  // namespace

JointObjective::JointObjective(JointTerms terms) : terms_(std::move(terms)) {
  CHECK(terms_.observed != nullptr);
  if (terms_.lobes != nullptr) {
    CHECK(terms_.transport != nullptr);
    lobes_.emplace(terms_.transport, terms_.lobes, terms_.lobe_prior);
  } else {
    CHECK(terms_.known_brdf != nullptr);
  }
  if (terms_.illumination != nullptr) {
    light_.emplace(terms_.illumination, terms_.light_mean, terms_.light_sigma,
                   terms_.light_priors);
  } else {
    CHECK(!terms_.known_map.empty());
  }
  CHECK(lobes_unknown() || light_unknown());
  L_o_.resize(terms_.observed->radiance.size());
}

void JointObjective::set_light_mean(std::vector<float> mean) {
  CHECK(light_unknown());
  light_->set_mean(mean);
  terms_.light_mean = std::move(mean);
  has_point_ = false;
}

void JointObjective::Free(JointBlocks blocks) {
  CHECK(blocks != JointBlocks::kLobes || lobes_unknown());
  CHECK(blocks != JointBlocks::kLight || light_unknown());
  free_ = blocks;
  has_point_ = false;
}

int JointObjective::num_lobe_parameters() const {
  const bool free = lobes_unknown() && free_ != JointBlocks::kLight;
  return free ? lobes_->num_parameters() : 0;
}

int JointObjective::num_light_parameters() const {
  const bool free = light_unknown() && free_ != JointBlocks::kLobes;
  return free ? light_->num_parameters() : 0;
}

Eigen::VectorXd JointObjective::InverseVariance() const {
  Eigen::VectorXd d(size());
  const int nl = num_lobe_parameters(), np = num_light_parameters();
  if (nl > 0) d.head(nl) = Array(lobes_->inverse_variance());
  if (np > 0) d.tail(np) = Array(light_->inverse_variance());
  return d;
}

Eigen::VectorXd JointObjective::ToVector(const JointState& state) const {
  Eigen::VectorXd x(size());
  const int nl = num_lobe_parameters(), np = num_light_parameters();
  for (int i = 0; i < nl; ++i) x[i] = state.lobes[i];
  for (int i = 0; i < np; ++i) x[nl + i] = state.light[i];
  return x;
}

JointState JointObjective::FromVector(const Eigen::VectorXd& x,
                                      JointState state) const {
  CHECK_EQ(x.size(), size());
  const int nl = num_lobe_parameters(), np = num_light_parameters();
  for (int i = 0; i < nl; ++i) state.lobes[i] = x[i];
  for (int i = 0; i < np; ++i) state.light[i] = static_cast<float>(x[nl + i]);
  return state;
}

JointState JointObjective::Moved(const JointState& state,
                                 const Eigen::VectorXd& step,
                                 double length) const {
  return FromVector(ToVector(state) + length * step, state);
}

const LinearTransport& JointObjective::OperatorOf(const JointState& state) {
  if (!lobes_unknown()) return *terms_.known_brdf;
  if (!operator_.has_value() || operator_lobes_ != state.lobes) {
    operator_.emplace(
        terms_.transport->ByLight(lobes_->Grid(state.lobes.data())));
    operator_lobes_ = state.lobes;
    has_point_ = false;
  }
  return *operator_;
}

std::vector<float> JointObjective::MapOf(const JointState& state) {
  if (!light_unknown()) return terms_.known_map;
  std::vector<float> map;
  light_->Evaluate(state.light.data(), &map);
  return map;
}

// L_o, map and cost. The operator is made where it will be used again: for
// derivatives in the light, or because the lobes are held.
JointCost JointObjective::Render(const JointState& state, bool linearise,
                                 LikelihoodDerivatives* derivatives) {
  JointCost cost;
  if (!light_unknown()) {
    map_ = terms_.known_map;
  } else if (linearise) {
    cost.illumination_prior = light_->Linearise(state.light.data(), &map_);
  } else {
    cost.illumination_prior = light_->Evaluate(state.light.data(), &map_);
  }
  const bool known_operator =
      !lobes_unknown() ||
      (operator_.has_value() && operator_lobes_ == state.lobes) || linearise ||
      num_lobe_parameters() == 0;
  if (known_operator) {
    OperatorOf(state).Apply(map_.data(), L_o_.data());
  } else {
    terms_.transport->Render(lobes_->Grid(state.lobes.data()), map_.data(),
                             L_o_.data());
  }
  if (lobes_unknown()) {
    cost.reflectance_prior =
        lobes_->Prior(state.lobes.data(), nullptr, nullptr);
  }
  const LikelihoodValue value = EvaluateLikelihood(
      L_o_, *terms_.observed, terms_.likelihood, derivatives);
  cost.likelihood = value.cost;
  cost.misfit = value.misfit;
  return cost;
}

JointCost JointObjective::Evaluate(const JointState& state) {
  return Render(state, false, nullptr);
}

std::vector<float> JointObjective::ByMap(const double* adjoint) const {
  std::vector<float> by_map(map_.size());
  Operator().ApplyTranspose(adjoint, by_map.data());
  return by_map;
}

JointCost JointObjective::Gradient(const JointState& state,
                                   Eigen::VectorXd* gradient) {
  has_point_ = false;
  const int nl = num_lobe_parameters(), np = num_light_parameters();
  const JointCost cost = Render(state, np > 0, &derivatives_);
  if (!std::isfinite(cost.total())) return cost;
  const std::vector<double> adjoint = AdjointOf(derivatives_);
  gradient->setZero(size());
  if (nl > 0) {
    lobes_->ReverseGradient(state.lobes.data(), map_.data(), adjoint,
                            gradient->data());
    lobes_->Prior(state.lobes.data(), gradient->data(), nullptr);
  }
  if (np > 0) light_->Gradient(ByMap(adjoint.data()), gradient->data() + nl);
  return cost;
}

JointCost JointObjective::Linearise(const JointState& state) {
  const int nl = num_lobe_parameters(), np = num_light_parameters();
  has_point_ = false;
  const JointCost cost = Render(state, np > 0, &derivatives_);
  if (!std::isfinite(cost.total())) return cost;
  const std::vector<double> adjoint = AdjointOf(derivatives_);
  gradient_.setZero(size());
  if (nl > 0) {
    lobe_jacobian_ = lobes_->RadianceJacobian(state.lobes.data(), map_.data());
    lobe_prior_gradient_.setZero(nl);
    lobe_prior_hessian_.setZero(nl, nl);
    lobes_->Prior(state.lobes.data(), lobe_prior_gradient_.data(),
                  &lobe_prior_hessian_);
    gradient_.head(nl) = lobe_prior_gradient_ +
                         lobe_jacobian_.transpose() * Array(adjoint).matrix();
  }
  if (np > 0) light_->Gradient(ByMap(adjoint.data()), gradient_.data() + nl);
  has_point_ = true;
  return cost;
}

void JointObjective::CheckPoint() const {
  CHECK(has_point_) << "Linearise first";
}

Eigen::VectorXd JointObjective::RadianceJvp(const Eigen::VectorXd& v) {
  CheckPoint();
  const int nl = num_lobe_parameters(), np = num_light_parameters();
  Eigen::VectorXd dL_o = Eigen::VectorXd::Zero(num_residuals());
  if (np > 0) {
    LogMap d_log;
    std::vector<float> d_map;
    light_->Jvp(v.data() + nl, &d_log, &d_map);
    Operator().ApplyLinear(d_map.data(), dL_o.data());
  }
  if (nl > 0) dL_o.noalias() += lobe_jacobian_ * v.head(nl);
  return dL_o;
}

Eigen::VectorXd JointObjective::RadianceVjp(const Eigen::VectorXd& adjoint) {
  CheckPoint();
  const int nl = num_lobe_parameters(), np = num_light_parameters();
  Eigen::VectorXd gradient(size());
  if (nl > 0) {
    gradient.head(nl).noalias() = lobe_jacobian_.transpose() * adjoint;
  }
  if (np > 0) light_->Vjp(ByMap(adjoint.data()), gradient.data() + nl);
  return gradient;
}

Eigen::VectorXd JointObjective::ResidualJvp(const Eigen::VectorXd& v) {
  return RadianceJvp(v).array() * Array(derivatives_.d_residual);
}

Eigen::VectorXd JointObjective::ResidualVjp(const Eigen::VectorXd& adjoint) {
  return RadianceVjp(adjoint.array() * Array(derivatives_.d_residual));
}

Eigen::VectorXd JointObjective::Product(const Eigen::VectorXd& v) {
  CheckPoint();
  const int nl = num_lobe_parameters(), np = num_light_parameters();
  Eigen::VectorXd dL_o = Eigen::VectorXd::Zero(num_residuals());
  LogMap d_log;
  std::vector<float> d_map;
  if (np > 0) {
    light_->Jvp(v.data() + nl, &d_log, &d_map);
    Operator().ApplyLinear(d_map.data(), dL_o.data());
  }
  if (nl > 0) dL_o.noalias() += lobe_jacobian_ * v.head(nl);
  dL_o.array() *= Array(derivatives_.weight);
  Eigen::VectorXd product(size());
  if (nl > 0) {
    product.head(nl).noalias() = lobe_jacobian_.transpose() * dL_o;
    product.head(nl).noalias() += lobe_prior_hessian_ * v.head(nl);
  }
  if (np > 0) {
    light_->Product(v.data() + nl, d_log, ByMap(dL_o.data()),
                    product.data() + nl);
  }
  return product;
}

Eigen::MatrixXd JointObjective::LobeHessian() const {
  CheckPoint();
  if (num_lobe_parameters() == 0) return {};
  return lobe_jacobian_.transpose() *
             (Array(derivatives_.weight).matrix().asDiagonal() *
              lobe_jacobian_) +
         lobe_prior_hessian_;
}

std::unique_ptr<LightPreconditioner> JointObjective::PreconditionerOfLight()
    const {
  CheckPoint();
  if (num_light_parameters() == 0) return nullptr;
  return light_->model().Preconditioner(
      [this] { return SampledInformation(); });
}

InformationRows JointObjective::SampledInformation() const {
  const MapSize size = light_->model().size();
  const int points = num_residuals() / 3;
  const int step = std::max(1, points / kSampledPoints);
  InformationRows out;
  out.num_points = (points - step / 2 + step - 1) / step;
  for (Eigen::MatrixXf& rows : out.of_channel) {
    rows.resize(Eigen::Index{out.num_points} * size.height, size.width);
  }
  std::vector<float> row(3 * size.num_texels());
  const std::vector<float>& slopes = light_->map_slopes();
  for (int i = 0; i < out.num_points; ++i) {
    const int point = step / 2 + i * step;
    if (!Operator().Row(point, row.data())) return {};
    for (size_t k = 0; k < row.size(); ++k) row[k] *= slopes[k];
    for (int c = 0; c < 3; ++c) {
      const double weight = derivatives_.weight[size_t{3} * point + c];
      const auto scale = static_cast<float>(
          std::sqrt(std::max(weight, 0.0) * points / out.num_points));
      using Channel =
          Eigen::Map<const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic,
                                         Eigen::RowMajor>,
                     0, Eigen::Stride<Eigen::Dynamic, 3>>;
      out.of_channel[c].middleRows(Eigen::Index{i} * size.height, size.height) =
          scale * Channel(row.data() + c, size.height, size.width,
                          {Eigen::Index{3} * size.width, 3});
    }
  }
  return out;
}

Eigen::VectorXd JointObjective::PriorGradient() {
  CheckPoint();
  const int nl = num_lobe_parameters(), np = num_light_parameters();
  Eigen::VectorXd gradient(size());
  if (nl > 0) gradient.head(nl) = lobe_prior_gradient_;
  if (np > 0) {
    light_->Gradient(std::vector<float>(map_.size(), 0.0f),
                     gradient.data() + nl);
  }
  return gradient;
}

Eigen::VectorXd JointObjective::PriorProduct(const Eigen::VectorXd& v) {
  CheckPoint();
  const int nl = num_lobe_parameters(), np = num_light_parameters();
  Eigen::VectorXd product(size());
  if (nl > 0) product.head(nl).noalias() = lobe_prior_hessian_ * v.head(nl);
  if (np > 0) {
    LogMap d_log;
    std::vector<float> d_map;
    light_->Jvp(v.data() + nl, &d_log, &d_map);
    light_->Product(v.data() + nl, d_log, std::vector<float>(map_.size(), 0.0f),
                    product.data() + nl);
  }
  return product;
}

}  // namespace ibrdf
