// What a solve returns: the estimate, how it was found and how far to trust it.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/image/image.h"
#include "ibrdf/image/response_curve.h"
#include "ibrdf/solvers/estimation/brdf_slice.h"
#include "ibrdf/solvers/estimation/material_ranking.h"
#include "ibrdf/solvers/priors/determined_directions.h"
#include "ibrdf/solvers/priors/light_process.h"
#include "ibrdf/solvers/problem/inverse_problem.h"

namespace ibrdf {

// One line of the trace: the best state after a step. Costs of lines with
// another scale or another number of pixels do not compare; misfits do.
struct TraceEntry {
  std::string stage;
  double seconds = 0.0;     // with those spent before
  double scale = 0.0;       // b of the likelihood then
  int64_t pixels = 0;       // that took part; a bin counts as one
  double cost = 0.0;        // likelihood + priors, nats
  double likelihood = 0.0;  // sum |log L_o - log I| / b, smoothed
  double reflectance_prior = 0.0;
  double illumination_prior = 0.0;
  double misfit = 0.0;  // mean |log L_o - log I|
};

// A reflectance that explains the image too: where it began, and how far it
// lies from the estimate.
struct Alternative {
  std::string start;  // training material
  double cost = 0.0;  // -log posterior, nats, above the best one's
  // From the estimate, which may be a mean of optima or a later one, and from
  // the best optimum, as ibrdf_eval's aligned log-RMSE.
  double brdf_log_difference = 0.0;
  std::vector<double> lobe_parameters = {};  // as LobeModel
  double difference_from_best = 0.0;
};

// A response curve that explains the image's codes.
struct CurveEstimate {
  ResponseDefinition curve;
  // Posterior deviation of the parameter's log; NaN where it has none or it was
  // not found.
  double log_parameter_std = std::numeric_limits<double>::quiet_NaN();
  double cost = 0.0;  // -log evidence, nats, above the best one's
};

// A known map in another frame: mirrored left to right or not, and then turned
// about the up axis.
struct MapTurn {
  bool mirrored = false;
  double degrees = 0.0;  // [0, 360); what was at +z is at +x after 90
  double misfit = 0.0;   // that it leaves; of what, its finder says
};

// What a solution says of another photograph (OtherPhotograph).
struct OtherLight {
  Image map, render;  // as Solution has them
  double misfit = 0.0;
};

// Labels that nobody gave (FindLabels), and by how many nats the image is more
// probable of them than of one material fewer; 0: one material. gain_of_more:
// what the best labels of one material more gain; NaN: there were none.
struct FoundLabels {
  std::vector<int> labels;  // of the problem's points; empty: none were sought
  double gain = 0.0;
  double gain_of_more = std::numeric_limits<double>::quiet_NaN();
  bool cut_short = false;  // time or the user ended it
};

// What a solution says of a material's reflectance.
struct MaterialSolution {
  std::vector<double> lobe_parameters;  // as LobeModel; empty if known
  // Posterior covariance of those (Laplace, light integrated out), row-major;
  // empty where it was not found.
  std::vector<double> lobe_covariance;
  // The spread of that posterior, see reflectance_spread.h; NaN where it was
  // not found.
  double spread = std::numeric_limits<double>::quiet_NaN();
  // One material: misfit * sqrt(correlation of neighbouring pixels'
  // residuals), the part of the misfit that is no noise; under a known light of
  // the first model searched. NaN elsewhere.
  double structured_misfit = std::numeric_limits<double>::quiet_NaN();
  // Joint problems: other optima, with labels of all materials at once.
  std::vector<Alternative> alternatives;
  // Slices of the BRDF with the posterior's band; empty without covariance.
  std::vector<BrdfSlice> slices;
  MaterialRanking ranking;  // joint problems of one material; else empty
  // Set with lobe_covariance, of one material.
  std::optional<DeterminedDirections> determined;
  MerlTable brdf;     // empty if known
  std::string start;  // in words: the reflectance that the best began with
};

// Its own material is the object's or, where materials are labelled, that of
// most pixels.
struct Solution : MaterialSolution {
  MaterialSolution& reflectance() { return *this; }
  const MaterialSolution& reflectance() const { return *this; }
  // One material: the models searched, the one that the lobes are of first, and
  // their shares of the evidence, sum 1. Else empty: the problem's model.
  std::vector<NamedModel> models;
  std::vector<double> model_weights;
  // One material under a known light that leaves a large misfit: the share of
  // it that mirrored light explains, in [0, 1]. Else 0.
  double mirrored_share = 0.0;
  // Under a known map that another frame would suit far better: that frame, and
  // the misfit of the map as it is given.
  std::optional<MapTurn> better_map_turn;
  double misfit_of_given_map = 0.0;
  // Whether the misfits of these two are of like paint (FindPaintTurns), not of
  // simple materials (FindMapTurns).
  bool map_turn_of_paint = false;
  // Where the curve was unknown: the best of each family, the best first.
  std::vector<CurveEstimate> curves;
  FoundLabels found_labels;
  // Labelled materials, by ShadingPoint::material. Empty: no labels.
  std::vector<MaterialSolution> materials;
  // What the search found of the light's prior, and its directional lights,
  // unit; where there was none, as it begins.
  LightHyperparameters light_hyperparameters = LightHyperparameters::Average();
  std::vector<Eigen::Vector3d> directional_lights;
  // Standard deviation of log radiance given the reflectance, at the
  // resolution of the search; empty where there was none or its end was not
  // kept.
  Image map_std;
  // The share of the prior's variance of it that is left, in [0, 1], likewise.
  Image map_variance_left;
  // The same of its harmonics of degree l = 0, 1, ...
  std::vector<double> map_variance_left_by_degree;
  Image map;     // [H, W]; the known one if known
  Image render;  // radiance at the object's pixels, else 0
  // Where the albedo varies, has_paint(): that of what is matte, at the
  // object's pixels, else 0; the radiance that is gloss; and the standard
  // deviation of the log albedo's luminance, in three equal channels, its scale
  // left out (AlbedoLogStd). Else empty.
  Image albedo, gloss, albedo_log_std;
  // The lights of the problem's other photographs; empty where they took no
  // part.
  std::vector<OtherLight> other_lights;
  bool has_paint() const { return !albedo.empty(); }
  // Stray light beside the known map's, in `render` too; 0: none.
  Eigen::Array3d ambient = Eigen::Array3d::Zero();
  double scale = 0.0;  // b used at the end
  double epsilon = 0.0;
  double misfit = 0.0;
  // The costs of the start and of this estimate, both with `scale` on all
  // pixels: end_cost <= start_cost.
  double start_cost = 0.0, end_cost = 0.0;
  double seconds = 0.0;  // with those spent before
  int64_t pixels_used = 0;
  std::vector<TraceEntry> trace;
  // kOk; kNoImprovement or kInterrupted: this is the best iterate found.
  Status status;
};

}  // namespace ibrdf
