// Parameterisations of the unknown map: the deep illumination prior's UNet, or
// free log-radiance texels for the ablation.
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "ibrdf/light/illumination_unet.h"
#include "ibrdf/light/log_map.h"
#include "ibrdf/solvers/illumination/light_preconditioner.h"

namespace ibrdf {

// Log radiance as a function of parameters, with derivative products.
// Linearise() fixes the point at which the products are taken. Maps that are
// written take this size.
class IlluminationModel {
 public:
  virtual ~IlluminationModel() = default;
  virtual int num_parameters() const = 0;
  MapSize size() const { return size_; }
  int width() const { return size_.width; }
  int height() const { return size_.height; }
  int num_outputs() const { return 3 * static_cast<int>(size_.num_texels()); }

  // A constant map of the given log radiance per channel.
  virtual std::vector<float> ConstantMap(const double* log_radiance) const = 0;
  // Standard deviation of each parameter under its prior, about its mean.
  virtual std::vector<float> PriorStd() const = 0;

  virtual void Forward(const float* parameters, LogMap* log_map) = 0;
  virtual void Linearise(const float* parameters, LogMap* log_map) = 0;
  virtual void Jvp(const float* tangent, LogMap* d_log_map) = 0;
  virtual void Vjp(const LogMap& adjoint, float* gradient) = 0;
  // For Gauss-Newton steps; `rows` are asked for only where there is one. Null:
  // none is known.
  virtual std::unique_ptr<LightPreconditioner> Preconditioner(
      const std::function<InformationRows()>& rows) const {
    (void)rows;
    return nullptr;
  }
  // Adds shift [3] to the log radiance of each channel, exactly.
  virtual void ShiftChannels(const double* shift, float* parameters) const = 0;

 protected:
  explicit IlluminationModel(MapSize size) : size_(size) {}

 private:
  const MapSize size_;
};

std::unique_ptr<IlluminationModel> MakeUnetIllumination(
    const IlluminationUnetOptions& options);
std::unique_ptr<IlluminationModel> MakeFreeIllumination(int width, int height);

}  // namespace ibrdf
