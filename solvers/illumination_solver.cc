#include "solvers/illumination_solver.h"

#include <ceres/first_order_function.h>
#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ibrdf/light/environment_map.h"
#include "solvers/stop_callback.h"

namespace ibrdf {
namespace {

constexpr float kMaxLogRadiance = 60.0f;
constexpr double kPi = 3.14159265358979323846;

double Dot(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0.0;
  for (size_t i = 0; i < a.size(); ++i) {
    sum += static_cast<double>(a[i]) * b[i];
  }
  return sum;
}

// Differences between neighbouring texels of a planar map [3][H][W]; columns
// wrap. See IlluminationPriorOptions.
class EdgePrior {
 public:
  EdgePrior(int height, int width, const IlluminationPriorOptions& options)
      : height_(height), width_(width), delta_(options.edge_delta) {
    if (options.edge_scale <= 0.0) return;
    const double scale = options.edge_scale * options.edge_scale;
    const double row_angle = kPi / height;
    const double equator = TexelSolidAngle(height / 2, height, width);
    for (int r = 0; r < height; ++r) {
      const double column_angle =
          2 * kPi / width * std::sin((r + 0.5) * row_angle);
      share_.push_back(TexelSolidAngle(r, height, width) / equator);
      along_.push_back(1.0 / (scale * column_angle));
      down_.push_back(1.0 / (scale * row_angle));
    }
  }

  // The sum; with `gradient`, adds its gradient and keeps the weights of later
  // products.
  double Evaluate(const float* map, float* gradient) {
    if (share_.empty()) return 0.0;
    double sum = 0.0;
    if (gradient != nullptr) weights_.clear();
    ForEachEdge([&](size_t a, size_t b, double share, double inverse_square) {
      double d[3], t2 = 0.0;
      for (int c = 0; c < 3; ++c) {
        d[c] = static_cast<double>(map[b + c * Plane()]) - map[a + c * Plane()];
        t2 += d[c] * d[c] * inverse_square;
      }
      const double root = std::sqrt(t2 + delta_ * delta_);
      sum += share * t2 / (root + delta_);
      if (gradient == nullptr) return;
      const double weight = share * inverse_square / root;
      weights_.push_back(static_cast<float>(weight));
      for (int c = 0; c < 3; ++c) {
        gradient[b + c * Plane()] += static_cast<float>(weight * d[c]);
        gradient[a + c * Plane()] -= static_cast<float>(weight * d[c]);
      }
    });
    return sum;
  }

  // out += (iteratively reweighted) Hessian of the last gradient's point times
  // v.
  void AddProduct(const float* v, float* out) const {
    if (share_.empty()) return;
    size_t edge = 0;
    ForEachEdge([&](size_t a, size_t b, double, double) {
      const float weight = weights_[edge++];
      for (int c = 0; c < 3; ++c) {
        const float d = weight * (v[b + c * Plane()] - v[a + c * Plane()]);
        out[b + c * Plane()] += d;
        out[a + c * Plane()] -= d;
      }
    });
  }

 private:
  size_t Plane() const { return static_cast<size_t>(height_) * width_; }

  template <typename Function>
  void ForEachEdge(const Function& f) const {
    for (int r = 0; r < height_; ++r) {
      const size_t row = static_cast<size_t>(r) * width_;
      for (int x = 0; x < width_; ++x) {
        f(row + x, row + (x + 1) % width_, share_[r], along_[r]);
        if (r + 1 < height_) {
          f(row + x, row + width_ + x, share_[r], down_[r]);
        }
      }
    }
  }

  const int height_, width_;
  const double delta_;
  std::vector<double> share_, along_, down_;
  std::vector<float> weights_;
};

// Everything the objective and its products share.
class Objective {
 public:
  Objective(const LightOperator& light, const Observations& observed,
            const IlluminationStepOptions& options,
            const std::vector<float>& prior_mean, IlluminationModel* model)
      : light_(light),
        observed_(observed),
        options_(options),
        mean_(prior_mean),
        model_(model),
        edges_(model->height(), model->width(), options.prior) {
    for (const float s : model->PriorStd()) {
      inverse_variance_.push_back(
          1.0f / static_cast<float>(options.prior.weight_sigma *
                                    options.prior.weight_sigma * s * s));
    }
    E_.resize(observed.radiance.size());
  }

