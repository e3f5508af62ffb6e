#include "ibrdf/light/illumination_unet.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ibrdf/base/normal_source.h"
#include "ibrdf/light/illumination_unet_engine.h"

namespace ibrdf {

#if defined(IBRDF_HAVE_X86_KERNELS)
namespace avx2 {
const UnetKernels& IlluminationUnetKernels();
}
namespace avx512 {
const UnetKernels& IlluminationUnetKernels();
}
#endif
namespace portable {
const UnetKernels& IlluminationUnetKernels();
}

const UnetKernels& GetUnetKernels(SimdLevel level) {
  CHECK(SimdLevelSupported(level)) << SimdLevelName(level);
#if defined(IBRDF_HAVE_X86_KERNELS)
  if (level == SimdLevel::kAvx512) return avx512::IlluminationUnetKernels();
  if (level == SimdLevel::kAvx2) return avx2::IlluminationUnetKernels();
#endif
  return portable::IlluminationUnetKernels();
}

namespace {

// Prior standard deviation of the biases of hidden layers: small beside the
// features' 1, so that a feature's offset does not drown its variation.
constexpr float kHiddenBiasStd = 0.1f;
// Deviation of the last biases, which are log-radiance itself: a factor e
// either way.
constexpr float kOutputBiasStd = 1.0f;
// Deviation of the last layer's output: features enter log-radiance at this
// scale.
constexpr float kOutputStd = 1.0f;

// L_o a(x)^2 for x ~ N(0, 1): the midpoint rule, exact to rounding here.
double ActivationPower() {
  constexpr double kStep = 1e-2;
  double power = 0.0, total = 0.0;
  for (double x = -8.0; x <= 8.0; x += kStep) {
    const double bend =
        std::sqrt(x * x + double{kUnetCurvature} * kUnetCurvature) -
        kUnetCurvature;
    const double a =
        0.5 * (1.0 + kUnetLeak) * x + 0.5 * (1.0 - kUnetLeak) * bend;
    const double density = std::exp(-0.5 * x * x);
    power += density * a * a;
    total += density;
  }
  return power / total;
}

std::vector<double> ToDouble(const float* from, size_t count) {
  return std::vector<double>(from, from + count);
}
void ToFloat(const std::vector<double>& from, float* to) {
  for (size_t i = 0; i < from.size(); ++i) to[i] = static_cast<float>(from[i]);
}

std::vector<float> DrawNoise(const IlluminationUnetOptions& options) {
  std::vector<float> noise(static_cast<size_t>(options.noise_channels) *
                           options.height * options.width);
  NormalSource normal(options.seed);
  for (float& x : noise) x = normal.Next();
  return noise;
}

}  // namespace

IlluminationUnet::IlluminationUnet(const IlluminationUnetOptions& options)
    : IlluminationUnet(options, DrawNoise(options)) {}

IlluminationUnet::IlluminationUnet(const IlluminationUnetOptions& options,
                                   std::vector<float> noise, SimdLevel level)
    : options_(options),
      plan_(MakeUnetPlan(options)),
      noise_(std::move(noise)),
      engine_(std::make_unique<UnetEngine>(plan_, noise_, options.num_threads,
                                           GetUnetKernels(level))),
      plain_(level != SimdLevel::kDouble
                 ? nullptr
                 : std::make_unique<UnetReference<double>>(
                       plan_, ToDouble(noise_.data(), noise_.size()))) {}

IlluminationUnet::~IlluminationUnet() = default;

std::vector<float> IlluminationUnet::PriorStd() const {
  const double gain = 1.0 / std::sqrt(ActivationPower());
  std::vector<float> deviation(num_weights());
  for (const WeightBlock& block : plan_.blocks) {
    float value;
    if (block.is_bias) {
      value = block.is_output ? kOutputBiasStd : kHiddenBiasStd;
    } else {
      value = static_cast<float>(gain / std::sqrt(block.fan_in)) *
              (block.is_output ? kOutputStd : 1.0f);
    }
    std::fill_n(deviation.begin() + block.offset, block.size, value);
  }
  return deviation;
}

std::vector<float> IlluminationUnet::InitialWeights(uint64_t seed) const {
  std::vector<float> weights = PriorStd();
  NormalSource normal(seed);
  for (const WeightBlock& block : plan_.blocks) {
    for (int i = block.offset; i < block.offset + block.size; ++i) {
      weights[i] = block.is_output ? 0.0f : weights[i] * normal.Next();
    }
  }
  return weights;
}

IlluminationUnet::Workspace::Workspace()
    : buffers_(std::make_unique<UnetBuffers>()) {}
IlluminationUnet::Workspace::~Workspace() = default;
IlluminationUnet::Workspace::Workspace(Workspace&&) noexcept = default;
IlluminationUnet::Workspace& IlluminationUnet::Workspace::operator=(
    Workspace&&) noexcept = default;

void IlluminationUnet::Forward(const float* weights, Workspace* workspace,
                               float* log_radiance) const {
  if (plain_ != nullptr) {
    UnetBuffers& b = *workspace->buffers_;
    b.plain_weights = ToDouble(weights, num_weights());
    b.plain = plain_->Forward(b.plain_weights);
    ToFloat(b.plain.log_radiance(), log_radiance);
    return;
  }
  engine_->Forward(weights, workspace->buffers_.get(), log_radiance);
}

void IlluminationUnet::Jvp(const float* tangent, const Workspace& workspace,
                           Scratch* scratch, float* d_log_radiance) const {
  if (plain_ != nullptr) {
    const UnetBuffers& b = *workspace.buffers_;
    ToFloat(
        plain_->Jvp(b.plain_weights, ToDouble(tangent, num_weights()), b.plain),
        d_log_radiance);
    return;
  }
  engine_->Jvp(tangent, *workspace.buffers_, scratch->buffers_.get(),
               d_log_radiance);
}

void IlluminationUnet::Vjp(const float* adjoint, const Workspace& workspace,
                           Scratch* scratch, float* weight_gradient) const {
  if (plain_ != nullptr) {
    const UnetBuffers& b = *workspace.buffers_;
    ToFloat(
        plain_->Vjp(b.plain_weights, ToDouble(adjoint, num_outputs()), b.plain),
        weight_gradient);
    return;
  }
  engine_->Vjp(adjoint, *workspace.buffers_, scratch->buffers_.get(),
               weight_gradient);
}

}  // namespace ibrdf
