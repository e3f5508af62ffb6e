// The posterior with the light integrated out, by lobes and hyperparameters of
// the light.
#include <glog/logging.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "experiments/validation/derivatives/reference_flows.h"
#include "experiments/validation/derivatives/reference_transport.h"
#include "experiments/validation/derivatives/studies.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/solvers/marginal/marginal_objective.h"
#include "ibrdf/solvers/priors/light_process.h"
#include "tests/support/render_testing.h"
#include "tests/support/tiny_model.h"

namespace ibrdf {
namespace derivatives {
namespace {

using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using Matrices = std::array<Matrix, 3>;  // T_c [cells][texels]

// Laplace's approximation of MarginalLikelihood, dense and in long double.
class ExactMarginal {
 public:
  ExactMarginal(Vector y, const LightProcess& process, int height, int width,
                const Eigen::VectorXd& noise, const LightMode& start)
      : y_(std::move(y)),
        noise_(noise.cast<Real>()),
        level_(start.level),
        local_(process.Local().cast<Real>()),
        flat_(process.Level().cast<Real>()),
        process_(process),
        height_(height),
        width_(width),
        mode_(start.l.cast<Real>()) {}

  // Newton's method from the last mode.
  Real Cost(const Matrices& T, const LightHyperparameters& hyperparameters) {
    const Matrix correlation =
        LightCorrelation(height_, width_, process_, hyperparameters)
            .cast<Real>();
    const Eigen::Index t = correlation.rows(), n = 3 * t, P = T[0].rows();
    Matrix K(n, n);
    for (int c = 0; c < 3; ++c) {
      for (int d = 0; d < 3; ++d) {
        K.block(c * t, d * t, t, t) =
            (std::exp(Real(hyperparameters.log_amplitude)) * local_(c, d) *
             correlation)
                .array() +
            flat_(c, d);
      }
    }
    const Vector weight = noise_.cwiseInverse();
    const Eigen::LDLT<Matrix> precision(K);
    Vector l = mode_;
    Matrix J(3 * P, n);
    Vector r(3 * P);
    const auto look = [&](const Vector& at) {
      J.setZero();
      for (int c = 0; c < 3; ++c) {
        const Vector L = (at.segment(c * t, t).array() + level_).exp();
        const Vector L_o = T[c] * L;
        J.block(c * P, c * t, P, t) =
            L_o.cwiseInverse().asDiagonal() * T[c] * L.asDiagonal();
        r.segment(c * P, P) = y_.segment(c * P, P) - Vector(L_o.array().log());
      }
      return Real((r.cwiseAbs2().dot(weight) + at.dot(precision.solve(at))) /
                  2);
    };
    Real cost = look(l);
    for (int i = 0; i < 100; ++i) {
      const Vector g =
          precision.solve(l) - J.transpose() * weight.cwiseProduct(r);
      const Vector curvature = J.transpose() * weight.cwiseProduct(r);
      const Vector factor = weight + weight.cwiseProduct(r);
      Matrix S = J.transpose() * factor.asDiagonal() * J;
      S.diagonal() -= curvature;
      // (I + K S) step = -K g.
      const Vector step = (Matrix::Identity(n, n) + K * S)
                              .partialPivLu()
                              .solve(Vector(-(K * g)));
      Real length = std::min(Real(1), 4 / step.cwiseAbs().maxCoeff());
      Real next = look(l + length * step);
      while (!(next <= cost * (1 + 1e-17L)) && length > 1e-6L) {
        length /= 2;
        next = look(l + length * step);
      }
      l += length * step;
      cost = next;
      // Quadratic convergence: what is left is its square.
      if (step.cwiseAbs().maxCoeff() < 1e-9L) break;
    }
    cost = look(l);
    mode_ = l;
    Matrix A = J * K * J.transpose();
    A.diagonal() += noise_;
    const Eigen::LLT<Matrix> llt(A);
    return cost +
           Vector(llt.matrixL().toDenseMatrix().diagonal()).array().log().sum();
  }

 private:
  const Vector y_, noise_;
  const Real level_;
  const Eigen::Matrix<Real, 3, 3> local_, flat_;
  const LightProcess process_;
  const int height_, width_;
  Vector mode_;
};

class MarginalStudy {
 public:
  MarginalStudy(std::string name, const NeuralBrdfModel& model,
                ErrorTable* table)
      : name_(std::move(name)),
        model_(model),
        prior_(JointMaterialPrior(model, 2, 0.5)),
        points_(testing::SpherePoints(10)),
        table_(table) {
    resolution_.bins = {5, 2, 0.2};
    resolution_.map_width = 8;
    resolution_.map_height = 4;
    resolution_.grid = {12, 8, 6};
    resolution_.quadrature.near_rings = 8;
    resolution_.quadrature.near_ring_samples = 24;
  }