  // Cost; with `gradient` also the point of later products and the gradient.
  IlluminationCost Evaluate(const float* parameters,
                            std::vector<float>* gradient) {
    IlluminationCost cost;
    log_map_.resize(model_->num_outputs());
    if (gradient != nullptr) {
      model_->Linearise(parameters, log_map_.data());
    } else {
      model_->Forward(parameters, log_map_.data());
    }
    ToRadianceMap(log_map_, &map_);
    light_.Apply(map_.data(), E_.data());
    const RobustLogLikelihood& l = options_.likelihood;
    if (gradient != nullptr) {
      weight_.assign(E_.size(), 0.0);
      adjoint_.assign(E_.size(), 0.0);
    }
    for (size_t i = 0; i < E_.size(); ++i) {
      if (!observed_.valid[i / 3]) continue;
      if (!std::isfinite(E_[i])) {
        cost.likelihood = std::numeric_limits<double>::quiet_NaN();
        return cost;
      }
      const double e = std::max(E_[i], 0.0) + l.epsilon;
      const double t =
          (std::log(e) - std::log(observed_.radiance[i] + l.epsilon)) / l.scale;
      const double root = std::sqrt(t * t + l.delta * l.delta);
      cost.likelihood += t * t / (root + l.delta);
      if (gradient != nullptr) {
        const double dt = 1.0 / (l.scale * e);
        adjoint_[i] = t / root * dt;
        weight_[i] = dt * dt / root;  // IRLS: rho'(t) / t
      }
    }
    std::vector<float> by_log;
    if (gradient != nullptr) by_log.assign(log_map_.size(), 0.0f);
    cost.prior += edges_.Evaluate(
        log_map_.data(), gradient != nullptr ? by_log.data() : nullptr);
    for (size_t i = 0; i < mean_.size(); ++i) {
      const double d = static_cast<double>(parameters[i]) - mean_[i];
      cost.prior += 0.5 * inverse_variance_[i] * d * d;
    }
    if (gradient != nullptr) {
      AddMapAdjoint(adjoint_, &by_log);
      gradient->resize(mean_.size());
      model_->Vjp(by_log.data(), gradient->data());
      for (size_t i = 0; i < mean_.size(); ++i) {
        (*gradient)[i] += inverse_variance_[i] * (parameters[i] - mean_[i]);
      }
    }
    return cost;
  }

  // Gauss-Newton product at the last point evaluated with a gradient.
  void Product(const std::vector<float>& v, std::vector<float>* Hv) {
    std::vector<float> d_log(model_->num_outputs());
    model_->Jvp(v.data(), d_log.data());
    std::vector<float> d_map(d_log.size());
    const size_t texels = d_log.size() / 3;
    for (size_t t = 0; t < texels; ++t) {
      for (size_t c = 0; c < 3; ++c) {
        d_map[3 * t + c] = base_map_[3 * t + c] * d_log[c * texels + t];
      }
    }
    std::vector<double> dE(E_.size());
    light_.Apply(d_map.data(), dE.data());
    for (size_t i = 0; i < dE.size(); ++i) dE[i] *= weight_[i];
    std::vector<float> by_log(d_log.size(), 0.0f);
    edges_.AddProduct(d_log.data(), by_log.data());
    AddMapAdjoint(dE, &by_log);
    Hv->resize(v.size());
    model_->Vjp(by_log.data(), Hv->data());
    for (size_t i = 0; i < v.size(); ++i)
      (*Hv)[i] += inverse_variance_[i] * v[i];
  }

  // Call after Evaluate with a gradient: keeps the map that products use.
  void KeepPoint() { base_map_ = map_; }

  const std::vector<float>& inverse_variance() const {
    return inverse_variance_;
  }
  const std::vector<double>& E() const { return E_; }
  const std::vector<float>& map() const { return map_; }

