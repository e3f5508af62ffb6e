// Lobes: fields by code, radiance by codes and colours, residuals by both.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "experiments/validation/derivatives/reference_flows.h"
#include "experiments/validation/derivatives/reference_scene.h"
#include "experiments/validation/derivatives/studies.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/brdf/merl_columns.h"
#include "ibrdf/solvers/costs/log_radiance_cost.h"
#include "tests/support/render_testing.h"
#include "tests/support/tiny_model.h"

namespace ibrdf {
namespace derivatives {
namespace {

constexpr Real kLeastShape = 1e-30L;

// Codes and colours of lobes, each lobe that of a random training material
// moved by `away`, or of another length where `norm` is not negative.
std::vector<double> RandomLobes(const NeuralBrdfModel& model, double away,
                                double norm, std::mt19937_64* rng) {
  std::normal_distribution<double> normal;
  const int size = model.shape.code_size();
  std::vector<double> out;
  for (int k = 0; k < 2; ++k) {
    const size_t m = (*rng)() % model.num_codes();
    double square = 0.0;
    for (int d = 0; d < size; ++d) {
      out.push_back(model.codes[m * size + d] + away * normal(*rng));
      square += out.back() * out.back();
    }
    for (int d = 0; d < size && norm >= 0.0; ++d) {
      out[out.size() - size + d] *= norm / std::sqrt(square);
    }
    for (int c = 0; c < 3; ++c) {
      out.push_back(model.log_colours[m] + 0.3 * normal(*rng));
    }
  }
  return out;
}

class LobeStudy {
 public:
  LobeStudy(std::string name, const NeuralBrdfModel& model, ErrorTable* table)
      : name_(std::move(name)),
        model_(model),
        scene_(testing::SpherePoints(4), testing::SmoothMap(8, 16)),
        lobes_(model, 2, scene_.options().grid, 0),
        table_(table) {}

  void Add(const std::string& kind, const std::vector<double>& p) {
    const std::string where = "code " + Coordinates(p, 4) + ", log colours " +
                              Coordinates({p.end() - 3, p.end()});
    if (codes_ != p) {
      fields_ = ReferenceFields(model_, 2, lobes_.grid_shape(), p);
      codes_ = p;
    }
    AddFields(kind, where, p, fields_);
    AddRadiance(kind, where, p, fields_);
  }
  // The lobes of the last Add with all log colours at `colour`.
  void AddColours(double colour) {
    const size_t size = codes_.size() / 2;
    for (size_t k = 1; k <= 2; ++k) {
      for (size_t c = 1; c <= 3; ++c) codes_[k * size - c] = colour;
    }
    AddRadiance("log colours " + Coordinates({colour}),
                "code " + Coordinates(codes_, 4), codes_, fields_);
  }

 private:
  // A node's gradient by the code; and a whole field, which its peak rules.
  void AddFields(const std::string& kind, const std::string& where,
                 const std::vector<double>& p, const std::vector<Real>& exact) {
    const size_t n = lobes_.grid_shape().num_nodes();
    const size_t codes = lobes_.code_size();
    std::vector<float> fields;
    lobes_.Tabulate(p.data(), true, &fields);
    for (size_t k = 0; k < 2; ++k) {
      const size_t begin = k * (1 + codes) * n;
      for (size_t i = 0; i < n; i += 7) {
        std::vector<double> found;
        std::vector<Real> right;
        for (size_t d = 1; d <= codes; ++d) {
          found.push_back(fields[begin + d * n + i]);
          right.push_back(exact[begin + d * n + i]);
        }
        // What underflows has no digits.
        if (exact[begin + i] < kLeastShape) continue;
        const Eigen::Vector3d x =
            WithinMerlBins(lobes_.grid_shape().NodePoint(static_cast<int>(i)));
        table_->Add(name_ + ": lobe field by code, a node", kind,
                    where + ", x " + Coordinates({x[0], x[1], x[2]}), found,
                    right);
      }
      for (size_t d = 1; d <= codes; ++d) {
        const auto at = static_cast<std::ptrdiff_t>(begin + d * n);
        const auto size = static_cast<std::ptrdiff_t>(n);
        table_->Add(name_ + ": lobe field by code, all nodes", kind,
                    where + ", entry " + std::to_string(d - 1),
                    {fields.begin() + at, fields.begin() + at + size},
                    {exact.begin() + at, exact.begin() + at + size});
      }
    }
  }