  // An image of other lobes than those at which derivatives are taken.
  void Add(const std::string& kind, const std::string& where,
           const std::vector<double>& truth, const std::vector<double>& at,
           const LightHyperparameters& hyperparameters) {
    TransportOptions options;
    options.grid = resolution_.grid;
    const Transport transport(points_, 8, 16, options);
    const FlowLobes lobes(model_, 2, resolution_.grid, 0);
    std::vector<double> radiance(3 * points_.size());
    transport.Render(lobes.Grid(truth.data()),
                     testing::SmoothMap(8, 16).rgb.data(), radiance.data());
    const MarginalReflectance reflectance(FlowLobes::Factory(model_, 2, 1),
                                          points_, MakeObservations(radiance),
                                          LightProcess(), resolution_, 0);
    const Eigen::Index cells = reflectance.bins().num_bins();
    const Eigen::VectorXd noise = Eigen::VectorXd::Constant(3 * cells, 0.0025);

    LightMode mode;
    std::vector<double> by_lobes;
    const MarginalValue value = reflectance.Evaluate(
        at.data(), {noise, {}}, hyperparameters, 1e-12, &mode, &by_lobes);
    CHECK(value.ok) << kind;
    const std::vector<Real> exact =
        Exact(reflectance, at, noise, hyperparameters, mode);
    table_->Add(name_ + ": likelihood by lobes", kind, where, by_lobes, exact);

    // The whole objective, whose mode is found to kModeTolerance only.
    LightMode start;
    start.level = mode.level;
    start.l = start.representers = Eigen::VectorXd::Zero(mode.l.size());
    const MarginalObjective objective(&reflectance, &prior_, {noise, {}},
                                      &start);
    const Eigen::Map<const Eigen::VectorXd> p(
        at.data(), static_cast<Eigen::Index>(at.size()));
    const std::vector<double> y = objective.Whitened(p, hyperparameters);
    std::vector<double> gradient(y.size());
    double cost = 0.0;
    CHECK(objective.Evaluate(y.data(), &cost, gradient.data())) << kind;
    const Eigen::Index n = p.size();
    Vector outer(n);
    for (Eigen::Index i = 0; i < n; ++i) outer[i] = exact[i];
    const Eigen::VectorXd lobes_at = objective.LobesOf(y.data());
    Eigen::VectorXd wall = Eigen::VectorXd::Zero(n);
    prior_.WallCost(lobes_at, &wall);
    const Matrix factor =
        prior_.factor.cast<Real>().triangularView<Eigen::Lower>();
    const Vector inner = factor.transpose() * (outer + wall.cast<Real>());
    std::vector<Real> right;
    for (Eigen::Index i = 0; i < n; ++i) right.push_back(y[i] + inner[i]);
    const auto stds = LightHyperparameters::Stds();
    for (int k = 0; k < LightHyperparameters::kCount; ++k) {
      right.push_back(y[n + k] + stds[k] * exact[n + k]);
    }
    table_->Add(name_ + ": objective, whitened", kind, where, gradient, right);
  }

