// What a solve is given: the image, the object's points and what is known.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/flow/neural_brdf_model.h"
#include "ibrdf/image/image.h"
#include "ibrdf/image/radiance_bounds.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/light/map_frame.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/effects/effects_plan.h"
#include "ibrdf/solvers/problem/dark_pixels.h"
#include "ibrdf/solvers/problem/load_labels.h"
#include "ibrdf/solvers/problem/load_object.h"
#include "ibrdf/solvers/problem/unknown_curve.h"
#include "ibrdf/solvers/problem/view_sheet.h"
#include "ibrdf/transport/transport.h"

namespace ibrdf {

// A trained model and the name that problem files give it.
struct NamedModel {
  std::string name;
  std::shared_ptr<const NeuralBrdfModel> model;
};

// The same view as the image's, under another light.
struct OtherPhotograph {
  std::string file;
  Image image;
  std::optional<RadianceBounds> bounds;  // as InverseProblem has them
};

struct InverseProblem {
  ProblemKind kind = ProblemKind::kJoint;
  Image image;  // observed radiance; of several views, the sheet's
  ViewSheet sheet;
  // Where the file bounds radiance alone, as whole numbers do: the ends. An
  // image's value is then in its interval, or its one end.
  std::optional<RadianceBounds> bounds;
  // Painted objects under unknown light may have them (SolvePainted). Copies of
  // the problem share them.
  std::vector<std::shared_ptr<const OtherPhotograph>> other_photographs;
  // Codes of a curve that is to be found; image and bounds are then of a first
  // guess.
  std::optional<UnknownCurve> unknown_curve;
  std::vector<ShadingPoint> points;  // of the object's pixels, at most one each
  // What makes the inputs doubtful or was taken for granted: sentences that
  // name the file.
  std::vector<std::string> warnings;
  // The look before, which copies share; null where nobody looked.
  std::shared_ptr<const ObjectLook> look;

  // Unknown reflectance: the trained model, which copies of the problem share;
  // known: null, and its grid.
  std::shared_ptr<const NeuralBrdfModel> model;
  std::string model_name = "default";
  // Further models of one unknown material: where the light is unknown they are
  // searched as well (SolveJoint), else where the first leaves more than noise
  // (EstimateUnderKnownLight).
  std::vector<NamedModel> other_models;
  int lobes = 2;
  double prior_sigma = 0.5;
  // kAuto: as the solve finds (IsProbablyPainted).
  ReflectanceVariation variation = ReflectanceVariation::kNone;
  std::optional<BrdfGrid> known_brdf;
  // The labels of the points' materials; empty: they are not labelled, or, with
  // kLabels, to be found (FindLabels).
  std::vector<MaterialLabel> materials;
  // Beside known_brdf, which is then not read: the estimated reflectance of
  // each material, while the light is sought. Empty: there is none.
  std::vector<BrdfGrid> estimated_brdfs;

  // Size of the map; known: its radiance at that size.
  int map_width = 128, map_height = 64;
  IlluminationPrior illumination_prior = IlluminationPrior::kProcess;
  int unet_channels = 32;
  std::optional<Image> known_map;
  // The known map as fine as its file, to 1024 columns, in the file's units:
  // what a mirror shows. Null: known_map is.
  std::shared_ptr<const Image> fine_known_map;
  MapFrame known_map_frame = MapFrame::kCamera;  // that its file was read in
  // Pixels that a known map does not light, where the reflectance is unknown.
  DarkPixels dark;

  std::optional<double> scale, epsilon;  // of the likelihood
  SolverSpec solver;
  // Shares of solver.seconds: what went before the call, and what is to be left
  // for what follows it, as a program reads files before and writes them after.
  double seconds_spent = 0.0, seconds_reserved = 0.0;
  uint64_t seed = 1;
  int num_threads = 0;
  // The light transport, at the level solver.quadrature; with the visibility of
  // `points` where `effects` has it.
  TransportOptions transport;
  EffectsPlan effects;
};

}  // namespace ibrdf
