#include "ibrdf/light/area_average.h"

#include "ibrdf/base/parallel_for.h"

namespace ibrdf {

Image AverageByArea(const Image& map,
                    const std::vector<std::vector<IntervalPart>>& rows,
                    const std::vector<std::vector<IntervalPart>>& columns,
                    int num_threads) {
  Image out(static_cast<int>(columns.size()), static_cast<int>(rows.size()));
  ParallelFor(out.height, num_threads, [&](int64_t r, int) {
    for (int c = 0; c < out.width; ++c) {
      double sum[3] = {0.0, 0.0, 0.0}, area = 0.0;
      for (const IntervalPart& y : rows[r]) {
        for (const IntervalPart& x : columns[c]) {
          const double a = y.length * x.length;
          const float* texel = map.At(x.source, y.source);
          area += a;
          for (int k = 0; k < 3; ++k) sum[k] += a * texel[k];
        }
      }
      for (int k = 0; k < 3; ++k) {
        out.At(c, static_cast<int>(r))[k] = static_cast<float>(sum[k] / area);
      }
    }
  });
  return out;
}

}  // namespace ibrdf