 private:
  // by_log += (dL/dl)^T A^T adjoint, at base_map_ or the map just evaluated.
  void AddMapAdjoint(const std::vector<double>& adjoint,
                     std::vector<float>* by_log) {
    const std::vector<float>& map = &adjoint == &adjoint_ ? map_ : base_map_;
    std::vector<float> by_map(map.size());
    light_.ApplyTranspose(adjoint.data(), by_map.data());
    const size_t texels = map.size() / 3;
    for (size_t t = 0; t < texels; ++t) {
      for (size_t c = 0; c < 3; ++c) {
        (*by_log)[c * texels + t] += by_map[3 * t + c] * map[3 * t + c];
      }
    }
  }

  const LightOperator& light_;
  const Observations& observed_;
  const IlluminationStepOptions& options_;
  const std::vector<float>& mean_;
  IlluminationModel* model_;
  EdgePrior edges_;
  std::vector<float> inverse_variance_, log_map_, map_, base_map_;
  std::vector<double> E_, weight_, adjoint_;
};

// Solves (H + damping D) step = -gradient by conjugate gradients preconditioned
// with the prior's variances, D their inverse. Stops at a residual of a tenth,
// which an inexact Newton method needs no better.
std::vector<float> ConjugateGradients(Objective* objective,
                                      const std::vector<float>& gradient,
                                      double damping, int max_iterations) {
  const std::vector<float>& d = objective->inverse_variance();
  const size_t n = gradient.size();
  std::vector<float> x(n, 0.0f), r(n), z(n), p(n), Hp;
  for (size_t i = 0; i < n; ++i) {
    r[i] = -gradient[i];
    z[i] = r[i] / d[i];
  }
  p = z;
  double rz = Dot(r, z);
  const double stop = rz * 1e-2;
  for (int k = 0; k < max_iterations && rz > stop; ++k) {
    objective->Product(p, &Hp);
    for (size_t i = 0; i < n; ++i) {
      Hp[i] += static_cast<float>(damping) * d[i] * p[i];
    }
    const double curvature = Dot(p, Hp);
    if (!(curvature > 0.0)) break;
    const float alpha = static_cast<float>(rz / curvature);
    for (size_t i = 0; i < n; ++i) {
      x[i] += alpha * p[i];
      r[i] -= alpha * Hp[i];
      z[i] = r[i] / d[i];
    }
    const double next = Dot(r, z);
    const float beta = static_cast<float>(next / rz);
    rz = next;
    for (size_t i = 0; i < n; ++i) p[i] = z[i] + beta * p[i];
  }
  return x;
}

IlluminationCost GaussNewton(Objective* objective,
                             const IlluminationStepOptions& options,
                             std::vector<float>* parameters) {
  std::vector<float> gradient, candidate(parameters->size());
  IlluminationCost cost = objective->Evaluate(parameters->data(), &gradient);
  objective->KeepPoint();
  double damping = 1.0;
  for (int k = 0; k < options.max_iterations; ++k) {
    if (options.should_stop && options.should_stop()) break;
    const std::vector<float> step = ConjugateGradients(
        objective, gradient, damping, options.max_cg_iterations);
    // Along the step first (cheap: forward passes only), then shorter steps.
    bool accepted = false;
    IlluminationCost best = cost;
    for (float length = 1.0f; length > 0.02f; length *= 0.4f) {
      for (size_t i = 0; i < step.size(); ++i) {
        candidate[i] = (*parameters)[i] + length * step[i];
      }
      best = objective->Evaluate(candidate.data(), nullptr);
      if (best.total() < cost.total()) {
        accepted = true;
        damping =
            std::clamp(length == 1.0f ? damping / 4 : damping * 2, 1e-4, 1e6);
        break;
      }
    }
    if (!accepted) {
      damping *= 16;
      if (damping > 1e6) break;
      continue;
    }
    const double gain = cost.total() - best.total();
    *parameters = candidate;
    cost = objective->Evaluate(parameters->data(), &gradient);
    objective->KeepPoint();
    if (gain < options.tolerance * cost.total()) break;
  }
  return cost;
}

class CeresObjective final : public ceres::FirstOrderFunction {
 public:
  CeresObjective(Objective* objective, int size)
      : objective_(objective), size_(size) {}
  int NumParameters() const override { return size_; }
  bool Evaluate(const double* x, double* cost,
                double* gradient) const override {
    // Whitened by the prior, so that L-BFGS starts well scaled.
    std::vector<float> parameters(size_), g;
    const std::vector<float>& d = objective_->inverse_variance();
    for (int i = 0; i < size_; ++i) {
      parameters[i] = static_cast<float>(x[i] / std::sqrt(d[i]));
    }
    const IlluminationCost c = objective_->Evaluate(
        parameters.data(), gradient != nullptr ? &g : nullptr);
    if (!std::isfinite(c.total())) return false;
    *cost = c.total();
    if (gradient != nullptr) {
      for (int i = 0; i < size_; ++i) gradient[i] = g[i] / std::sqrt(d[i]);
    }
    return true;
  }

