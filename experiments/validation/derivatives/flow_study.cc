// Log density by code, by point and by weights, of both flows.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "experiments/validation/derivatives/reference_flows.h"
#include "experiments/validation/derivatives/studies.h"
#include "ibrdf/flow/brdf_flow.h"
#include "tests/support/tiny_model.h"

namespace ibrdf {
namespace derivatives {
namespace {

// At a knot a derivative jumps, and float may see the point on the other side
// of it. Then the derivatives of a neighbour this far off are right too.
constexpr Real kSide = 1e-6L;
// Errors above it are looked at from all sides.
constexpr Real kLookAround = 1e-5L;

struct Point {
  std::vector<float> code;
  float x[3];
};

std::vector<float> CodeOfNorm(int size, double norm, std::mt19937_64* rng) {
  std::normal_distribution<double> normal;
  std::vector<double> z(size);
  double square = 0.0;
  for (double& v : z) {
    v = normal(*rng);
    square += v * v;
  }
  std::vector<float> code;
  for (const double v : z) {
    code.push_back(static_cast<float>(norm * v / std::sqrt(square)));
  }
  return code;
}

Real Distance(const std::vector<double>& a, const std::vector<Real>& b) {
  Real sum = 0, norm = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    sum += (a[i] - b[i]) * (a[i] - b[i]);
    norm += b[i] * b[i];
  }
  return std::sqrt(sum / (norm > 0 ? norm : 1));
}

class FlowStudy {
 public:
  FlowStudy(std::string name, const NeuralBrdfModel& model, ErrorTable* table)
      : name_(std::move(name)),
        size_(model.shape.code_size()),
        flow_(BrdfFlow::Create(model.shape, model.weights)),
        reference_(model),
        table_(table) {}

  int code_size() const { return size_; }

  // Both ways of evaluation, against the nearest of the sides of a knot; points
  // on a knot against the right side too.
  void Add(const std::string& points, const Point& p) {
    const std::vector<Real> code(p.code.begin(), p.code.end());
    const Real x[3] = {p.x[0], p.x[1], p.x[2]};
    std::vector<FlowDerivatives> sides = {reference_.At(x, code)};
    std::vector<double> by_code(size_), by_point(3), on_columns(size_);
    Evaluate(p, &by_code, &by_point, &on_columns);
    const std::string where = "x " + Where({p.x[0], p.x[1], p.x[2]});
    const auto add = [&](const std::string& derivative,
                         const std::vector<double>& values, auto part) {
      const std::vector<Real> here = part(sides[0]);
      std::vector<Real> best = here;
      if (!(Distance(values, here) <= kLookAround)) {
        LookAround(x, code, &sides);
        for (const FlowDerivatives& side : sides) {
          if (Distance(values, part(side)) < Distance(values, best)) {
            best = part(side);
          }
        }
      }
      if (points == "on a knot") {
        table_->Add(name_ + derivative, points + ", right side", where, values,
                    here);
      }
      table_->Add(name_ + derivative, points, where, values, best);
    };
    const auto of_code = [](const FlowDerivatives& d) { return d.by_code; };
    const auto of_point = [](const FlowDerivatives& d) { return d.by_point; };
    add(": log density by code", by_code, of_code);
    add(": log density by code, on columns", on_columns, of_code);
    add(": log density by point", by_point, of_point);
  }

  // A knot of x_h's spline in the column of p, by bisection: slopes in x_h are
  // constant between knots.
  float KnotNear(const Point& p) const {
    const std::vector<Real> code(p.code.begin(), p.code.end());
    const auto slope = [&](Real x_h) {
      const Real x[3] = {x_h, p.x[1], p.x[2]};
      return reference_.At(x, code).by_point[0];
    };
    Real low = 0, high = 1;
    const Real first = slope(low);
    for (int i = 0; i < 60; ++i) {
      const Real middle = (low + high) / 2;
      const Real s = slope(middle);
      const bool same = std::abs(s - first) <= 1e-12L * std::abs(first);
      (same ? low : high) = middle;
    }
    return static_cast<float>(high);
  }

