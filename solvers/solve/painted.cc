#include "ibrdf/solvers/solve/painted.h"

#include <glog/logging.h>

#include <utility>
#include <vector>

#include "ibrdf/solvers/estimation/light_given_reflectance.h"
#include "ibrdf/solvers/estimation/marginal_search.h"
#include "ibrdf/solvers/paint/albedo_deviation.h"
#include "ibrdf/solvers/paint/albedo_fit.h"
#include "ibrdf/solvers/paint/first_paint.h"
#include "ibrdf/solvers/paint/gloss_separation.h"
#include "ibrdf/solvers/solve/other_photographs.h"
#include "ibrdf/solvers/solve/summary.h"
#include "ibrdf/solvers/solve/turns.h"
#include "ibrdf/solvers/solve/unpainted_object.h"

namespace ibrdf {
namespace {

constexpr int kLightTurns = 2;  // of light and paint

// A painted object in its photographs: what is known so far.
class PaintedObject {
 public:
  // `setup` must outlive this.
  PaintedObject(const SolveSetup& setup, std::vector<LitPhotograph> others,
                std::vector<NeighbourPair> neighbours, SharedPaint paint)
      : setup_(setup),
        others_(std::move(others)),
        neighbours_(std::move(neighbours)),
        options_(InViews(paint.options, setup.pixels.points)),
        log_albedo_(std::move(paint.log_albedo)) {}

  // The reflectance that was found, and the paint under what that says of the
  // light; several photographs have told as much before.
  void Begin(const ReflectanceEstimate& found);
  // The lights and the rest given the paint, and the paint under those lights.
  StatusOr<Solution> TakeTurn(const ReflectanceEstimate& found,
                              SolveContext* context);

 private:
  std::vector<double> GainOf(const LitPhotograph& other) const;
  std::vector<PaintedImage> Images() const;
  std::vector<double> GlossOf(const PaintedImage& image) const;
  // The images with the gloss that FitPaint found in each.
  std::vector<PaintedImage> SeparatedImages() const;
  void FitPaint();