 private:
  Objective* objective_;
  const int size_;
};

IlluminationCost Lbfgs(Objective* objective,
                       const IlluminationStepOptions& options,
                       std::vector<float>* parameters) {
  const std::vector<float>& d = objective->inverse_variance();
  std::vector<double> x(parameters->size());
  for (size_t i = 0; i < x.size(); ++i) {
    x[i] = (*parameters)[i] * std::sqrt(static_cast<double>(d[i]));
  }
  ceres::GradientProblem problem(
      new CeresObjective(objective, static_cast<int>(x.size())));
  ceres::GradientProblemSolver::Options o;
  o.line_search_direction_type = ceres::LBFGS;
  o.max_lbfgs_rank = 20;
  // As many gradients as Gauss-Newton would take products.
  o.max_num_iterations = options.max_iterations * options.max_cg_iterations;
  o.function_tolerance = options.tolerance / options.max_cg_iterations;
  o.logging_type = ceres::SILENT;
  StopCallback stop(options.should_stop);
  o.callbacks.push_back(&stop);
  ceres::GradientProblemSolver::Summary summary;
  ceres::Solve(o, problem, x.data(), &summary);
  std::vector<float> end(x.size());
  for (size_t i = 0; i < x.size(); ++i) {
    end[i] = static_cast<float>(x[i] / std::sqrt(static_cast<double>(d[i])));
  }
  const IlluminationCost before =
      objective->Evaluate(parameters->data(), nullptr);
  const IlluminationCost after = objective->Evaluate(end.data(), nullptr);
  if (!(after.total() < before.total())) return before;
  *parameters = end;
  return after;
}

}  // namespace

void ToRadianceMap(const std::vector<float>& log_radiance,
                   std::vector<float>* map) {
  map->resize(log_radiance.size());
  const size_t texels = log_radiance.size() / 3;
  for (size_t t = 0; t < texels; ++t) {
    for (size_t c = 0; c < 3; ++c) {
      (*map)[3 * t + c] = std::exp(std::clamp(
          log_radiance[c * texels + t], -kMaxLogRadiance, kMaxLogRadiance));
    }
  }
}

IlluminationCost EvaluateIllumination(
    const LightOperator& light, const Observations& observed,
    const IlluminationStepOptions& options,
    const std::vector<float>& prior_mean, const float* parameters,
    IlluminationModel* model, std::vector<double>* E, std::vector<float>* map) {
  Objective objective(light, observed, options, prior_mean, model);
  const IlluminationCost cost = objective.Evaluate(parameters, nullptr);
  if (E != nullptr) *E = objective.E();
  if (map != nullptr) *map = objective.map();
  return cost;
}

IlluminationCost SolveIllumination(const LightOperator& light,
                                   const Observations& observed,
                                   const IlluminationStepOptions& options,
                                   const std::vector<float>& prior_mean,
                                   IlluminationModel* model,
                                   std::vector<float>* parameters) {
  Objective objective(light, observed, options, prior_mean, model);
  return options.lbfgs ? Lbfgs(&objective, options, parameters)
                       : GaussNewton(&objective, options, parameters);
}

}  // namespace ibrdf