 private:
  static std::string Where(const std::vector<double>& x) {
    char text[96];
    std::snprintf(text, sizeof(text), "(%.9g, %.9g, %.9g)", x[0], x[1], x[2]);
    return text;
  }

  void Evaluate(const Point& p, std::vector<double>* by_code,
                std::vector<double>* by_point,
                std::vector<double>* on_columns) const {
    float value = 0.0f, dx[3];
    std::vector<float> dz(size_);
    flow_->LogDensity(p.x, 1, p.code.data(), 1, &value, dz.data(), dx);
    by_code->assign(dz.begin(), dz.end());
    by_point->assign(dx, dx + 3);
    FlowColumns column(1, 1);
    column.SetColumn(0, p.x[1], p.x[2]);
    column.x_h[0] = p.x[0];
    flow_->LogDensityOnColumns(column, p.code.data(), 1, &value, dz.data());
    on_columns->assign(dz.begin(), dz.end());
  }

  void LookAround(const Real* x, const std::vector<Real>& code,
                  std::vector<FlowDerivatives>* sides) const {
    if (sides->size() > 1) return;
    for (int i = 0; i < 3; ++i) {
      for (const Real step : {-kSide, kSide}) {
        Real y[3] = {x[0], x[1], x[2]};
        y[i] = std::clamp(y[i] + step, Real(0), Real(1));
        sides->push_back(reference_.At(y, code));
      }
    }
  }

