// The joint objective: gradient, and radiance along a direction; and the same
// likelihood as one Ceres cost, row by row.
#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "experiments/validation/derivatives/reference_flows.h"
#include "experiments/validation/derivatives/reference_scene.h"
#include "experiments/validation/derivatives/studies.h"
#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/light/illumination_unet_reference.h"
#include "ibrdf/light/log_map.h"
#include "ibrdf/solvers/costs/log_radiance_cost.h"
#include "ibrdf/solvers/illumination/natural_noise.h"
#include "ibrdf/solvers/joint/joint_objective.h"
#include "tests/support/render_testing.h"
#include "tests/support/solver_testing.h"
#include "tests/support/tiny_model.h"

namespace ibrdf {
namespace derivatives {
namespace {

constexpr Real kMaxLogMap = kMaxLogRadiance;

class JointStudy {
 public:
  JointStudy(std::string name, const NeuralBrdfModel& model, ErrorTable* table)
      : name_(std::move(name)),
        model_(model),
        scene_(testing::SpherePoints(5), testing::SmoothMap(8, 16)),
        lobes_(model, 2, scene_.options().grid, 0),
        unet_(testing::TinyUnetOptions(),
              NaturalNoise(testing::TinyUnetOptions())),
        light_(MakeUnetIllumination(testing::TinyUnetOptions())),
        reference_(unet_.plan(), {unet_.noise().begin(), unet_.noise().end()}),
        table_(table) {
    const double zero[3] = {0, 0, 0};
    terms_.transport = &scene_.transport();
    terms_.lobes = &lobes_;
    for (double& m : terms_.lobe_prior.colour_mean) m = 4.0;
    terms_.illumination = light_.get();
    terms_.light_mean = light_->ConstantMap(zero);
    terms_.likelihood.scale = 0.1;
  }

  const std::vector<float>& light_mean() const { return terms_.light_mean; }
  std::vector<float> light_std() const { return light_->PriorStd(); }

  // The image is the state's own render times factors of about e^+-0.3, or, of
  // two kinds of points, with a value of 0 or 1e30 among them.
  void Add(const std::string& kind, const std::string& where,
           const JointState& state, float bright = 0.0f) {
    const Exact exact = Reference(state);
    std::vector<double> image = ImageOf(exact);
    if (bright > 0.0f) image[4] = bright;
    const Observations observed = MakeObservations(image);
    terms_.observed = &observed;
    terms_.likelihood.epsilon = 1e-3 * image[0];
    JointObjective objective(terms_);
    Eigen::VectorXd gradient;
    objective.Gradient(state, &gradient);
    objective.Linearise(state);
    const std::vector<Real> right = Gradient(state, exact, observed);
    // The blocks apart: the larger one would hide the other.
    const auto nl = static_cast<std::ptrdiff_t>(state.lobes.size());
    const auto add = [&](const std::string& what, const Eigen::VectorXd& v) {
      const std::vector<double> found = ToVector(v);
      table_->Add(name_ + ": " + what + " by lobes", kind, where,
                  {found.begin(), found.begin() + nl},
                  {right.begin(), right.begin() + nl});
      table_->Add(name_ + ": " + what + " by light", kind, where,
                  {found.begin() + nl, found.end()},
                  {right.begin() + nl, right.end()});
    };
    add("gradient", gradient);
    add("gradient of Linearise", objective.gradient());
    Eigen::VectorXd v(objective.size());
    for (Eigen::Index i = 0; i < v.size(); ++i) v[i] = std::cos(3.0 * i);
    table_->Add(name_ + ": radiance along a direction", kind, where,
                ToVector(objective.RadianceJvp(v)), Jvp(state, exact, v));
  }

  // The rows of LogRadianceCost, one block after the other.
  void AddCeresCost(const std::string& kind, const std::string& where,
                    const JointState& state) {
    const Exact exact = Reference(state);
    const std::vector<double> image = ImageOf(exact);
    const Observations observed = MakeObservations(image);
    RobustLogLikelihood likelihood = terms_.likelihood;
    likelihood.epsilon = 1e-3 * image[0];
    const LogRadianceCost cost(&scene_.transport(), &lobes_, &unet_, &observed,
                               likelihood);
    const std::vector<double> weights(state.light.begin(), state.light.end());
    const size_t rows = image.size(), nl = state.lobes.size(),
                 nw = weights.size();
    std::vector<double> residuals(rows), by_lobes(rows * nl),
        by_light(rows * nw);
    const double* blocks[] = {state.lobes.data(), weights.data()};
    double* jacobians[] = {by_lobes.data(), by_light.data()};
    CHECK(cost.Evaluate(blocks, residuals.data(), jacobians));
    for (size_t i = 0; i < rows; ++i) {
      const Real slope = ResidualSlope(exact.L_o[i], image[i], likelihood);
      std::vector<Real> lobe_row(nl), by_map(exact.map.size(), 0);
      for (size_t p = 0; p < nl; ++p) {
        lobe_row[p] = slope * exact.dL_o[i * nl + p];
      }
      AddMapRow(exact, i, slope, &by_map);
      const std::string at = where + ", row " + std::to_string(i);
      const double* found = &by_lobes[i * nl];
      table_->Add(name_ + ": row of the Ceres cost by lobes", kind, at,
                  {found, found + nl}, lobe_row);
      found = &by_light[i * nw];
      table_->Add(name_ + ": row of the Ceres cost by light", kind, at,
                  {found, found + nw}, ByWeight(exact, by_map));
    }
  }

