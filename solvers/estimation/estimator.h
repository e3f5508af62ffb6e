// One run of SolveInverseRendering: what its stages share, a file per subject.
// Internal.
#pragma once
#include <Eigen/Core>
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ibrdf/base/stopwatch.h"
#include "ibrdf/brdf/lobe_model.h"
#include "ibrdf/light/log_map.h"
#include "ibrdf/solvers/estimation/inverse_rendering.h"
#include "ibrdf/solvers/estimation/reflectance_spread.h"
#include "ibrdf/solvers/illumination/illumination_model.h"
#include "ibrdf/solvers/joint/joint_method.h"
#include "ibrdf/solvers/joint/joint_objective.h"
#include "ibrdf/solvers/marginal/reflectance_search.h"
#include "ibrdf/solvers/observation/observation.h"
#include "ibrdf/solvers/priors/light_process.h"
#include "ibrdf/solvers/priors/material_prior.h"

namespace ibrdf {

// To be run once. What it is given must outlive it; `stop` may be null.
class Estimator {
 public:
  Estimator(const InverseProblem& problem, const SolveProgress& progress,
            const std::atomic<bool>* stop);

  StatusOr<Solution> Run();

 private:
  // Across the disc of normals: what a map's estimate is made from, at first
  // and where the image is as sharp as the map's texels.
  static constexpr int kMapBins = 64;
  static constexpr int kFineMapBins = 128;
  // Transported at once with bounces: patches are lit anew by every transport.
  static constexpr size_t kPointsAtOnceWithBounces = 32768;

  // estimator.cc: clock, objective and trace.
  double Elapsed() const;
  double Budget() const { return problem_.solver.seconds; }
  bool Interrupted() const { return stop_ != nullptr && stop_->load(); }
  bool lobes_unknown() const { return !problem_.known_brdf.has_value(); }
  bool light_unknown() const { return !problem_.known_map.has_value(); }
  bool joint_maximum() const {
    return lobes_unknown() && light_unknown() &&
           problem_.solver.estimator == SolverEstimator::kMaximum;
  }
  // Of the time left from now on but for what Finish takes.
  std::function<bool()> StopAfter(double share) const;
  // kInvalidInput if no pixel can be used.
  Status Prepare();
  // Whether solver.method takes a problem of this size, before time is spent.
  Status CheckMethod() const;
  // Sets finish_seconds_.
  void PredictFinish();
  // Built at first use, for the present map's size.
  const Transport& TransportOf(Level* level);
  // The objective on a level, at the current scale and light mean. It must not
  // outlive the next change of either.
  struct LevelObjective {
    std::unique_ptr<LightOperator> known_brdf;
    std::unique_ptr<JointObjective> objective;
  };
  LevelObjective ObjectiveOn(Level* level);
  // The reflectance's prior is the materials', as in the searches; where the
  // light is unknown, at the level that suits it best, as the gauge and not the
  // prior says where the level is. The joint maximum's objective has the
  // paper's.
  double ReflectancePrior(const JointState& state) const;
  TraceEntry Entry(const std::string& stage, const Level& level,
                   const JointState& state, const JointCost& cost) const;
  TraceEntry Evaluate(const std::string& stage, Level* level,
                      const JointState& state);
  void Report(const TraceEntry& entry);
  void Report(const std::string& stage, Level* level, const JointState& state);

  // estimate_reflectance.cc
  // That spends at most a share of the time left.
  ReflectanceSearchOptions SearchOptions(double share);
  // The image's, [points * 3]; 0, which a search leaves out, where it is far
  // below any measurement.
  std::vector<double> SearchRadiance() const;
  // What a search says of the light, whose log radiance is to fall by `level`.
  void KeepLight(const ReflectanceSearchResult& found, double level);
  // DirectionalLights and scales of the light of highest posterior probability
  // with its map integrated out, under the known reflectance; left at the
  // average where the image does not tell.
  void SearchLight();
  // The reflectance whose posterior is highest with the light integrated out;
  // kNoImprovement where the light explains the image of no material.
  Status SearchMarginal(JointState* state);
  // The first of the spread materials.
  void StartAtMeanMaterial(JointState* state);
  // The materials under the known light, the best few refined and the best of
  // those finished.
  JointState EstimateUnderKnownLight();
  // A state under the known light and what few_ looks like in it.
  struct Candidate {
    std::string name;
    JointState state;
    JointCost priors;
    std::vector<double> radiance;  // [points of few_ * 3]
    double cost = 0.0;             // when candidates were last compared
    double scale = 0.0;            // of the likelihood
    bool settled = false;
  };
  Candidate CandidateOf(const std::string& name, JointState state);
  // Of a candidate, at the present scale; renders nothing.
  TraceEntry Entry(const std::string& stage, const Candidate& candidate) const;
  // Rounds of all in turn, after each of which the worst is given up.
  JointState BestOf(std::vector<Candidate> candidates);
  // The best so many, at least one, best first: compared at one scale, the
  // least of theirs, which is the likelihood's then.
  void KeepBest(size_t count, std::vector<Candidate>* candidates);
  // Steps at a scale that may fall, unless they do not lower the cost.
  void KnownLightRound(Candidate* candidate);
  // Steps of the lobes under the known light, on few_: at most so many, from
  // a trust region of so large a radius.
  void LobeSteps(int max_steps, double radius, JointState* state) const;

