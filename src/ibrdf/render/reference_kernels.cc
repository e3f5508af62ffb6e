#include "ibrdf/render/reference_kernels.h"

#include "ibrdf/base/fast_atan2.h"
#include "ibrdf/base/simd.h"

namespace ibrdf {
namespace IBRDF_SIMD_NAMESPACE {
namespace {

constexpr float kPiFloat = 3.14159265358979323846f;

void PlaceRays(const float* x, const float* y, const float* z, int n,
               const float* frame, int height, int width, float* row,
               float* column) {
  const float rows_per_radian = static_cast<float>(height) / kPiFloat;
  const float columns_per_radian = static_cast<float>(width) / (2 * kPiFloat);
  const float last_row = static_cast<float>(height) + 0.5f;
  const float columns = static_cast<float>(width);
  for (int k = 0; k < n; ++k) {
    const float wx = x[k] * frame[0] + y[k] * frame[3] + z[k] * frame[6];
    const float wy = x[k] * frame[1] + y[k] * frame[4] + z[k] * frame[7];
    const float wz = x[k] * frame[2] + y[k] * frame[5] + z[k] * frame[8];
    const float theta = FastAtan2(__builtin_sqrtf(wx * wx + wz * wz), wy);
    const float phi = FastAtan2(wx, wz);
    const float r = theta * rows_per_radian + 0.5f;
    const float c = phi * columns_per_radian - 0.5f;
    row[k] = r < last_row ? r : last_row;
    column[k] = c < 0.0f ? c + columns : c;
  }
}

void LookUpMaps(const float* lanes, int height, int width, int stride,
                const float* row, const float* column, int n, float* out) {
  const int64_t line = static_cast<int64_t>(width + 1) * stride;
  for (int k = 0; k < n; ++k) {
    int r = static_cast<int>(row[k]), c = static_cast<int>(column[k]);
    r = r < height ? r : height;
    c = c < width - 1 ? c : width - 1;
    const float fy = row[k] - static_cast<float>(r);
    const float fx = column[k] - static_cast<float>(c);
    const float* const upper = lanes + r * line + int64_t{c} * stride;
    const float* const lower = upper + line;
    const float w00 = (1 - fy) * (1 - fx), w01 = (1 - fy) * fx;
    const float w10 = fy * (1 - fx), w11 = fy * fx;
    float* const to = out + int64_t{k} * stride;
    for (int v = 0; v < stride; v += kLanes) {
      Store(to + v,
            w00 * Load(upper + v) + w01 * Load(upper + stride + v) +
                (w10 * Load(lower + v) + w11 * Load(lower + stride + v)));
    }
  }
}

void BlendRows(const float* rows, int stride, const MerlTaps* taps, int n,
               float* out) {
  // Rows of tables lie far apart: those of a later tap are asked for early.
  constexpr int kAhead = 2;
  constexpr int kLineFloats = 16;
  for (int i = 0; i < n; ++i) {
    const MerlTaps& t = taps[i];
    if (i + kAhead < n) {
      for (const int bin : taps[i + kAhead].bin) {
        const float* const ahead = rows + static_cast<int64_t>(bin) * stride;
        for (int v = 0; v < stride; v += kLineFloats) {
          __builtin_prefetch(ahead + v);
        }
      }
    }
    const float* from[8];
    for (int k = 0; k < 8; ++k) {
      from[k] = rows + static_cast<int64_t>(t.bin[k]) * stride;
    }
    float* const to = out + int64_t{i} * stride;
    for (int v = 0; v < stride; v += kLanes) {
      Vf even = t.weight[0] * Load(from[0] + v);
      Vf odd = t.weight[1] * Load(from[1] + v);
      for (int k = 2; k < 8; k += 2) {
        even += t.weight[k] * Load(from[k] + v);
        odd += t.weight[k + 1] * Load(from[k + 1] + v);
      }
      Store(to + v, even + odd);
    }
  }
}

// kMaps maps from g on and kVectors vectors of f, of one channel.
template <int kMaps, int kVectors>
[[gnu::always_inline]] inline void AddTile(const float* f, int f_stride,
                                           const float* const* g, int at, int n,
                                           int row, double* sums) {
  Vf sum[kMaps][kVectors] = {};
  for (int i = 0; i < n; ++i) {
    const float* const fi = f + int64_t{i} * f_stride;
    const float* const gi = g[i] + at;
    Vf values[kVectors];
    for (int v = 0; v < kVectors; ++v) values[v] = Load(fi + v * kLanes);
    for (int l = 0; l < kMaps; ++l) {
      for (int v = 0; v < kVectors; ++v) sum[l][v] += values[v] * gi[l];
    }
  }
  for (int l = 0; l < kMaps; ++l) {
    for (int v = 0; v < kVectors; ++v) {
      double* const to = sums + static_cast<int64_t>(l) * row + v * kLanes;
      for (int k = 0; k < kLanes; ++k) to[k] += sum[l][v][k];
    }
  }
}

template <int kVectors>
[[gnu::always_inline]] inline void AddMaps(const float* f, int f_stride,
                                           const float* const* g, int at,
                                           int num_l, int n, int row,
                                           double* sums) {
  constexpr int kTile = 4;
  int l = 0;
  for (; l + kTile <= num_l; l += kTile) {
    AddTile<kTile, kVectors>(f, f_stride, g, at + l, n, row,
                             sums + static_cast<int64_t>(l) * row);
  }
  double* const rest = sums + static_cast<int64_t>(l) * row;
  switch (num_l - l) {
    case 1:
      return AddTile<1, kVectors>(f, f_stride, g, at + l, n, row, rest);
    case 2:
      return AddTile<2, kVectors>(f, f_stride, g, at + l, n, row, rest);
    case 3:
      return AddTile<3, kVectors>(f, f_stride, g, at + l, n, row, rest);
    default:
      return;
  }
}

void AddProducts(const float* f, int f_stride, int num_m, const float* const* g,
                 int num_l, int n, double* sums) {
  const int row =
      (num_m + kReferenceStride - 1) / kReferenceStride * kReferenceStride;
  for (int c = 0; c < 3; ++c) {
    const float* const fc = f + int64_t{c} * num_m;
    double* const to = sums + static_cast<int64_t>(c) * num_l * row;
    int m = 0;
    for (; m + kLanes < num_m; m += 2 * kLanes) {
      AddMaps<2>(fc + m, f_stride, g, c * num_l, num_l, n, row, to + m);
    }
    if (m < num_m) {
      AddMaps<1>(fc + m, f_stride, g, c * num_l, num_l, n, row, to + m);
    }
  }
}

}  // namespace

extern const ReferenceKernels kReferenceKernels;
const ReferenceKernels kReferenceKernels = {PlaceRays, LookUpMaps, BlendRows,
                                            AddProducts};

}  // namespace IBRDF_SIMD_NAMESPACE
}  // namespace ibrdf