 private:
  struct Exact {
    std::vector<Real> L_o, dL_o, map;
    std::vector<char> moves;  // whether a texel's log radiance is unclamped
    std::vector<std::vector<Real>> brdf;
    UnetReferencePass<Real> pass;
    std::vector<Real> weights;
  };

  static std::vector<double> ImageOf(const Exact& exact) {
    std::vector<double> image;
    for (size_t i = 0; i < exact.L_o.size(); ++i) {
      image.push_back(static_cast<double>(exact.L_o[i]) *
                      std::exp(0.3 * std::sin(5.0 * static_cast<double>(i))));
    }
    return image;
  }

  // Adds factor times the derivative of radiance i by the map [texels][3].
  void AddMapRow(const Exact& exact, size_t i, Real factor,
                 std::vector<Real>* by_map) const {
    const std::vector<Real> row =
        scene_.reference().MapRow(static_cast<int>(i / 3), exact.brdf[i % 3]);
    for (size_t t = 0; t < row.size(); ++t) {
      (*by_map)[3 * t + i % 3] += factor * row[t];
    }
  }

  // The UNet's vector-Jacobian product of a derivative by the map.
  std::vector<Real> ByWeight(const Exact& exact,
                             const std::vector<Real>& by_map) const {
    const size_t texels = exact.map.size() / 3;
    std::vector<Real> by_log(exact.map.size(), 0);
    for (size_t t = 0; t < texels; ++t) {
      for (size_t c = 0; c < 3; ++c) {
        const size_t at = 3 * t + c;
        by_log[c * texels + t] =
            exact.moves[at] ? by_map[at] * exact.map[at] : 0;
      }
    }
    return reference_.Vjp(exact.weights, by_log, exact.pass);
  }

  Exact Reference(const JointState& state) const {
    Exact exact;
    exact.weights.assign(state.light.begin(), state.light.end());
    exact.pass = reference_.Forward(exact.weights);
    const std::vector<Real>& log_map = exact.pass.log_radiance();
    const size_t texels = log_map.size() / 3;
    exact.map.resize(log_map.size());
    exact.moves.resize(log_map.size());
    for (size_t t = 0; t < texels; ++t) {
      for (size_t c = 0; c < 3; ++c) {
        const Real l = log_map[c * texels + t];
        exact.map[3 * t + c] = std::exp(std::clamp(l, -kMaxLogMap, kMaxLogMap));
        exact.moves[3 * t + c] = std::abs(l) < kMaxLogMap;
      }
    }
    const std::vector<Real> fields =
        ReferenceFields(model_, 2, lobes_.grid_shape(), state.lobes);
    const LobeRadiance radiance =
        scene_.Radiance(fields, lobes_.code_size(), state.lobes, exact.map);
    exact.L_o = radiance.L_o;
    exact.dL_o = radiance.dL_o;
    exact.brdf = scene_.Brdf(fields, lobes_.code_size(), state.lobes);
    return exact;
  }

  std::vector<Real> Gradient(const JointState& state, const Exact& exact,
                             const Observations& observed) const {
    const RobustLogLikelihood& l = terms_.likelihood;
    const size_t nl = state.lobes.size();
    std::vector<Real> gradient(nl, 0), by_map(exact.map.size(), 0);
    for (size_t i = 0; i < exact.L_o.size(); ++i) {
      if (!observed.valid[i / 3]) continue;
      const Real adjoint = Residual(exact.L_o[i], observed.radiance[i], l) *
                           ResidualSlope(exact.L_o[i], observed.radiance[i], l);
      for (size_t p = 0; p < nl; ++p) {
        gradient[p] += adjoint * exact.dL_o[i * nl + p];
      }
      AddMapRow(exact, i, adjoint, &by_map);
    }
    const LobePrior& prior = terms_.lobe_prior;
    const size_t size = lobes_.code_size(), lobe_size = size + 3;
    for (size_t k = 0; k < nl / lobe_size; ++k) {
      const double* z = &state.lobes[k * lobe_size];
      Real square = 0;
      for (size_t d = 0; d < size; ++d) square += Real(z[d]) * z[d];
      const Real norm = std::sqrt(square);
      for (size_t d = 0; d < lobe_size; ++d) {
        Real& g = gradient[k * lobe_size + d];
        if (d < size) {
          g += z[d] / (Real(prior.sigma) * prior.sigma);
          if (norm > 1) {
            g += Real(prior.wall) * prior.wall * (norm - 1) * z[d] / norm;
          }
        } else {
          g += (z[d] - Real(prior.colour_mean[d - size])) /
               (Real(prior.colour_sigma) * prior.colour_sigma);
        }
      }
    }
    std::vector<Real> by_weight = ByWeight(exact, by_map);
    const std::vector<float> std = light_->PriorStd();
    for (size_t i = 0; i < by_weight.size(); ++i) {
      const Real s = Real(terms_.light_sigma) * std[i];
      by_weight[i] += (exact.weights[i] - Real(terms_.light_mean[i])) / (s * s);
    }
    gradient.insert(gradient.end(), by_weight.begin(), by_weight.end());
    return gradient;
  }