  // estimate_light.cc
  std::unique_ptr<IlluminationModel> MakeLight() const;
  // process_prior: it is no part of the model itself.
  void SetLight(std::unique_ptr<IlluminationModel> light, bool process_prior);
  // Log radiance by channel of the constant map that has the image's level
  // under these lobes (any, where they are known).
  Eigen::Array3d MatchedLevel(const std::vector<double>& lobes);
  // A constant map at that level; the light's priors are centred there.
  void MatchLight(JointState* state);
  // The mean material under such a map, which is what there is to say of an
  // image that no search explains.
  void StartWithoutSearch(JointState* state);
  // The same at the level that MatchLight found, for the present model.
  void StartAtLevel(JointState* state);
  // Priors of the light centred at a constant map.
  struct LightPriors {
    std::vector<float> mean;  // of the light's parameters
    std::vector<std::unique_ptr<LightPrior>> on_map;
  };
  LightPriors PriorsAt(const Eigen::Array3d& level) const;
  // Reflectance and map at once, from the mean material.
  Status EstimateBoth(JointState* state);
  // What the end is held against: the first lobes under a constant map at
  // their own level.
  void StartFirstLight();
  // The map given the reflectance, by the prior that the problem asks for.
  Status EstimateLight(JointState* state);
  // As a draw of the light's process, whose parameters are as good as whitened
  // and take a tenth of the time of a network's.
  Status EstimateDraw(MapSize size, JointMethod method, double share,
                      JointState* state);
  // The map on joined pixels, and on those of a finer joining where that tells
  // more.
  Status MapRounds(JointMethod method, double share, JointState* state);
  // Whether the map at hand makes light that joined pixels cannot show.
  bool BinsBlur(const JointState& state);
  // As the network's output, from its fit to the draw at hand, which is kept
  // where the network does not explain the image as well.
  Status EstimateNetwork(JointState* state);

  // rounds.cc: steps at a falling scale.
  // Moves scale between the two unknowns; the image stays as it is.
  void FixGauge(JointState* state);
  JointMethod MethodFor(JointBlocks blocks) const;
  // Lowers the objective over the blocks, some steps at a scale, until a share
  // of the time is spent or a round gains less than the tolerance. most_misfit
  // > 0: of no use above it, and given up once it is out of reach.
  Status Rounds(const std::string& stage, JointMethod method,
                JointBlocks blocks, double share, JointState* state,
                double most_misfit = 0.0);
  // Whether rounds as quick and as good as the last would not come to a misfit
  // in the time that is left; later ones rarely gain more.
  bool OutOfReach(double misfit, const TraceEntry& before,
                  const TraceEntry& after) const;
  // Whether another round is not worth its time.
  bool RoundsSettled(const TraceEntry& before, const TraceEntry& after) const;
  // The Laplacian's maximum-likelihood scale is the mean magnitude of the
  // residuals. It only falls, and not at once: with a small scale too early the
  // robust loss holds on to wrong pixels.
  double ScaleFor(double misfit) const;
  void UpdateScale(double misfit);

  // finish.cc
  // What a state looks like, under the present priors.
  struct View {
    JointCost cost;
    BrdfGrid grid;
    std::vector<float> map;        // [H, W, 3]
    std::vector<double> radiance;  // [points of full_ * 3]
  };
  // All but the likelihood of every pixel, and its radiance.
  View ViewOf(const JointState& state);
  // These, slice by slice.
  void RenderPixels(const std::vector<View*>& views);
  // Evaluates the end at every pixel, against the start.
  StatusOr<Solution> Finish(JointState best);
  // Of the posterior around a state; NaN where none was found.
  double SpreadOf(const LobeDistance& distance, const JointState& state) const;
  void AddAlternatives(const LobeDistance& distance, const JointState& best,
                       Solution* estimate) const;

  const InverseProblem& problem_;
  const SolveProgress& progress_;
  const std::atomic<bool>* stop_;
  const Stopwatch clock_;
  RobustLogLikelihood likelihood_;
  // Every pixel; pixels of like normals joined, for the light; some pixels, for
  // the reflectance under known light.
  std::unique_ptr<Level> full_, cells_, few_;
  std::optional<ReflectanceOperator> few_light_;  // of few_ and the known map
  std::unique_ptr<LobeModel> lobes_;              // null: known
  LobePrior lobe_prior_;
  MaterialPrior materials_;
  std::unique_ptr<IlluminationModel> light_;  // null: known
  bool has_process_prior_ = false;
  Eigen::Array3d level_ = Eigen::Array3d::Zero();  // of MatchLight
  // Centred at the image's level, whatever its unit; those of first_.
  LightPriors light_priors_, first_priors_;
  LightHyperparameters light_hyperparameters_ = LightHyperparameters::Average();
  std::vector<Eigen::Vector3d> directional_lights_;  // that the search found
  // A known map, less the texels that are sampled by themselves, and those.
  std::vector<float> known_map_;
  std::vector<BrightSample> bright_;
  JointState first_;
  double finish_seconds_ = 0.0;  // Finish and what follows, predicted
  std::string start_name_;
  std::vector<TriedMaterial> tried_;
  Eigen::MatrixXd covariance_;
  // Of log radiance, at the search's resolution.
  std::vector<float> mode_;  // [3][height][width]
  MapSize mode_size_;
  Image map_std_;
  std::vector<TraceEntry> trace_;
  int iterations_ = 0;
};

}  // namespace ibrdf
