// What all stages of a solve share and none changes.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/brdf/lobe_model.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/illumination/illumination_model.h"
#include "ibrdf/solvers/joint/joint_method.h"
#include "ibrdf/solvers/observation/observation.h"
#include "ibrdf/solvers/priors/ambient_prior.h"
#include "ibrdf/solvers/priors/material_prior.h"
#include "ibrdf/solvers/priors/prior_costs.h"
#include "ibrdf/solvers/problem/inverse_problem.h"

namespace ibrdf {

// Points that are transported at once where light bounces: the radiosity
// patches are lit anew by every transport.
inline constexpr size_t kPointsAtOnceWithBounces = 32768;

// Bins across the disc of normals for a map's estimate: at first, and where the
// image is as sharp as the map's texels.
inline constexpr int kMapBins = 64;
inline constexpr int kFineMapBins = 128;

struct SolveSetup {
  const InverseProblem* problem = nullptr;
  Observation pixels;  // all of the object
  // What a map's estimate is made from: the pixels binned by normal; with
  // shadows, which points of like normals do not share, some pixels as they
  // are. Empty where the light is known.
  Observation binned;
  double epsilon = 0.0;        // of the likelihood, radiance
  double initial_scale = 0.0;  // b of the likelihood at first, natural log

  // Reflectance, unknown; null and empty where it is known.
  std::unique_ptr<const LobeModel> lobes;
  LobePrior lobe_prior;     // Chen et al. 2020, Sec. 4.3
  MaterialPrior materials;  // what takes its place in all but their method

  // Illumination, known: its map [H, W, 3] less the few texels far brighter
  // than the rest, which `transport` samples by themselves.
  std::vector<float> known_map;
  TransportOptions transport;
  AmbientPrior ambient;  // stray light beside the known map's

  bool lobes_unknown() const { return lobes != nullptr; }
  // Given, not estimated before.
  bool reflectance_known() const {
    return !lobes_unknown() && problem->estimated_brdfs.empty();
  }
  bool light_unknown() const { return !problem->known_map.has_value(); }
  // Bins across the normals of each view, where one photograph has `of_one`.
  int MapBins(int of_one) const;
  // Both at once, as published (Chen et al. 2020, Eq. 8).
  bool joint_maximum() const;
  // BRDFs of the points, by material: the known or estimated ones, or those of
  // lobes [materials][lobes' parameters].
  std::vector<BrdfGrid> GridsOf(const std::vector<double>& parameters) const;
  MapSize map_size() const { return {problem->map_width, problem->map_height}; }
};

// The problem must outlive the setup. kInvalidInput where no pixel can be used.
StatusOr<SolveSetup> SetUp(const InverseProblem& problem);

// solver.method for these blocks; `auto`: Gauss-Newton for the light,
// alternating for both.
JointMethod MethodFor(const SolverSpec& solver, JointBlocks blocks);

// The unknown map as the problem asks for it: a network's output or free
// texels (prior: none).
std::unique_ptr<IlluminationModel> MakeIllumination(
    const InverseProblem& problem);

// kInvalidInput where solver.method refuses a light of this size on the binned
// pixels. Call it before time is spent.
Status CheckMethod(const SolveSetup& setup);

// Pixels and the transport of light to them, which is built at first use for a
// map's size and kept while the size stays.
class ObservedPixels {
 public:
  // The setup must outlive this.
  ObservedPixels(const SolveSetup& setup, Observation observation);

  const std::vector<ShadingPoint>& points() const {
    return observation_.points;
  }
  const Observations& observed() const { return observation_.observed; }
  const Transport& TransportFrom(MapSize size);

 private:
  const TransportOptions* options_;
  Observation observation_;
  std::unique_ptr<const Transport> transport_;
};

}  // namespace ibrdf
