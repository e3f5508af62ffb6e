// Parameterisations of the unknown map: the deep illumination prior's UNet, or
// free log-radiance texels for the ablation.
#pragma once
#include <memory>
#include <vector>

#include "ibrdf/light/illumination_unet.h"

namespace ibrdf {

// Log radiance [3][H][W] as a function of parameters, with derivative products.
// Linearise() fixes the point at which the products are taken.
class IlluminationModel {
 public:
  virtual ~IlluminationModel() = default;
  virtual int num_parameters() const = 0;
  int width() const { return width_; }
  int height() const { return height_; }
  int num_outputs() const { return 3 * width_ * height_; }

  // A constant map of the given log radiance per channel.
  virtual std::vector<float> ConstantMap(const double* log_radiance) const = 0;
  // Standard deviation of each parameter under its prior, about its mean.
  virtual std::vector<float> PriorStd() const = 0;

  virtual void Forward(const float* parameters, float* log_radiance) = 0;
  virtual void Linearise(const float* parameters, float* log_radiance) = 0;
  virtual void Jvp(const float* tangent, float* d_log_radiance) = 0;
  virtual void Vjp(const float* adjoint, float* gradient) = 0;
  // Adds shift [3] to the log radiance of each channel, exactly.
  virtual void ShiftChannels(const double* shift, float* parameters) const = 0;

 protected:
  IlluminationModel(int width, int height) : width_(width), height_(height) {}

 private:
  const int width_, height_;
};

// exp of planar log radiance [3][H][W] as a map [H, W, 3]; clamped so that
// nothing overflows. slopes, where not null: its derivatives by log radiance
// [H, W, 3], the map's values but 0 where it is clamped.
void ToRadianceMap(const std::vector<float>& log_radiance,
                   std::vector<float>* map,
                   std::vector<float>* slopes = nullptr);

std::unique_ptr<IlluminationModel> MakeUnetIllumination(
    const IlluminationUnetOptions& options);
std::unique_ptr<IlluminationModel> MakeFreeIllumination(int width, int height);

}  // namespace ibrdf
