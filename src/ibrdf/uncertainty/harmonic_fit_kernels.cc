#include "ibrdf/uncertainty/harmonic_fit_kernels.h"

#include "ibrdf/base/simd.h"
// These two need the vectors above.
#include "ibrdf/approximation/harmonic_recurrence.h"
#include "ibrdf/uncertainty/double_lanes.h"

namespace ibrdf {
namespace IBRDF_SIMD_NAMESPACE {
namespace {

// Sums of a tile that fit in the registers.
constexpr int kRows = kLanes >= 16 ? 4 : 2;
constexpr int kColumns = kFitTile;

// Rows of the normal equations: the harmonics, then the right-hand sides, each
// part filled up with zeros to whole tiles.
struct Rows {
  int harmonics, padded, all;
};

// samples [num_views, rows.all, kDoubles]: Y and f times the root of the
// weight.
void WeightedRows(const FitArguments& a, int lane, const Rows& rows,
                  double* samples) {
  for (int view = 0; view < a.batch.num_views; ++view) {
    double* const row =
        samples + static_cast<int64_t>(view) * rows.all * kDoubles;
    for (int k = 0; k < rows.all; ++k) StoreDoubles(row + k * kDoubles, Vd{});
    const int at = view * kFitBatch + lane;
    const Vd polar = Widen(a.batch.polar + at);
    Vd root;
    for (int i = 0; i < kDoubles; ++i) {
      const double w = a.batch.weight[at + i];
      root[i] = w > 0.0 ? __builtin_sqrt(w) : 0.0;
      if (a.cosine_power == 2.0) {
        root[i] *= polar[i];
      } else if (w > 0.0) {
        root[i] *= __builtin_pow(polar[i], 0.5 * a.cosine_power);
      }
    }
    EvaluateRecurrence(a.batch.order, a.batch.diagonal, a.batch.up,
                       a.batch.down, polar, Widen(a.batch.zero + at),
                       Widen(a.batch.side + at), [&](int harmonic, Vd y) {
                         StoreDoubles(row + harmonic * kDoubles, y * root);
                       });
    for (int c = 0; c < kFitValues; ++c) {
      const float* const f =
          a.batch.values + (view * kFitValues + c) * kFitBatch + lane;
      StoreDoubles(row + (rows.padded + c) * kDoubles, Widen(f) * root);
    }
  }
}

// normal [rows.all, rows.padded, kDoubles]: the products of rows, below the
// diagonal and in the tiles on it.
void NormalEquations(int num_views, const Rows& rows, const double* samples,
                     double* normal) {
  for (int i = 0; i < rows.all; i += kRows) {
    for (int j = 0; j < rows.padded && j < i + kRows; j += kColumns) {
      Vd sum[kRows][kColumns] = {};
      const double* row = samples;
      for (int view = 0; view < num_views; ++view) {
        Vd right[kColumns];
        for (int b = 0; b < kColumns; ++b) {
          right[b] = LoadDoubles(row + (j + b) * kDoubles);
        }
        for (int r = 0; r < kRows; ++r) {
          const Vd left = LoadDoubles(row + (i + r) * kDoubles);
          for (int b = 0; b < kColumns; ++b) sum[r][b] += left * right[b];
        }
        row += rows.all * kDoubles;
      }
      for (int r = 0; r < kRows; ++r) {
        for (int b = 0; b < kColumns; ++b) {
          StoreDoubles(normal + ((i + r) * rows.padded + j + b) * kDoubles,
                       sum[r][b]);
        }
      }
    }
  }
}

// In place: the Cholesky factor, with the inverses of its diagonal, and below
// it what forward substitution makes of the right-hand sides.
void Factorise(const Rows& rows, const double* regulariser, double* normal) {
  const int n = rows.harmonics;
  const auto at = [&](int i, int j) {
    return normal + (i * rows.padded + j) * kDoubles;
  };
  for (int j = 0; j < n; ++j) {
    Vd d = LoadDoubles(at(j, j)) + regulariser[j];
    for (int k = 0; k < j; ++k) {
      const Vd x = LoadDoubles(at(j, k));
      d -= x * x;
    }
    const Vd inverse = 1.0 / SqrtDoubles(d);
    StoreDoubles(at(j, j), inverse);
    for (int i = j + 1; i < rows.padded + kFitValues; ++i) {
      if (i == n) i = rows.padded;
      Vd s = LoadDoubles(at(i, j));
      for (int k = 0; k < j; ++k) {
        s -= LoadDoubles(at(i, k)) * LoadDoubles(at(j, k));
      }
      StoreDoubles(at(i, j), s * inverse);
    }
  }
}

void BackSubstitute(const Rows& rows, int lane, const double* normal,
                    double* coefficients) {
  const int n = rows.harmonics;
  for (int c = 0; c < kFitValues; ++c) {
    const auto x = [&](int k) {
      return coefficients + (k * kFitValues + c) * kFitBatch + lane;
    };
    for (int i = n - 1; i >= 0; --i) {
      Vd s = LoadDoubles(normal +
                         ((rows.padded + c) * rows.padded + i) * kDoubles);
      for (int k = i + 1; k < n; ++k) {
        s -= LoadDoubles(normal + (k * rows.padded + i) * kDoubles) *
             LoadDoubles(x(k));
      }
      StoreDoubles(x(i),
                   s * LoadDoubles(normal + (i * rows.padded + i) * kDoubles));
    }
  }
}

}  // namespace

void FitHarmonics(const FitArguments& a) {
  const int n = (a.batch.order + 1) * (a.batch.order + 1);
  Rows rows{n, RoundUpToTile(n), 0};
  rows.all = rows.padded + RoundUpToTile(kFitValues);
  double* const samples = a.workspace;
  double* const normal =
      samples + static_cast<int64_t>(a.batch.num_views) * rows.all * kDoubles;
  for (int lane = 0; lane < kFitBatch; lane += kDoubles) {
    WeightedRows(a, lane, rows, samples);
    NormalEquations(a.batch.num_views, rows, samples, normal);
    Factorise(rows, a.regulariser, normal);
    BackSubstitute(rows, lane, normal, a.coefficients);
  }
}

}  // namespace IBRDF_SIMD_NAMESPACE
}  // namespace ibrdf
