// Speed of both flows at every SIMD level and for 1 and 2 threads, beside the
// machine's peaks. FLOP/s count the conditioners' matrix products alone.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "experiments/benchmarks/flow_speed/machine_peaks.h"
#include "ibrdf/base/parallel_for.h"
#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/brdf/merl_columns.h"
#include "ibrdf/flow/brdf_flow.h"

namespace ibrdf {
namespace {

constexpr int64_t kPoints = 65536;

struct Net {
  std::string name;
  FlowShape shape;
};

FlowShape Coupling(const std::vector<int>& widths) {
  FlowShape shape;
  shape.architecture = FlowArchitecture::kCoupling;
  shape.coupling.widths = widths;
  return shape;
}

// Multiplications and additions of the products for one point (coupling stack)
// or one column (triangular: x_p's conditioner runs once for all columns).
double ProductFlops(const FlowShape& shape, bool column) {
  double sum = 0.0;
  const auto add = [&](const std::vector<DenseLayer>& dense) {
    for (const DenseLayer& d : dense) sum += 2.0 * d.in_count * d.out_count;
  };
  if (shape.architecture == FlowArchitecture::kCoupling) {
    for (int l = 0; l < shape.coupling.layers; ++l) {
      add(shape.coupling.DenseLayers());
    }
    return sum;
  }
  const auto conditioners = shape.triangular.Conditioners();
  for (int i = 0; i < (column ? 2 : 3); ++i) add(conditioners[i].dense);
  return sum;
}

void Report(benchmark::State& state, double points, double flops) {
  const double n = static_cast<double>(state.iterations());
  state.counters["points/s"] =
      benchmark::Counter(points * n, benchmark::Counter::kIsRate);
  state.counters["FLOP/s"] =
      benchmark::Counter(flops * n, benchmark::Counter::kIsRate);
}

// A flow at its trainer's start, with points and a code.
struct Bench {
  FlowShape shape;
  std::unique_ptr<BrdfFlow> flow;
  std::vector<float> code, x;