  const SolveSetup& setup_;
  std::vector<LitPhotograph> others_;
  const std::vector<NeighbourPair> neighbours_;
  const AlbedoFitOptions options_;
  UnpaintedReflectance reflectance_;
  UnpaintedRadiance unpainted_;               // in the first photograph
  std::vector<UnpaintedRadiance> separated_;  // of each photograph, by FitPaint
  std::vector<double> log_albedo_;
};

void PaintedObject::Begin(const ReflectanceEstimate& found) {
  reflectance_ = UnpaintedOf(*setup_.lobes, found.lobes.data());
  std::vector<float> map;
  found.light.mode.Exp(&map);
  unpainted_ =
      RenderUnpainted(setup_, reflectance_, map, found.light.mode.size());
  if (others_.empty()) FitPaint();
}

// Before its light is known, the object counts as matte.
std::vector<double> PaintedObject::GainOf(const LitPhotograph& other) const {
  return other.unpainted.matte.empty()
             ? MatteGain(log_albedo_)
             : PaintGain(other.unpainted, log_albedo_);
}

std::vector<PaintedImage> PaintedObject::SeparatedImages() const {
  std::vector<PaintedImage> images = Images();
  for (size_t k = 0; k < images.size(); ++k) {
    images[k].unpainted = &separated_[k];
  }
  return images;
}

std::vector<PaintedImage> PaintedObject::Images() const {
  std::vector<PaintedImage> images = {{&unpainted_, &setup_.pixels.observed}};
  for (const LitPhotograph& other : others_) {
    images.push_back({&other.unpainted, &other.observed});
  }
  return images;
}

// Where chroma that drifts is the light's it tells no gloss.
std::vector<double> PaintedObject::GlossOf(const PaintedImage& image) const {
  return options_.chroma_drifts
             ? image.unpainted->gloss
             : SeparateGloss(image, log_albedo_, reflectance_.albedo,
                             neighbours_, options_);
}

void PaintedObject::FitPaint() {
  separated_.clear();
  for (const PaintedImage& image : Images()) {
    separated_.push_back({image.unpainted->matte, GlossOf(image)});
  }
  log_albedo_ = FitAlbedo(SeparatedImages(), neighbours_, options_);
}

StatusOr<Solution> PaintedObject::TakeTurn(const ReflectanceEstimate& found,
                                           SolveContext* context) {
  const std::vector<ShadingPoint>& points = setup_.pixels.points;
  const InverseProblem without =
      WithoutPaint(*setup_.problem, PaintGain(unpainted_, log_albedo_), points);
  const StatusOr<SolveSetup> of_light = SetUp(without);
  if (!of_light.ok()) return of_light.status();
  StatusOr<Estimate> estimate = EstimateLight(*of_light, found, context);
  if (!estimate.ok()) return estimate.status();
  Solution solution = Summarise(*of_light, *std::move(estimate), context,
                                UnpaintedRenders(reflectance_, &unpainted_));
  TakeMatteOff(&unpainted_);
  for (LitPhotograph& other : others_) {
    IBRDF_RETURN_IF_ERROR(
        FindOtherLight(reflectance_, GainOf(other), *context, &other));
  }
  FitPaint();
  // Renders are the matte part in its paint and the gloss that is written.
  ScalePixels(PaintGain(unpainted_, log_albedo_, separated_.front().gloss),
              points, &solution.render);
  for (size_t k = 0; k < others_.size(); ++k) {
    solution.other_lights.push_back(others_[k].light);
    ScalePixels(
        PaintGain(others_[k].unpainted, log_albedo_, separated_[k + 1].gloss),
        points, &solution.other_lights.back().render);
  }
  SetPaint(setup_, reflectance_, separated_.front(), log_albedo_,
           AlbedoLogStd(SeparatedImages(), neighbours_, log_albedo_, options_),
           &solution);
  return solution;
}

// What all photographs tell of the paint; one tells what it told before.
SharedPaint SharedPaintOf(const SolveSetup& setup, const FirstPaint& first,
                          const std::vector<LitPhotograph>& others,
                          const std::vector<NeighbourPair>& neighbours) {
  if (others.empty()) return {first.log_albedo, first.options};
  const std::vector<ShadingPoint>& points = setup.pixels.points;
  std::vector<const Observations*> observed = {&setup.pixels.observed};
  std::vector<FirstPaint> of_images = {first};
  for (const LitPhotograph& other : others) {
    observed.push_back(&other.observed);
    of_images.push_back(FindFirstPaint(points, other.observed, neighbours));
  }
  return FindSharedPaint(points, observed, of_images, neighbours);
}

}  // namespace

StatusOr<Solution> SolvePainted(const SolveSetup& setup,
                                SolveContext* context) {
  const std::vector<NeighbourPair> neighbours =
      NeighboursOf(setup.pixels.points, setup.problem->image.width);
  StatusOr<std::vector<LitPhotograph>> others =
      OtherPhotographsOf(*setup.problem);
  if (!others.ok()) return others.status();
  const FirstPaint first =
      FindFirstPaint(setup.pixels.points, setup.pixels.observed, neighbours);
  // What the lamp gets wrong of the first photograph's shading must stay in its
  // own paint here, or lobes explain it.
  const StatusOr<ReflectanceEstimate> found =
      EstimateReflectance(setup, context, &first);
  if (!found.ok() && found.status().code() != StatusCode::kNoImprovement) {
    return found.status();
  }
  if (!found.ok() || found->light.mode.num_texels() == 0) {
    LOG(WARNING) << "no paint was told from the light";
    return Summarise(setup, ConstantLight(setup, MeanMaterial(setup)), context);
  }
  SharedPaint paint = SharedPaintOf(setup, first, *others, neighbours);
  PaintedObject object(setup, *std::move(others), neighbours, std::move(paint));
  object.Begin(*found);
  Turns turns(kLightTurns, context);
  StatusOr<Solution> solution = object.TakeTurn(*found, context);
  while (solution.ok() && turns.Another()) {
    StatusOr<Solution> next = object.TakeTurn(*found, context);
    if (!next.ok()) return next;
    if (next->misfit < solution->misfit) solution = std::move(next);
  }
  if (solution.ok()) solution->seconds = context->Elapsed();
  return solution;
}

}  // namespace ibrdf