 private:
  // [lobe parameters, hyperparameters].
  std::vector<Real> Exact(const MarginalReflectance& reflectance,
                          const std::vector<double>& at,
                          const Eigen::VectorXd& noise,
                          const LightHyperparameters& hyperparameters,
                          const LightMode& mode) const {
    const NormalBins& cells = reflectance.bins();
    TransportOptions options;
    options.grid = resolution_.grid;
    options.quadrature = resolution_.quadrature;
    const ReferenceTransport transport(cells.points, resolution_.map_height,
                                       resolution_.map_width, options);
    const int codes = model_.shape.code_size(), lobe_size = codes + 3;
    const std::vector<Real> fields =
        ReferenceFields(model_, 2, resolution_.grid, at);
    const size_t nodes = transport.num_nodes();
    // For each field the matrix [cells][texels].
    std::vector<Matrix> shape(2 * (1 + codes));
    for (size_t f = 0; f < shape.size(); ++f) {
      const std::vector<Real> field(fields.begin() + f * nodes,
                                    fields.begin() + (f + 1) * nodes);
      shape[f].setZero(cells.num_bins(), transport.num_texels());
      for (int i = 0; i < cells.num_bins(); ++i) {
        const int count = cells.first[i + 1] - cells.first[i];
        for (int k = cells.first[i]; k < cells.first[i + 1]; ++k) {
          const std::vector<Real> row = transport.MapRow(k, field);
          for (size_t t = 0; t < row.size(); ++t) {
            shape[f](i, t) += row[t] / count;
          }
        }
      }
    }
    const auto colour = [&](int k, int c) {
      return ReferenceColour(at[k * lobe_size + codes + c], c);
    };
    const int P = cells.num_bins();
    Matrices T;
    for (int c = 0; c < 3; ++c) {
      T[c].setZero(P, transport.num_texels());
      for (int k = 0; k < 2; ++k) {
        T[c] += colour(k, c) * shape[k * (1 + codes)];
      }
    }
    Vector y(3 * P);
    for (int i = 0; i < 3 * P; ++i) y[i] = cells.log_radiance[i];
    ExactMarginal marginal(y, LightProcess(), resolution_.map_height,
                           resolution_.map_width, noise, mode);
    marginal.Cost(T, hyperparameters);
    // Central differences: truncation of some 1e-10.
    const auto differentiate = [](const auto& cost) {
      constexpr Real kStep = 1e-5L;
      return (cost(kStep) - cost(-kStep)) / (2 * kStep);
    };
    std::vector<Real> out;
    for (int i = 0; i < 2 * lobe_size; ++i) {
      const int k = i / lobe_size, d = i % lobe_size;
      const bool clamped = d >= codes && at[i] >= kMaxLogColour;
      out.push_back(clamped ? Real(0) : differentiate([&](Real h) {
        Matrices moved = T;
        for (int c = 0; c < 3; ++c) {
          if (d < codes) {
            moved[c] += h * colour(k, c) * shape[k * (1 + codes) + 1 + d];
          } else if (c == d - codes) {
            moved[c] += h * colour(k, c) * shape[k * (1 + codes)];
          }
        }
        return marginal.Cost(moved, hyperparameters);
      }));
    }
    for (int k = 0; k < LightHyperparameters::kCount; ++k) {
      out.push_back(differentiate([&](Real h) {
        LightHyperparameters moved = hyperparameters;
        (k == 0 ? moved.log_amplitude : moved.log_roughness[k - 1]) +=
            static_cast<double>(h);
        return marginal.Cost(T, moved);
      }));
    }
    return out;
  }

  std::string name_;
  const NeuralBrdfModel& model_;
  const MaterialPrior prior_;
  const std::vector<ShadingPoint> points_;
  MarginalResolution resolution_;
  ErrorTable* table_;
};

void AddStates(const std::string& name, const NeuralBrdfModel& model, int count,
               std::mt19937_64* rng, ErrorTable* table) {
  MarginalStudy study(name, model, table);
  std::normal_distribution<double> normal;
  const int size = model.shape.code_size(), lobe_size = size + 3;
  const auto lobes = [&](double away) {
    std::vector<double> p;
    for (int k = 0; k < 2; ++k) {
      const size_t m = (*rng)() % model.num_codes();
      for (int d = 0; d < size; ++d) {
        p.push_back(model.codes[m * size + d] + away * normal(*rng));
      }
      for (int c = 0; c < 3; ++c) {
        p.push_back(model.log_colours[m] - 2 * k + away * normal(*rng));
      }
    }
    return p;
  };
  const std::vector<double> truth = lobes(0.1);
  std::vector<double> p = truth;
  // Beyond the clamp of colours.
  for (int c = 0; c < 3; ++c) p[2 * lobe_size - 3 + c] = 41.0;
  study.Add("a log colour of 41", "", truth, p, {});
  for (int i = 0; i < count; ++i) {
    LightHyperparameters hyperparameters;
    hyperparameters.log_amplitude = 0.3 * normal(*rng);
    for (double& s : hyperparameters.log_roughness) s = 0.6 * normal(*rng);
    study.Add("random", "state " + std::to_string(i), lobes(0.1), lobes(0.1),
              hyperparameters);
  }
  if (count == 0) return;
  study.Add("at the truth", "", truth, truth, {});
  p = lobes(0.0);
  for (int i = 0; i < 2 * lobe_size; ++i) {
    if (i % lobe_size < size) p[i] = 0.0;
  }
  study.Add("codes 0", "", truth, p, {});
  p = truth;
  std::copy_n(p.begin(), lobe_size, p.begin() + lobe_size);
  study.Add("lobes that coincide", "", truth, p, {});
  // One lobe vanishes.
  p = truth;
  for (int c = 0; c < 3; ++c) p[2 * lobe_size - 3 + c] = -60.0;
  study.Add("a log colour of -60", "", truth, p, {});
}

}  // namespace

void StudyMarginal(const NeuralBrdfModel& model, const StudyOptions& options,
                   ErrorTable* table) {
  std::mt19937_64 rng(options.seed);
  AddStates("marginal, random weights", TinyModel(3),
            std::min(options.points / 20, 5), &rng, table);
  if (options.points >= 100) {
    AddStates("marginal, default model", model, 1, &rng, table);
  }
}

}  // namespace derivatives
}  // namespace ibrdf
