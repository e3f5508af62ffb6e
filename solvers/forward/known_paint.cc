#include "ibrdf/solvers/forward/known_paint.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "ibrdf/base/format.h"
#include "ibrdf/brdf/matte_split.h"
#include "ibrdf/brdf/sample_merl.h"
#include "ibrdf/io/albedo_file.h"
#include "ibrdf/metrics/albedo.h"

namespace ibrdf {
namespace {

Status Refuse(const std::string& file, const std::string& what) {
  return InvalidInput(file + ": reflectance.known.albedo", what);
}

Status CheckAlbedo(const std::string& file, const Image& albedo,
                   const Mask& mask) {
  if (albedo.width != mask.width || albedo.height != mask.height) {
    return Refuse(file, "expected the render's size, " +
                            SizeName(mask.width, mask.height) + ", found " +
                            SizeName(albedo.width, albedo.height));
  }
  for (size_t k = 0; k < albedo.rgb.size(); ++k) {
    const float a = albedo.rgb[k];
    if (!mask.Holds(k / 3) || (std::isfinite(a) && a >= 0.0f)) continue;
    const int pixel = static_cast<int>(k / 3);
    return Refuse(file, "expected finite values >= 0, found " +
                            Format("%g", a) + " at pixel (" +
                            std::to_string(pixel % mask.width) + ", " +
                            std::to_string(pixel / mask.width) + ")");
  }
  return OkStatus();
}

Eigen::Map<Eigen::Array3f> At(Image* image, int x, int y) {
  return Eigen::Map<Eigen::Array3f>(image->At(x, y));
}

// Pixels that some of their samples see.
std::vector<int> RimPixels(const std::vector<ShadingPoint>& points,
                           const Mask& mask) {
  std::vector<int> samples(mask.inside.size(), 0);
  for (const ShadingPoint& point : points) ++samples[point.pixel];
  const int all = *std::max_element(samples.begin(), samples.end());
  std::vector<int> rim;
  for (size_t i = 0; i < samples.size(); ++i) {
    if (samples[i] > 0 && samples[i] < all) rim.push_back(static_cast<int>(i));
  }
  return rim;
}

// Rim pixels of 0 take the mean of those around them that are not.
void FillRim(const std::vector<int>& rim, Image* albedo) {
  const Image before = *albedo;
  for (const int pixel : rim) {
    const int x = pixel % albedo->width, y = pixel / albedo->width;
    if ((At(albedo, x, y) != 0.0f).any()) continue;
    Eigen::Array3f sum = Eigen::Array3f::Zero();
    int count = 0;
    for (int v = std::max(y - 1, 0); v < std::min(y + 2, albedo->height); ++v) {
      for (int u = std::max(x - 1, 0); u < std::min(x + 2, albedo->width);
           ++u) {
        const Eigen::Map<const Eigen::Array3f> a(before.At(u, v));
        if (!a.isFinite().all() || (a <= 0.0f).all()) continue;
        sum += a;
        ++count;
      }
    }
    if (count > 0) At(albedo, x, y) = sum / static_cast<float>(count);
  }
}

// Divides by `unpainted`, and takes mean and count over the object's pixels.
void SetFactor(Image albedo, const Eigen::Array3d& unpainted, const Mask& mask,
               KnownPaint* paint) {
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (int y = 0; y < albedo.height; ++y) {
    for (int x = 0; x < albedo.width; ++x) {
      Eigen::Map<Eigen::Array3f> a = At(&albedo, x, y);
      if (mask.inside[static_cast<size_t>(y) * albedo.width + x] == 0) {
        a.setZero();
        continue;
      }
      paint->pixels_without += (a == 0.0f).all();
      const Eigen::Array3d factor = a.cast<double>() / unpainted;
      a = factor.cast<float>();
      sum += factor;
    }
  }
  paint->mean = sum / static_cast<double>(mask.CountInside());
  paint->factor = std::move(albedo);
}

}  // namespace

BrdfGrid KnownPaint::MeanGrid(const KnownBrdf& brdf) const {
  BrdfGrid grid = brdf.Grid();
  const BrdfGrid part = MattePart(grid);
  for (int c = 0; c < 3; ++c) {
    const auto more = static_cast<float>(mean[c] - 1.0);
    for (int i = 0; i < grid.shape.num_nodes(); ++i) {
      grid.Channel(c)[i] += more * part.Channel(c)[i];
    }
  }
  return grid;
}

MerlTable KnownPaint::MeanTable(const KnownBrdf& brdf) const {
  MerlTable table = brdf.function ? SampleMerl(brdf.function) : brdf.table;
  for (int c = 0; c < 3; ++c) {
    for (int bin = 0; bin < kMerlBins; ++bin) {
      double& raw = table.raw[static_cast<size_t>(c) * kMerlBins + bin];
      if (raw < 0.0 || matte.table.Raw(c, bin) < 0.0) continue;
      raw = std::max(raw + (mean[c] - 1.0) * matte.table.Raw(c, bin), 0.0);
    }
  }
  return table;
}

StatusOr<KnownPaint> LoadKnownPaint(const PaintSpec& spec,
                                    const std::vector<ShadingPoint>& points,
                                    const Mask& mask, const KnownBrdf& brdf) {
  StatusOr<Image> albedo = ReadAlbedo(spec.albedo);
  if (!albedo.ok()) return albedo.status();
  IBRDF_RETURN_IF_ERROR(CheckAlbedo(spec.albedo, *albedo, mask));
  FillRim(RimPixels(points, mask), &*albedo);
  const BrdfGrid matte = MattePart(brdf.Grid());
  const Eigen::Array3d unpainted = spec.unpainted_albedo.has_value()
                                       ? *spec.unpainted_albedo
                                       : MatteAlbedo(matte);
  if (!(unpainted.minCoeff() > 0.0)) {
    return Refuse(spec.albedo,
                  "expected a BRDF whose matte part is above 0 in every "
                  "channel, or reflectance.known.unpainted_albedo");
  }
  KnownPaint paint;
  SetFactor(*std::move(albedo), unpainted, mask, &paint);
  paint.matte.table =
      SampleMerl([&](double theta_h, double theta_d, double phi_d) {
        return matte.Evaluate(theta_h, theta_d, phi_d);
      });
  return paint;
}

void AddPaint(const KnownPaint& paint, const std::vector<ShadingPoint>& points,
              const std::vector<double>& matte, double* whole) {
  for (size_t i = 0; i < points.size(); ++i) {
    const float* const a = &paint.factor.rgb[size_t{3} * points[i].pixel];
    for (int c = 0; c < 3; ++c) {
      double& L = whole[3 * i + c];
      L = std::max(L + (a[c] - 1.0) * matte[3 * i + c], 0.0);
    }
  }
}

}  // namespace ibrdf