  void AddRadiance(const std::string& kind, const std::string& where,
                   const std::vector<double>& p,
                   const std::vector<Real>& fields) {
    const std::vector<float>& map = scene_.map().rgb;
    const std::vector<Real> light(map.begin(), map.end());
    const LobeRadiance exact =
        scene_.Radiance(fields, lobes_.code_size(), p, light);
    std::vector<double> L_o, dL_o;
    const bool finite = RenderLobeModel(scene_.transport(), lobes_, p.data(),
                                        map.data(), &L_o, &dL_o);
    std::vector<double> bright(L_o.size());
    for (size_t i = 0; i < L_o.size(); ++i) {
      // An observation at a random factor, the same for all kinds.
      bright[i] = static_cast<double>(exact.L_o[i]) *
                  std::exp(std::cos(7.0 * static_cast<double>(i)));
    }
    const Observations observed = MakeObservations(bright);
    RobustLogLikelihood likelihood;
    likelihood.epsilon = 1e-3 * bright[0];
    const LobeRadianceCost cost(&scene_.transport(), &lobes_, map, &observed,
                                likelihood);
    std::vector<double> residuals(L_o.size()), jacobian(dL_o.size());
    const double* block[] = {p.data()};
    double* jacobians[] = {jacobian.data()};
    const bool ok = cost.Evaluate(block, residuals.data(), jacobians);
    const size_t columns = p.size();
    for (size_t i = 0; i < L_o.size(); ++i) {
      const auto at = static_cast<std::ptrdiff_t>(i * columns);
      const auto size = static_cast<std::ptrdiff_t>(columns);
      std::vector<Real> right(exact.dL_o.begin() + at,
                              exact.dL_o.begin() + at + size);
      const double nan = std::nan("");
      std::vector<double> found(columns, nan);
      if (finite) std::copy_n(dL_o.begin() + at, columns, found.begin());
      table_->Add(name_ + ": radiance by lobes", kind,
                  where + ", value " + std::to_string(i), found, right);
      if (!observed.valid[i / 3]) continue;
      const Real slope =
          ResidualSlope(exact.L_o[i], observed.radiance[i], likelihood);
      for (Real& v : right) v *= slope;
      std::fill(found.begin(), found.end(), nan);
      if (ok) std::copy_n(jacobian.begin() + at, columns, found.begin());
      table_->Add(name_ + ": residual by lobes", kind,
                  where + ", value " + std::to_string(i), found, right);
    }
  }

  std::string name_;
  const NeuralBrdfModel& model_;
  ReferenceScene scene_;
  FlowLobes lobes_;
  ErrorTable* table_;
  std::vector<double> codes_;  // of fields_
  std::vector<Real> fields_;
};

}  // namespace

void StudyLobes(const NeuralBrdfModel& model, const StudyOptions& options,
                ErrorTable* table) {
  std::mt19937_64 rng(options.seed);
  const int count = std::max(options.points / 10, 3);
  LobeStudy trained("default model", model, table);
  for (int i = 0; i < count; ++i) {
    trained.Add("random", RandomLobes(model, 0.1, -1.0, &rng));
  }
  const int few = std::max(count / 4, 2);
  for (int i = 0; i < few; ++i) {
    trained.Add("codes 0", RandomLobes(model, 0.0, 0.0, &rng));
    trained.Add("codes of norm 1", RandomLobes(model, 0.1, 1.0, &rng));
    trained.Add("codes of norm 3", RandomLobes(model, 0.1, 3.0, &rng));
    std::vector<double> p = RandomLobes(model, 0.1, -1.0, &rng);
    std::copy_n(p.begin(), p.size() / 2, p.begin() + p.size() / 2);
    trained.Add("lobes that coincide", p);
    for (const double colour : {-60.0, 39.999, 60.0}) {
      trained.AddColours(colour);
    }
  }
  const NeuralBrdfModel steep = TinyModel(2, 1, 400.0f);
  NeuralBrdfModel cubed = TinyModel(2, 1, 4.0f);
  cubed.exponent = 3.0;
  LobeStudy hard("steep", steep, table);
  LobeStudy power("exponent 3", cubed, table);
  for (int i = 0; i < few; ++i) {
    hard.Add("random", RandomLobes(steep, 0.1, -1.0, &rng));
    power.Add("random", RandomLobes(cubed, 0.1, -1.0, &rng));
  }
}

}  // namespace derivatives
}  // namespace ibrdf