  std::string name_;
  int size_;
  std::unique_ptr<BrdfFlow> flow_;
  ReferenceFlows reference_;
  ErrorTable* table_;
};

Point RandomPoint(std::vector<float> code, std::mt19937_64* rng) {
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  Point p;
  p.code = std::move(code);
  for (float& v : p.x) v = uniform(*rng);
  return p;
}

void AddExtremes(int count, std::mt19937_64* rng, FlowStudy* study) {
  const int size = study->code_size();
  for (int i = 0; i < count; ++i) {
    study->Add("code 0", RandomPoint(std::vector<float>(size, 0.0f), rng));
    study->Add("code of norm 1", RandomPoint(CodeOfNorm(size, 1.0, rng), rng));
    study->Add("code of norm 3", RandomPoint(CodeOfNorm(size, 3.0, rng), rng));
    Point p = RandomPoint(CodeOfNorm(size, 0.7, rng), rng);
    // Faces, edges and corners.
    for (int k = 0; k < 3; ++k) {
      const int kind = static_cast<int>((*rng)() % 3);
      if (kind < 2) p.x[k] = static_cast<float>(kind);
    }
    study->Add("faces of the cube", p);
    p = RandomPoint(p.code, rng);
    p.x[1] = 1.0f;  // grazing: theta_d = pi/2
    study->Add("theta_d = 90 degrees", p);
    p.x[2] = 0.5f;  // and the cusp of the horizon's bound
    study->Add("theta_d = phi_d = 90 degrees", p);
    p = RandomPoint(p.code, rng);
    p.x[0] = study->KnotNear(p);
    study->Add("on a knot", p);
  }
}

// By the weights, through the trainer's pass: sum over a group of points.
void AddWeights(const std::string& name, const NeuralBrdfModel& model,
                const std::string& points, unsigned seed, ErrorTable* table) {
  const auto flow = BrdfFlow::Create(model.shape, model.weights);
  constexpr int kPoints = 4;
  const int columns = flow->TrainingColumns();
  std::mt19937_64 rng(seed);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  std::normal_distribution<float> normal;
  FlowColumns x(columns, kPoints);
  for (int c = 0; c < columns; ++c) x.SetColumn(c, uniform(rng), uniform(rng));
  for (float& v : x.x_h) v = uniform(rng);
  const std::vector<float> code =
      CodeOfNorm(model.shape.code_size(), 0.7, &rng);
  std::vector<float> value(x.num_points()), adjoint(value.size()),
      by_code(code.size()), buffer(flow->GradientSize()),
      weights(model.weights.size());
  for (float& a : adjoint) a = normal(rng);
  const auto pass = flow->NewTrainingPass();
  pass->Forward(x, 1, code.data(), value.data());
  pass->Backward(adjoint.data(), buffer.data(), by_code.data());
  flow->AddGradient(buffer.data(), weights.data());

  std::vector<Real> expected(weights.size(), 0), code_expected(code.size(), 0);
  const std::vector<Real> z(code.begin(), code.end());
  const bool coupling = model.shape.architecture == FlowArchitecture::kCoupling;
  const int n = static_cast<int>(weights.size());
  std::vector<RealDual> w;
  for (int i = 0; i < n && !coupling; ++i) {
    w.emplace_back(Real(model.weights[i]), n, i);
  }
  for (int64_t i = 0; i < x.num_points(); ++i) {
    const int c = static_cast<int>(i % columns);
    const Real p[3] = {x.x_h[i], x.x_d[c], x.x_p[c]};
    std::vector<Real> dw;
    if (coupling) {
      const CouplingFlowReference<Real> reference(model.shape.coupling,
                                                  model.weights.data());
      reference.LogDensityWithGradient(p, z.data(), nullptr, nullptr, &dw);
    } else {
      const TriangularReference<RealDual> reference(model.shape.triangular,
                                                    w.data());
      const std::vector<RealDual> zd(z.begin(), z.end());
      const RealDual pd[3] = {p[0], p[1], p[2]};
      dw = reference.LogDensity(pd, zd.data()).derivatives;
    }
    for (int k = 0; k < n; ++k) expected[k] += adjoint[i] * dw[k];
  }
  table->Add(name + ": log density by weights", points,
             "seed " + std::to_string(seed), ToDoubles(weights), expected);
}

NeuralBrdfModel CouplingModel(float curvature, uint64_t seed) {
  NeuralBrdfModel model;
  model.shape.architecture = FlowArchitecture::kCoupling;
  CouplingShape& shape = model.shape.coupling;
  shape.code_size = 4;
  shape.widths = {16, 8};
  model.weights = InitialFlowWeights(model.shape, seed);
  // The last layers make the splines; the start's are nearly the identity.
  const DenseLayer last = shape.DenseLayers().back();
  for (int l = 0; l < shape.layers; ++l) {
    float* w = model.weights.data() + l * shape.WeightsPerLayer();
    for (int k = 0; k < last.in_count * last.out_count; ++k) {
      w[last.weight_offset + k] *= curvature;
    }
  }
  return model;
}

}  // namespace

void StudyFlows(const NeuralBrdfModel& model, const StudyOptions& options,
                ErrorTable* table) {
  std::mt19937_64 rng(options.seed);
  const int extremes = std::max(options.points / 10, 2);
  FlowStudy trained("default model", model, table);
  const size_t size = model.shape.code_size();
  for (int i = 0; i < options.points; ++i) {
    const size_t m = rng() % model.num_codes();
    trained.Add("random, materials' codes",
                RandomPoint({model.codes.begin() + m * size,
                             model.codes.begin() + (m + 1) * size},
                            &rng));
  }
  AddExtremes(extremes, &rng, &trained);

  for (const float curvature : {4.0f, 400.0f}) {
    const std::string kind = curvature < 10 ? "random weights" : "steep";
    FlowStudy tiny("triangular, " + kind, TinyModel(1, 1, curvature), table);
    FlowStudy stack("coupling, " + kind, CouplingModel(curvature, 1), table);
    for (FlowStudy* study : {&tiny, &stack}) {
      for (int i = 0; i < options.points; ++i) {
        study->Add("random", RandomPoint(CodeOfNorm(4, 0.7, &rng), &rng));
      }
    }
    if (curvature < 10) AddExtremes(extremes, &rng, &tiny);
    for (unsigned seed = 1; seed <= 8; ++seed) {
      AddWeights("triangular, " + kind, TinyModel(1, seed, curvature), "random",
                 seed, table);
      AddWeights("coupling, " + kind, CouplingModel(curvature, seed), "random",
                 seed, table);
    }
  }
}

}  // namespace derivatives
}  // namespace ibrdf
