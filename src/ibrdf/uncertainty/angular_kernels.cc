#include "ibrdf/uncertainty/angular_kernels.h"

#include "ibrdf/base/simd.h"
// These two need the vectors above.
#include "ibrdf/approximation/harmonic_recurrence.h"
#include "ibrdf/uncertainty/double_lanes.h"
#include "ibrdf/uncertainty/harmonic_fit_kernels.h"

namespace ibrdf {
namespace IBRDF_SIMD_NAMESPACE {
namespace {

// Behind this exp(-x) is nothing, and x exp(-x) must stay finite.
constexpr float kFarthest = 80.0f;

// What all alpha share of a view, kDoubles lanes each.
struct ViewFields {
  double* degrees;  // [order + 1, 3]: sum_m Y_lm L_lm
  double* weight;
  double* schlick;  // (1 - cos)^5, or 0 without Fresnel's term
  double* tangent2;
  double* masking;  // of the alpha at hand

  ViewFields(const AngularArguments& a, int view) {
    const int lanes = 3 * (a.batch.order + 1);
    degrees = a.workspace + static_cast<int64_t>(view) * (lanes + 4) * kDoubles;
    weight = degrees + lanes * kDoubles;
    schlick = weight + kDoubles;
    tangent2 = schlick + kDoubles;
    masking = tangent2 + kDoubles;
  }
};

void FillView(const AngularArguments& a, int lane, int view) {
  const ViewFields to(a, view);
  const int at = view * kFitBatch + lane;
  const Vd cosine = Widen(a.batch.polar + at);
  StoreDoubles(to.weight, Widen(a.batch.weight + at));
  const Vd t = 1.0 - cosine;
  StoreDoubles(to.schlick, a.fresnel ? t * t * t * t * t : Vd{});
  StoreDoubles(to.tangent2, (1.0 - cosine * cosine) / (cosine * cosine));
  Vd sums[3 * 11] = {};
  int degree_of[11 * 11];
  for (int l = 0; l <= a.batch.order; ++l) {
    for (int k = l * l; k < (l + 1) * (l + 1); ++k) degree_of[k] = l;
  }
  EvaluateRecurrence(a.batch.order, a.batch.diagonal, a.batch.up, a.batch.down,
                     cosine, Widen(a.batch.zero + at), Widen(a.batch.side + at),
                     [&](int harmonic, Vd y) {
                       const double* const c =
                           a.coefficients +
                           (harmonic * kFitValues + 3) * kFitBatch + lane;
                       Vd* const sum = sums + 3 * degree_of[harmonic];
                       for (int k = 0; k < 3; ++k) {
                         sum[k] += y * LoadDoubles(c + k * kFitBatch);
                       }
                     });
  for (int k = 0; k < 3 * (a.batch.order + 1); ++k) {
    StoreDoubles(to.degrees + k * kDoubles, sums[k]);
  }
}

// Smith's shadowing and masking of a GGX surface, Eq. 21: both directions have
// the angle of the mirror. The text shadows the light before it is smoothed;
// this does it behind, where the lobe is, and needs one fit for all alpha.
void FillMasking(const AngularArguments& a, double alpha, int view) {
  const ViewFields fields(a, view);
  const Vd one =
      2.0 /
      (1.0 + SqrtDoubles(1.0 + alpha * alpha * LoadDoubles(fields.tangent2)));
  StoreDoubles(fields.masking, a.masking ? one * one : Vd{} + 1.0);
}

void SumMoments(const AngularArguments& a, int lane, int i, int channel) {
  const double* const filter = a.filter + i * (a.batch.order + 1);
  Vd sums[kAngularMoments] = {};
  for (int view = 0; view < a.batch.num_views; ++view) {
    const ViewFields fields(a, view);
    Vd gloss = {};
    for (int l = 0; l <= a.batch.order; ++l) {
      gloss += filter[l] *
               LoadDoubles(fields.degrees + (3 * l + channel) * kDoubles);
    }
    gloss *= LoadDoubles(fields.masking);
    // F = Ks + (1 - Ks) schlick, Eq. 25 with R_0 = Ks.
    const Vd x0 = LoadDoubles(fields.schlick) * gloss;
    const Vd x = gloss - x0;
    const float* const B =
        a.batch.values + (view * kFitValues + channel) * kFitBatch + lane;
    const Vd y = Widen(B) - x0;
    const Vd w = LoadDoubles(fields.weight);
    sums[0] += w * y;
    sums[1] += w * y * y;
    sums[2] += w * x;
    sums[3] += w * x * x;
    sums[4] += w * x * y;
  }
  double* const out =
      a.moments + (3 * i + channel) * kAngularMoments * kFitBatch + lane;
  for (int k = 0; k < kAngularMoments; ++k) {
    StoreDoubles(out + k * kFitBatch, sums[k]);
  }
}

// Calls body(x) for every cell of one vector of signals, penalty and all.
template <typename Body>
void ForEachCell(const AngularGrid& g, const float* rows, int stride,
                 const Body& body) {
  for (int i = 0; i < g.num_alpha; ++i) {
    const float* const row = rows + i * kAngularRows * stride;
    const auto at = [&](AngularRow k) { return Load(row + k * stride); };
    const Vf rest = at(kRest), matte = at(kMatte), best = at(kMatteBest);
    const Vf gloss = at(kGloss), offset = at(kOffset), slope = at(kSlope);
    for (int k = 0; k < g.num_kd; ++k) {
      const Vf t = g.Kd[k] - best;
      const Vf base = rest + matte * (t * t);
      const Vf centre = offset - slope * g.Kd[k];
      for (int j = 0; j < g.num_ks; ++j) {
        const Vf s = g.Ks[j] - centre;
        const float penalty =
            g.penalty == nullptr ? 0.0f : g.penalty[i * g.num_ks + j];
        body(base + gloss * (s * s) + penalty);
      }
    }
  }
}

}  // namespace

void AngularMoments(const AngularArguments& a) {
  for (int lane = 0; lane < kFitBatch; lane += kDoubles) {
    for (int view = 0; view < a.batch.num_views; ++view)
      FillView(a, lane, view);
    for (int i = 0; i < a.num_alpha; ++i) {
      for (int view = 0; view < a.batch.num_views; ++view) {
        FillMasking(a, a.alpha[i], view);
      }
      for (int c = 0; c < 3; ++c) SumMoments(a, lane, i, c);
    }
  }
}

void AngularEntropy(const AngularGrid& g, const AngularSignals& signals) {
  const Vf uniform =
      Log(Splat(static_cast<float>(g.num_alpha * g.num_ks * g.num_kd)));
  for (int first = 0; first < signals.count; first += kLanes) {
    const float* const rows = signals.rows + first;
    Vf least = Splat(3e38f), Z = {}, mean = {};
    ForEachCell(g, rows, signals.count, [&](Vf x) { least = Min(least, x); });
    ForEachCell(g, rows, signals.count, [&](Vf x) {
      const Vf y = Min(x - least, Splat(kFarthest));
      const Vf e = Exp(-y);
      Z += e;
      mean += y * e;
    });
    const Vf H = (Log(Z) + mean / Z) / uniform;
    Store(signals.entropy + first, Min(Max(H, Splat(0.0f)), Splat(1.0f)));
  }
}

}  // namespace IBRDF_SIMD_NAMESPACE
}  // namespace ibrdf
