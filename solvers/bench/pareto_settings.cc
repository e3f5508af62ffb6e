#include "ibrdf/solvers/bench/pareto_settings.h"

#include <tuple>

namespace ibrdf {
namespace {

// Chen et al. 2020: ten rounds of 300 steps of the light and 100 of the
// reflectance; a round of the solver is one such round. No budget of time or
// decrease of the cost ends it early.
constexpr int kAdamRounds = 10;
constexpr double kAdamSeconds = 1e5;

// Few enough unknowns for the trust region's dense Jacobian.
void MakeSmall(ParetoPoint* p) {
  p->size = 64;
  p->map_width = 32;
  p->prior = "none";
}

void SetNetwork(ParetoPoint* p, int channels) {
  p->prior = "unet";
  p->unet_channels = channels;
}

// The published estimator, whose map is a network's output.
void Publish(ParetoPoint* p) {
  p->estimator = "maximum";
  p->prior = "unet";
}

}  // namespace

bool ParetoPoint::operator==(const ParetoPoint& o) const {
  const auto tie = [](const ParetoPoint& p) {
    return std::tie(p.estimator, p.method, p.seconds, p.size, p.map_width,
                    p.lobes, p.prior, p.unet_channels, p.quadrature, p.search,
                    p.turns, p.models, p.tolerance, p.max_iterations);
  };
  return tie(*this) == tie(o);
}

const std::vector<ParetoSetting>& ParetoSettings() {
  using P = ParetoPoint;
  static const std::vector<ParetoSetting> settings = {
      {"default", [](P*) {}},
      // The map, once the reflectance is found.
      {"method-alternating", [](P* p) { p->method = "alternating"; }},
      {"method-gauss_newton", [](P* p) { p->method = "gauss_newton"; }},
      {"method-lbfgs", [](P* p) { p->method = "lbfgs"; }},
      {"method-adam", [](P* p) { p->method = "adam"; }},
      // Both unknowns at once.
      {"maximum", Publish},
      {"maximum-gauss_newton",
       [](P* p) {
         Publish(p);
         p->method = "gauss_newton";
       }},
      {"maximum-lbfgs",
       [](P* p) {
         Publish(p);
         p->method = "lbfgs";
       }},
      {"adam",
       [](P* p) {
         Publish(p);
         p->method = "adam";
         p->max_iterations = kAdamRounds;
         p->seconds = kAdamSeconds;
         p->tolerance = 0.0;
       }},
      {"seconds-5", [](P* p) { p->seconds = 5.0; }},
      {"seconds-10", [](P* p) { p->seconds = 10.0; }},
      {"seconds-20", [](P* p) { p->seconds = 20.0; }},
      {"seconds-40", [](P* p) { p->seconds = 40.0; }},
      {"seconds-60", [](P* p) { p->seconds = 60.0; }},
      {"seconds-120", [](P* p) { p->seconds = 120.0; }},
      {"size-64", [](P* p) { p->size = 64; }},
      {"size-128", [](P* p) { p->size = 128; }},
      {"size-256", [](P* p) { p->size = 256; }},
      {"map-64x32", [](P* p) { p->map_width = 64; }},
      {"lobes-1", [](P* p) { p->lobes = 1; }},
      {"lobes-2", [](P* p) { p->lobes = 2; }},
      {"lobes-3", [](P* p) { p->lobes = 3; }},
      {"models-1", [](P* p) { p->models = 1; }},
      {"search-standard", [](P* p) { p->search = "standard"; }},
      {"search-thorough", [](P* p) { p->search = "thorough"; }},
      {"turns-0", [](P* p) { p->turns = 0; }},
      {"turns-4", [](P* p) { p->turns = 4; }},
      {"unet-8", [](P* p) { SetNetwork(p, 8); }},
      {"unet-64", [](P* p) { SetNetwork(p, 64); }},
      {"quadrature-coarse", [](P* p) { p->quadrature = "coarse"; }},
      {"quadrature-fine", [](P* p) { p->quadrature = "fine"; }},
      {"prior-unet", [](P* p) { p->prior = "unet"; }},
      {"prior-none", [](P* p) { p->prior = "none"; }},
      {"small", MakeSmall},
      {"small-trust_region",
       [](P* p) {
         MakeSmall(p);
         p->method = "trust_region";
       }},
  };
  return settings;
}

}  // namespace ibrdf
