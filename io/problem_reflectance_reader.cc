// The reader of the section `reflectance`.
#include <optional>
#include <string>

#include "ibrdf/io/problem_section_readers.h"

namespace ibrdf {
namespace {
using Kind = ConfigNode::Kind;

void ReadPaint(ProblemReader* reader, std::optional<PaintSpec>* paint) {
  reader->CheckNeeds("unpainted_albedo", reader->Has("albedo"));
  if (!reader->Has("albedo")) return;
  paint->emplace();
  reader->Read("albedo", &(*paint)->albedo);
  if (!reader->Has("unpainted_albedo")) return;
  (*paint)->unpainted_albedo.reset();
  reader->Read("unpainted_albedo", &(*paint)->unpainted_albedo);
}

void ReadPrincipled(ProblemReader reader, PrincipledSpec* principled) {
  reader.Read("base", &principled->base);
  reader.Read("roughness", &principled->roughness);
  reader.Read("metallic", &principled->metallic);
  reader.Read("specular", &principled->specular);
}

void ReadKnownBrdf(ProblemReader reader, ReflectanceSpec* reflectance) {
  ReadPaint(&reader, &reflectance->paint);
  if (reader.Has("brdf") + reader.Has("lambertian") +
          reader.Has("cook_torrance") + reader.Has("principled") !=
      1) {
    reader.Fail(
        "expected a file or one of brdf, lambertian, cook_torrance and "
        "principled");
    return;
  }
  if (reader.Has("principled")) {
    reflectance->principled.emplace();
    ReadPrincipled(reader.Below("principled"), &*reflectance->principled);
    if (reflectance->principled->textured() && reader.Has("albedo")) {
      reader.Fail("albedo", "expected without textures");
    }
    return;
  }
  if (reader.Has("brdf")) {
    reader.Read("brdf", &reflectance->known_file);
    return;
  }
  CookTorrance brdf;
  if (reader.Has("lambertian")) {
    brdf.specular.setZero();
    reader.Read("lambertian", &brdf.diffuse);
  } else {
    ProblemReader lobe = reader.Below("cook_torrance");
    lobe.Read("diffuse", &brdf.diffuse);
    lobe.Read("specular", &brdf.specular);
    lobe.Read("roughness", &brdf.roughness);
    lobe.Read("f0", &brdf.f0);
  }
  reflectance->analytic = brdf;
}

void ReadVariation(ProblemReader* reader, ReflectanceSpec* reflectance) {
  ReflectanceVariation& variation = reflectance->variation;
  reader->Read("variation", &variation);
  reader->Read("labels", &reflectance->labels);
  if (!reader->Has("labels")) return;
  if (variation == ReflectanceVariation::kAuto) {
    variation = ReflectanceVariation::kLabels;
  }
  if (variation != ReflectanceVariation::kLabels) {
    reader->Fail("labels", std::string("expected without variation: ") +
                               ReflectanceVariationName(variation));
  }
  if (reader->Has("known")) {
    reader->Fail("labels", "expected without reflectance.known");
  }
}

}  // namespace

void ReadReflectance(ProblemReader reader, ReflectanceSpec* reflectance) {
  reader.Read("model", &reflectance->model);
  reader.Read("lobes", &reflectance->lobes);
  reader.Read("prior_sigma", &reflectance->prior_sigma);
  ReadVariation(&reader, reflectance);
  const ConfigNode* known = reader.Find("known");
  if (known == nullptr) return;
  if (known->kind == Kind::kMap) {
    ReadKnownBrdf(reader.Below("known"), reflectance);
  } else {
    reader.Read("known", &reflectance->known_file);
  }
}

void SettleVariation(const SolverSpec& solver, ProblemReader reader,
                     ReflectanceSpec* reflectance) {
  if (solver.estimator != SolverEstimator::kMaximum) return;
  ReflectanceVariation& variation = reflectance->variation;
  if (variation == ReflectanceVariation::kAlbedo) {
    reader.Fail("variation", "expected none with solver.estimator: maximum");
  } else if (variation == ReflectanceVariation::kLabels) {
    reader.Fail("labels", "expected without solver.estimator: maximum");
  }
  variation = ReflectanceVariation::kNone;
}

}  // namespace ibrdf