  std::vector<Real> Jvp(const JointState& state, const Exact& exact,
                        const Eigen::VectorXd& v) const {
    const size_t nl = state.lobes.size(), texels = exact.map.size() / 3;
    std::vector<Real> tangent;
    for (Eigen::Index i = nl; i < v.size(); ++i) {
      tangent.push_back(static_cast<float>(v[i]));  // as the UNet takes it
    }
    const std::vector<Real> d_log =
        reference_.Jvp(exact.weights, tangent, exact.pass);
    std::vector<Real> dL_o(exact.L_o.size(), 0);
    for (size_t i = 0; i < dL_o.size(); ++i) {
      const size_t c = i % 3;
      for (size_t p = 0; p < nl; ++p) dL_o[i] += exact.dL_o[i * nl + p] * v[p];
      const std::vector<Real> row =
          scene_.reference().MapRow(static_cast<int>(i / 3), exact.brdf[c]);
      for (size_t t = 0; t < texels; ++t) {
        const size_t at = 3 * t + c;
        if (exact.moves[at]) {
          dL_o[i] += row[t] * exact.map[at] * d_log[c * texels + t];
        }
      }
    }
    return dL_o;
  }

  std::string name_;
  const NeuralBrdfModel& model_;
  ReferenceScene scene_;
  FlowLobes lobes_;
  IlluminationUnet unet_;
  std::unique_ptr<IlluminationModel> light_;
  UnetReference<Real> reference_;
  JointTerms terms_;
  ErrorTable* table_;
};

void AddStates(const std::string& name, const NeuralBrdfModel& model, int count,
               std::mt19937_64* rng, ErrorTable* table) {
  JointStudy study(name, model, table);
  std::normal_distribution<double> normal;
  const size_t size = model.shape.code_size(), lobe_size = size + 3;
  const std::vector<float> std = study.light_std();
  const auto random = [&](double norm) {
    JointState state;
    for (int k = 0; k < 2; ++k) {
      const size_t m = (*rng)() % model.num_codes();
      double square = 0.0;
      for (size_t d = 0; d < size; ++d) {
        state.lobes.push_back(model.codes[m * size + d] + 0.1 * normal(*rng));
        square += state.lobes.back() * state.lobes.back();
      }
      for (size_t d = 0; d < size && norm >= 0.0; ++d) {
        state.lobes[k * lobe_size + d] *= norm / std::sqrt(square);
      }
      for (int c = 0; c < 3; ++c) state.lobes.push_back(4 + normal(*rng));
    }
    state.light = study.light_mean();
    for (size_t i = 0; i < std.size(); ++i) {
      state.light[i] +=
          0.3f * std::min(std[i], 3.0f) * static_cast<float>(normal(*rng));
    }
    return state;
  };
  for (int i = 0; i < count; ++i) {
    const JointState state = random(-1.0);
    study.Add("random", "state " + std::to_string(i), state);
    if (i == 0) study.AddCeresCost("random", "state 0", state);
  }
  study.Add("codes 0", "", random(0.0));
  study.Add("codes of norm 1 + 1e-6", "", random(1 + 1e-6));
  study.Add("codes of norm 3", "", random(3.0));
  study.Add("a pixel of 1e30", "", random(-1.0), 1e30f);
  for (const double colour : {-60.0, 60.0}) {
    JointState state = random(-1.0);
    for (size_t i = 0; i < state.lobes.size(); ++i) {
      if (i % lobe_size >= size) state.lobes[i] = colour;
    }
    study.Add("log colours " + Coordinates({colour}), "", state);
    study.AddCeresCost("log colours " + Coordinates({colour}), "", state);
  }
  // The last weights are the map's levels.
  for (const float level : {-30.0f, 30.0f, 62.0f}) {
    JointState state = random(-1.0);
    for (size_t c = 1; c <= 3; ++c) {
      state.light[state.light.size() - c] = level;
      if (level > 0) {
        state.lobes[lobe_size - c] = state.lobes[2 * lobe_size - c] = -20.0;
      }
    }
    study.Add("log radiance about " + Coordinates({level}), "", state);
  }
}

}  // namespace

void StudyJoint(const NeuralBrdfModel& model, const StudyOptions& options,
                ErrorTable* table) {
  std::mt19937_64 rng(options.seed);
  const NeuralBrdfModel tiny = TinyModel(3);
  AddStates("joint, random weights", tiny, std::max(options.points / 10, 3),
            &rng, table);
  AddStates("joint, default model", model, std::max(options.points / 50, 1),
            &rng, table);
}

}  // namespace derivatives
}  // namespace ibrdf
