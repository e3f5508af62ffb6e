#include "ibrdf/solvers/entropy_study/evaluator_variants.h"

#include <utility>

#include "ibrdf/base/format.h"
#include "ibrdf/uncertainty/measured_materials.h"

namespace ibrdf {
namespace {

using Variants = std::vector<EvaluatorVariant>;

EvaluatorVariant Spectrum(std::string name, SpectrumOptions options) {
  EvaluatorVariant out;
  out.name = std::move(name);
  out.spectrum = std::move(options);
  return out;
}

EvaluatorVariant Angular(std::string name, AngularOptions options) {
  EvaluatorVariant out;
  out.name = std::move(name);
  out.angular = std::move(options);
  out.is_angular = true;
  return out;
}

// The published form, the defaults, and each mended default undone.
void AddSpectrumVariants(Variants* variants) {
  Variants& out = *variants;
  for (const double denominator : {1e-5, 1e-4, 1e-3, 1e-2, 1e-1}) {
    out.push_back(Spectrum(Format("published %g", denominator),
                           SpectrumOptions::Published(denominator)));
    out.back().unhidden_light = false;
  }
  out.push_back(Spectrum("spectrum", {}));
  out.push_back(Spectrum("spectrum hidden light kept", {}));
  out.back().unhidden_light = false;
  SpectrumOptions s;
  s.filter = GlossFilter::kBeckmann;
  out.push_back(Spectrum("spectrum Beckmann", s));
  s = {};
  s.undo_prefilter = false;
  out.push_back(Spectrum("spectrum prefilter kept", s));
  s = {};
  s.fit.constant_penalty = 1.0;
  out.push_back(Spectrum("spectrum constant penalised", s));
  s = {};
  s.relative_weights = true;
  out.push_back(Spectrum("spectrum relative weights", s));
  s = {};
  s.fit.lambda = 1e-2;
  out.push_back(Spectrum("spectrum lambda 0.01", s));
  s = {};
  s.fit.order = 8;
  out.push_back(Spectrum("spectrum order 8", s));
  for (const double sigma : {0.025, 0.035, 0.07, 0.1, 0.14}) {
    s = {};
    s.sigma = sigma;
    out.push_back(Spectrum(Format("spectrum sigma %g", sigma), s));
  }
  for (const double sigma : {0.04, 0.15, 0.6}) {
    s = {};
    s.distance = SpectrumDistance::kPower;
    s.sigma = sigma;
    out.push_back(Spectrum(Format("spectrum Eq. 11 sigma %g", sigma), s));
  }
}

void AddAngularVariants(Variants* variants) {
  Variants& out = *variants;
  out.push_back(Angular("angular", {}));
  out.push_back(Angular("angular hidden light kept", {}));
  out.back().unhidden_light = false;
  out.back().irradiance = IrradianceSource::kOpen;
  out.push_back(Angular("angular open irradiance", {}));
  out.back().irradiance = IrradianceSource::kOpen;
  out.push_back(Angular("angular irradiance of the fit", {}));
  out.back().irradiance = IrradianceSource::kFit;
  AngularOptions a;
  a.filter = GlossFilter::kBeckmann;
  out.push_back(Angular("angular Beckmann", a));
  a = {};
  a.undo_prefilter = false;
  out.push_back(Angular("angular prefilter kept", a));
  a = {};
  a.fresnel = a.masking = false;
  out.push_back(Angular("angular no Fresnel no masking", a));
  a = {};
  a.num_kd = 0;
  out.push_back(Angular("angular Kd profiled", a));
  a = {};
  a.fit.constant_penalty = 1.0;
  out.push_back(Angular("angular constant penalised", a));
  a = {};
  a.fit.lambda = 1e-2;
  out.push_back(Angular("angular lambda 0.01", a));
  for (const int order : {3, 8}) {
    a = {};
    a.fit.order = order;
    out.push_back(Angular(Format("angular order %.0f", double(order)), a));
  }
  for (const double sigma : {0.05, 0.1, 0.14}) {
    a = {};
    a.sigma = sigma;
    out.push_back(Angular(Format("angular sigma %g", sigma), a));
  }
}

// With the prior of measured materials, which those of the study are not.
void AddPriorVariants(Variants* variants) {
  SpectrumOptions s;
  s.prior = PriorOfMeasuredMaterials(AlphaValues(s.alpha_grid, s.num_alpha),
                                     UnitValues(s.num_ks));
  variants->push_back(Spectrum("spectrum prior of materials", s));
  AngularOptions a;
  a.prior = s.prior;
  variants->push_back(Angular("angular prior of materials", a));
}

}  // namespace

std::vector<EvaluatorVariant> EvaluatorVariants() {
  Variants out;
  AddSpectrumVariants(&out);
  AddAngularVariants(&out);
  AddPriorVariants(&out);
  return out;
}

StatusOr<EntropyMaps> EvaluateVariant(const EvaluatorVariant& variant,
                                      const StudyScene& scene,
                                      int num_threads) {
  TexelSamples samples = scene.samples;
  if (variant.unhidden_light) samples.incoming = scene.unhidden_incoming;
  if (variant.irradiance == IrradianceSource::kOpen) {
    samples.irradiance = scene.open_irradiance;
  } else if (variant.irradiance == IrradianceSource::kUnhidden) {
    samples.irradiance = scene.unhidden_irradiance;
  }
  if (variant.is_angular) {
    return AngularEntropyEvaluator(variant.angular)
        .Evaluate(samples, num_threads);
  }
  return SpectrumEntropyEvaluator(variant.spectrum)
      .Evaluate(samples, num_threads);
}

}  // namespace ibrdf
