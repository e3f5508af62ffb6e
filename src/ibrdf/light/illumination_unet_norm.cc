// Instance normalisation in the UNet engine.
#include <algorithm>
#include <cmath>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/light/illumination_unet_engine.h"

namespace ibrdf {
namespace {

// Sums by channel over a map: rows in any thread, joined in order.
class RowSums {
 public:
  explicit RowSums(const UnetMap& map)
      : map_(map), sums_(static_cast<size_t>(map.height) * map.stride, 0.0f) {}
  float* Row(int64_t row) { return sums_.data() + row * map_.stride; }

  // [padded channel]: the sums by the number of texels.
  std::vector<double> Means() const {
    std::vector<double> mean(map_.stride, 0.0);
    for (size_t i = 0; i < sums_.size(); ++i) {
      mean[i % map_.stride] += sums_[i];
    }
    for (double& m : mean) m /= static_cast<double>(map_.height) * map_.width;
    return mean;
  }

 private:
  const UnetMap map_;
  UnetBuffer sums_;
};

}  // namespace

void UnetEngine::NormalizeAndActivate(int step_index,
                                      UnetBuffers* forward) const {
  const UnetStep& step = plan_.steps[step_index];
  const int threads = ThreadsFor(step);
  const UnetMap x = MapOf(step.output, forward->maps);
  const UnetMap y{forward->normalized[step_index].data(), x.channels, x.height,
                  x.width, x.stride};
  const UnetMap slope{forward->slopes[step_index].data(), x.channels, x.height,
                      x.width, x.stride};
  const UnetBuffer zero(x.stride, 0.0f), one(x.stride, 1.0f);
  RowSums sums(x), squares(x);
  ParallelFor(x.height, threads, [&](int64_t r, int) {
    const int row = static_cast<int>(r);
    kernels_.add_texels(x.At(row, 0), x.stride, x.width, x.channels,
                        sums.Row(row));
  });
  const std::vector<double> mean = sums.Means();
  UnetBuffer shift(x.stride);
  for (int c = 0; c < x.stride; ++c) shift[c] = static_cast<float>(-mean[c]);
  ParallelFor(x.height, threads, [&](int64_t r, int) {
    float* row = x.At(static_cast<int>(r), 0);
    kernels_.combine(row, row, x.stride, x.width, one.data(), shift.data(),
                     zero.data());
    kernels_.add_products(row, row, x.stride, x.width, x.channels,
                          squares.Row(r));
  });
  const std::vector<double> variance = squares.Means();
  UnetBuffer& inverse = forward->inverse_deviation[step_index];
  for (int c = 0; c < x.channels; ++c) {
    inverse[c] = static_cast<float>(
        1.0 / std::sqrt(variance[c] + double{kUnetNormEpsilon}));
  }
  const float* bias = forward->weights.data() + packing_[step_index].bias;
  const int64_t row_size = static_cast<int64_t>(x.width) * x.stride;
  ParallelFor(x.height, threads, [&](int64_t r, int) {
    const int index = static_cast<int>(r);
    float* row = x.At(index, 0);
    kernels_.combine(row, row, x.stride, x.width, inverse.data(), zero.data(),
                     zero.data());
    std::copy_n(row, row_size, y.At(index, 0));
    kernels_.combine(row, row, x.stride, x.width, one.data(), bias,
                     zero.data());
    kernels_.activate(row, slope.At(index, 0), row_size);
  });
}

void UnetEngine::ApplyNormJacobian(int step_index, const UnetBuffers& forward,
                                   const float* shift, const UnetMap& d) const {
  const int threads = ThreadsFor(plan_.steps[step_index]);
  const UnetMap y{const_cast<float*>(forward.normalized[step_index].data()),
                  d.channels, d.height, d.width, d.stride};
  const UnetBuffer& inverse = forward.inverse_deviation[step_index];
  RowSums sums(d), products(d);
  ParallelFor(d.height, threads, [&](int64_t r, int) {
    const float* row = d.At(static_cast<int>(r), 0);
    kernels_.add_texels(row, d.stride, d.width, d.channels, sums.Row(r));
    kernels_.add_products(row, y.At(static_cast<int>(r), 0), d.stride, d.width,
                          d.channels, products.Row(r));
  });
  const std::vector<double> mean = sums.Means();
  const std::vector<double> along = products.Means();
  UnetBuffer offset(d.stride, 0.0f), slope(d.stride, 0.0f);
  for (int c = 0; c < d.channels; ++c) {
    offset[c] = shift[c] - static_cast<float>(inverse[c] * mean[c]);
    slope[c] = -static_cast<float>(inverse[c] * along[c]);
  }
  ParallelFor(d.height, threads, [&](int64_t r, int) {
    const int row = static_cast<int>(r);
    kernels_.combine(d.At(row, 0), y.At(row, 0), d.stride, d.width,
                     inverse.data(), offset.data(), slope.data());
  });
}

}  // namespace ibrdf