  Bench(const Net& net, SimdLevel level)
      : shape(net.shape),
        flow(BrdfFlow::Create(net.shape, InitialFlowWeights(net.shape, 1),
                              level)) {
    std::mt19937_64 rng(1);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    for (int k = 0; k < shape.code_size(); ++k) {
      code.push_back(0.2f * uniform(rng));
    }
    for (int64_t i = 0; i < 3 * kPoints; ++i) x.push_back(uniform(rng));
  }
};

void LogDensity(benchmark::State& state, const Net& net, SimdLevel level,
                int threads, bool gradient) {
  const Bench b(net, level);
  std::vector<float> value(kPoints), dcode(kPoints * b.code.size());
  for (auto _ : state) {
    b.flow->LogDensity(b.x.data(), kPoints, b.code.data(), threads,
                       value.data(), gradient ? dcode.data() : nullptr,
                       nullptr);
  }
  // Backward: adjoints of the inputs, as many operations as forward.
  Report(state, kPoints,
         kPoints * ProductFlops(net.shape, false) * (gradient ? 2 : 1));
}

void Inverse(benchmark::State& state, const Net& net, SimdLevel level,
             int threads) {
  const Bench b(net, level);
  const std::vector<double> u(b.x.begin(), b.x.end());
  std::vector<double> x(u.size());
  for (auto _ : state) {
    b.flow->Inverse(u.data(), kPoints, b.code.data(), threads, x.data());
  }
  Report(state, kPoints, kPoints * ProductFlops(net.shape, false));
}

// The trainer's step without its optimiser: chunks of 16 columns.
void WeightGradient(benchmark::State& state, const Net& net, SimdLevel level,
                    int threads, int points) {
  const Bench b(net, level);
  constexpr int kColumns = 16, kChunks = 16;
  const int64_t passes = kPoints / (kColumns * points);
  std::vector<FlowColumns> columns(kChunks, FlowColumns(kColumns, points));
  std::vector<std::unique_ptr<BrdfFlow::TrainingPass>> pass;
  std::vector<std::vector<float>> buffer(kChunks);
  for (int k = 0; k < kChunks; ++k) {
    for (int c = 0; c < kColumns; ++c) {
      columns[k].SetColumn(c, b.x[k * kColumns + c], b.x[9999 + c]);
    }
    std::copy_n(b.x.data() + k * kColumns * points, kColumns * points,
                columns[k].x_h.data());
    pass.push_back(b.flow->NewTrainingPass());
    buffer[k].resize(b.flow->GradientSize());
  }
  std::vector<float> weights(net.shape.NumWeights());
  for (auto _ : state) {
    ParallelFor(kChunks, threads, [&](int64_t k, int) {
      std::fill(buffer[k].begin(), buffer[k].end(), 0.0f);
      std::vector<float> value(kColumns * points), adjoint(value.size(), 1.0f);
      std::vector<float> dcode(b.code.size());
      for (int64_t i = k; i < passes; i += kChunks) {
        pass[k]->Forward(columns[k], 1, b.code.data(), value.data());
        pass[k]->Backward(adjoint.data(), buffer[k].data(), dcode.data());
      }
    });
    std::fill(weights.begin(), weights.end(), 0.0f);
    for (const auto& g : buffer) b.flow->AddGradient(g.data(), weights.data());
    benchmark::DoNotOptimize(weights.data());
  }
  const bool triangular =
      net.shape.architecture == FlowArchitecture::kTriangular;
  Report(state, kPoints,
         3 * ProductFlops(net.shape, false) *
             static_cast<double>(kPoints / (triangular ? points : 1)));
}

FlowColumns GridColumns(const BrdfGridShape& grid) {
  FlowColumns x(grid.d * grid.p, grid.h);
  for (int c = 0; c < x.columns; ++c) {
    for (int i = 0; i < grid.h; ++i) {
      const Eigen::Vector3d p = grid.NodePoint(i * x.columns + c);
      if (i == 0) x.SetColumn(c, p[1], p[2]);
      x.x_h[static_cast<size_t>(i) * x.columns + c] = static_cast<float>(p[0]);
    }
  }
  return x;
}

void Columns(benchmark::State& state, const Net& net, SimdLevel level,
             int threads, const FlowColumns& x, bool gradient) {
  const Bench b(net, level);
  std::vector<float> value(x.num_points());
  std::vector<float> dcode(gradient ? value.size() * b.code.size() : 0);
  for (auto _ : state) {
    b.flow->LogDensityOnColumns(x, b.code.data(), threads, value.data(),
                                gradient ? dcode.data() : nullptr);
  }
  const double points = static_cast<double>(x.num_points());
  // Triangular: a tangent by each number of the code, per column.
  const bool stack = net.shape.architecture == FlowArchitecture::kCoupling;
  const double passes =
      !gradient ? 1.0 : (stack ? 2.0 : 1.0 + net.shape.code_size());
  Report(state, points,
         passes * ProductFlops(net.shape, true) * (stack ? points : x.columns));
  if (gradient) {
    // Written once: the least that must move.
    state.counters["bytes/s"] = benchmark::Counter(
        4.0 * points * static_cast<double>(state.iterations()) *
            (1 + net.shape.code_size()),
        benchmark::Counter::kIsRate);
  }
}

template <typename F>
void Add(const std::string& name, F f) {
  benchmark::RegisterBenchmark(name.c_str(), f)
      ->MeasureProcessCPUTime()
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
}

void AddPeaks(SimdLevel level, const std::string& tail) {
  Add("peak" + tail, [level](benchmark::State& state) {
    double flops = 0.0;
    for (auto _ : state) {
      flops += static_cast<double>(MultiplyAdds(level, 1 << 20));
    }
    state.counters["FLOP/s"] =
        benchmark::Counter(flops, benchmark::Counter::kIsRate);
  });
}

void AddFlow(const Net& net, SimdLevel level, int threads,
             const std::string& tail) {
  const bool triangular =
      net.shape.architecture == FlowArchitecture::kTriangular;
  for (const bool gradient : {false, true}) {
    Add(net.name + (gradient ? "/code_gradient" : "/log_density") + tail,
        [=](benchmark::State& s) {
          LogDensity(s, net, level, threads, gradient);
        });
  }
  // The stack's tape of 16 x 16 points fits a core's cache.
  Add(net.name + "/weights_gradient" + tail, [=](benchmark::State& s) {
    WeightGradient(s, net, level, threads, triangular ? 32 : 16);
  });
  Add(net.name + "/inverse" + tail,
      [=](benchmark::State& s) { Inverse(s, net, level, threads); });
  const bool paper = net.shape.NumWeights() > 500000;
  for (const bool gradient : {false, true}) {
    if (!paper) {
      Add(net.name + "/table" + (gradient ? "_code_gradient" : "") + tail,
          [=](benchmark::State& s) {
            Columns(s, net, level, threads, MerlColumns(), gradient);
          });
    }
  }
  Add(net.name + "/grid_code_gradient" + tail, [=](benchmark::State& s) {
    Columns(s, net, level, threads, GridColumns({72, 32, 24}), true);
  });
}

void AddAll() {
  Add("stream/one_core", [](benchmark::State& state) {
    std::vector<float> values(64 << 20);
    double bytes = 0.0;
    for (auto _ : state) {
      bytes += static_cast<double>(Stream(values.data(), values.size()));
      benchmark::ClobberMemory();
    }
    state.counters["bytes/s"] =
        benchmark::Counter(bytes, benchmark::Counter::kIsRate);
  });
  const Net nets[] = {{"coupling_small", Coupling({64, 24})},
                      {"coupling_paper", Coupling({256, 128, 64, 32, 16})},
                      {"triangular", FlowShape()}};
  for (const SimdLevel level :
       {SimdLevel::kPortable, SimdLevel::kAvx2, SimdLevel::kAvx512}) {
    if (!SimdLevelSupported(level)) continue;
    AddPeaks(level, std::string("/") + SimdLevelName(level));
    for (const Net& net : nets) {
      for (const int threads : {1, 2}) {
        AddFlow(net, level, threads,
                std::string("/") + SimdLevelName(level) + "/threads_" +
                    std::to_string(threads));
      }
    }
  }
}

}  // namespace
}  // namespace ibrdf

int main(int argc, char** argv) {
  ibrdf::AddAll();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
