#include "ibrdf/solvers/illumination/illumination_model.h"

#include <algorithm>

#include "ibrdf/solvers/illumination/natural_noise.h"

namespace ibrdf {
namespace {

// The biases of the last layer carry the level of the map: no prior to speak
// of.
constexpr float kBiasStd = 10.0f;
// Free texels: log radiance of natural light spreads over a few units.
constexpr float kTexelStd = 3.0f;

class UnetIllumination final : public IlluminationModel {
 public:
  explicit UnetIllumination(const IlluminationUnetOptions& options)
      : IlluminationModel({options.width, options.height}),
        unet_(options, NaturalNoise(options)) {}

  int num_parameters() const override { return unet_.num_weights(); }

  std::vector<float> ConstantMap(const double* log_radiance) const override {
    std::vector<float> weights = unet_.InitialWeights(unet_.options().seed);
    ShiftChannels(log_radiance, weights.data());
    return weights;
  }

  std::vector<float> PriorStd() const override {
    std::vector<float> std = unet_.PriorStd();
    std::fill(std.end() - 3, std.end(), kBiasStd);
    return std;
  }

  void Forward(const float* parameters, LogMap* log_map) override {
    log_map->Reshape(size());
    unet_.Forward(parameters, &scratch_, log_map->data());
  }
  void Linearise(const float* parameters, LogMap* log_map) override {
    log_map->Reshape(size());
    unet_.Forward(parameters, &workspace_, log_map->data());
  }
  void Jvp(const float* tangent, LogMap* d_log_map) override {
    d_log_map->Reshape(size());
    unet_.Jvp(tangent, workspace_, &scratch_, d_log_map->data());
  }
  void Vjp(const LogMap& adjoint, float* gradient) override {
    unet_.Vjp(adjoint.data(), workspace_, &scratch_, gradient);
  }
  void ShiftChannels(const double* shift, float* parameters) const override {
    for (int c = 0; c < 3; ++c) {
      parameters[num_parameters() - 3 + c] += static_cast<float>(shift[c]);
    }
  }

 private:
  IlluminationUnet unet_;
  IlluminationUnet::Workspace workspace_;
  IlluminationUnet::Scratch scratch_;
};

class FreeIllumination final : public IlluminationModel {
 public:
  explicit FreeIllumination(MapSize size) : IlluminationModel(size) {}

  int num_parameters() const override { return num_outputs(); }

  std::vector<float> ConstantMap(const double* log_radiance) const override {
    std::vector<float> texels(num_outputs(), 0.0f);
    ShiftChannels(log_radiance, texels.data());
    return texels;
  }
  std::vector<float> PriorStd() const override {
    return std::vector<float>(num_outputs(), kTexelStd);
  }
  void Forward(const float* parameters, LogMap* log_map) override {
    log_map->Reshape(size());
    std::copy(parameters, parameters + num_outputs(), log_map->data());
  }
  void Linearise(const float* parameters, LogMap* log_map) override {
    Forward(parameters, log_map);
  }
  void Jvp(const float* tangent, LogMap* d_log_map) override {
    Forward(tangent, d_log_map);
  }
  void Vjp(const LogMap& adjoint, float* gradient) override {
    std::copy(adjoint.values().begin(), adjoint.values().end(), gradient);
  }
  void ShiftChannels(const double* shift, float* parameters) const override {
    const int texels = num_outputs() / 3;
    for (int i = 0; i < num_outputs(); ++i) {
      parameters[i] += static_cast<float>(shift[i / texels]);
    }
  }
};

}  // namespace

std::unique_ptr<IlluminationModel> MakeUnetIllumination(
    const IlluminationUnetOptions& options) {
  return std::make_unique<UnetIllumination>(options);
}

std::unique_ptr<IlluminationModel> MakeFreeIllumination(int width, int height) {
  return std::make_unique<FreeIllumination>(MapSize{width, height});
}

}  // namespace ibrdf
