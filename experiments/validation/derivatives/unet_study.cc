// Log radiance by the UNet's weights: both products of the Jacobian.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "experiments/validation/derivatives/studies.h"
#include "ibrdf/light/illumination_unet.h"
#include "ibrdf/light/illumination_unet_reference.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace derivatives {
namespace {

class UnetStudy {
 public:
  UnetStudy(std::string name, const IlluminationUnetOptions& options,
            ErrorTable* table)
      : name_(std::move(name)),
        unet_(options),
        reference_(unet_.plan(), {unet_.noise().begin(), unet_.noise().end()}),
        table_(table) {}

  const IlluminationUnet& unet() const { return unet_; }

  void Add(const std::string& kind, const std::string& where,
           const std::vector<float>& weights, const std::vector<float>& adjoint,
           const std::vector<float>& tangent) {
    std::vector<float> out(unet_.num_outputs()), d_out(out.size()),
        by_weight(weights.size());
    IlluminationUnet::Workspace workspace;
    IlluminationUnet::Scratch scratch;
    unet_.Forward(weights.data(), &workspace, out.data());
    unet_.Vjp(adjoint.data(), workspace, &scratch, by_weight.data());
    unet_.Jvp(tangent.data(), workspace, &scratch, d_out.data());
    const std::vector<Real> w(weights.begin(), weights.end());
    const std::vector<Real> a(adjoint.begin(), adjoint.end());
    const std::vector<Real> t(tangent.begin(), tangent.end());
    const UnetReferencePass<Real> pass = reference_.Forward(w);
    table_->Add(name_ + ": gradient by weights", kind, where,
                ToDoubles(by_weight), reference_.Vjp(w, a, pass));
    const std::vector<Real> jvp = reference_.Jvp(w, t, pass);
    table_->Add(name_ + ": output along a direction", kind, where,
                ToDoubles(d_out), jvp);
    AddDifference(kind, where, w, t, jvp);
  }

 private:
  // The reference's product against its own central difference: truncation and
  // rounding of some 1e-10.
  void AddDifference(const std::string& kind, const std::string& where,
                     const std::vector<Real>& w, const std::vector<Real>& t,
                     const std::vector<Real>& jvp) {
    constexpr Real kStep = 1e-6L;
    std::vector<Real> up = w, down = w;
    for (size_t i = 0; i < w.size(); ++i) {
      up[i] += kStep * t[i];
      down[i] -= kStep * t[i];
    }
    const std::vector<Real> high = reference_.Forward(up).log_radiance();
    const std::vector<Real> low = reference_.Forward(down).log_radiance();
    std::vector<double> difference;
    for (size_t i = 0; i < high.size(); ++i) {
      difference.push_back(
          static_cast<double>((high[i] - low[i]) / (2 * kStep)));
    }
    table_->Add(name_ + ": the reference by differences", kind, where,
                difference, jvp);
  }

  std::string name_;
  IlluminationUnet unet_;
  UnetReference<Real> reference_;
  ErrorTable* table_;
};

void AddNetwork(const std::string& name, const IlluminationUnetOptions& options,
                int count, std::mt19937_64* rng, ErrorTable* table) {
  UnetStudy study(name, options, table);
  const IlluminationUnet& unet = study.unet();
  const std::vector<float> start = unet.InitialWeights(3),
                           std = unet.PriorStd();
  const size_t n = start.size(), m = unet.num_outputs();
  std::normal_distribution<float> normal;
  const auto random = [&](size_t size) {
    std::vector<float> v(size);
    for (float& x : v) x = normal(*rng);
    return v;
  };
  // A draw from the prior, all of it times `scale`.
  const auto draw = [&](float scale) {
    std::vector<float> w = random(n);
    for (size_t i = 0; i < n; ++i) w[i] *= scale * std[i];
    return w;
  };
  for (int i = 0; i < count; ++i) {
    const std::string where = "draw " + std::to_string(i);
    study.Add("drawn from the prior", where, draw(1.0f), random(m), random(n));
    std::vector<float> texel(m, 0.0f);
    texel[(*rng)() % m] = 1.0f;
    study.Add("one texel", where, draw(1.0f), texel, random(n));
    texel = random(m);
    texel[(*rng)() % m] = 1e6f;
    study.Add("one texel of 1e6 among others", where, draw(1.0f), texel,
              random(n));
  }
  study.Add("the start, a constant map", "", start, random(m), random(n));
  study.Add("all weights 0", "", std::vector<float>(n, 0.0f), random(m),
            random(n));
  for (const float scale : {1e-3f, 30.0f}) {
    study.Add("weights x " + Coordinates({scale}), "", draw(scale), random(m),
              random(n));
  }
}

}  // namespace

void StudyUnet(const StudyOptions& options, ErrorTable* table) {
  std::mt19937_64 rng(options.seed);
  IlluminationUnetOptions network = testing::TinyUnetOptions();
  network.channels = 8;
  network.skip_channels = 3;
  network.noise_channels = 3;
  const int count = std::max(options.points / 20, 3);
  AddNetwork("UNet", network, count, &rng, table);
  network.normalize = false;
  AddNetwork("UNet without normalisation", network, count, &rng, table);
}

}  // namespace derivatives
}  // namespace ibrdf
