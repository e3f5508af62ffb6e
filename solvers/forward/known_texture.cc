#include "ibrdf/solvers/forward/known_texture.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "ibrdf/base/format.h"
#include "ibrdf/image/response_curve.h"
#include "ibrdf/image/texture_sampling.h"
#include "ibrdf/io/photo_file.h"
#include "ibrdf/io/problem_schema.h"
#include "ibrdf/solvers/problem/load_scene.h"

namespace ibrdf {
namespace {

// Grey files of other programs differ by a code of 8 bits between channels.
constexpr float kSameGrey = 1.5f / 255.0f;

std::string KeyOf(const std::string& name) {
  return "reflectance.known.principled." + name;
}

Image OneTexel(const Eigen::Array3d& value) {
  Image image(1, 1);
  Eigen::Map<Eigen::Array3f>(image.At(0, 0)) = value.cast<float>();
  return image;
}

// Codes to [0, 1].
void Decode(bool colour, Photo* photo) {
  if (photo->bits == 0) return;
  const auto white = static_cast<float>((1u << photo->bits) - 1u);
  ResponseDefinition curve;
  curve.kind = ResponseKind::kSrgb;
  const ResponseCurve srgb(curve);
  for (float& v : photo->image.rgb) {
    v /= white;
    if (colour) v = static_cast<float>(srgb.Decode(v));
  }
}

Status CheckValues(const std::string& file, const std::string& name,
                   const Image& texture, bool colour) {
  const Range& range = ProblemFileSchema().Key(KeyOf(name)).range;
  for (size_t i = 0; i < texture.num_pixels(); ++i) {
    const float* const v = &texture.rgb[3 * i];
    for (int c = 0; c < 3; ++c) {
      if (v[c] >= range.low && v[c] <= range.high) continue;
      return InvalidInput(file + ": " + KeyOf(name),
                          "expected values in " + IntervalText(range) +
                              ", found " + Format("%g", v[c]));
    }
    if (colour || (std::abs(v[0] - v[1]) <= kSameGrey &&
                   std::abs(v[0] - v[2]) <= kSameGrey)) {
      continue;
    }
    return InvalidInput(file + ": " + KeyOf(name),
                        "expected a grey texture, found the colour " +
                            Format("%g, %g, %g", v[0], v[1], v[2]));
  }
  return OkStatus();
}

StatusOr<Image> LoadValue(const SurfaceValue& value, const std::string& name,
                          bool colour) {
  if (value.texture.empty()) return OneTexel(value.value);
  StatusOr<Photo> photo = ReadPhoto(value.texture);
  if (!photo.ok()) return photo.status();
  Decode(colour, &*photo);
  IBRDF_RETURN_IF_ERROR(CheckValues(value.texture, name, photo->image, colour));
  return std::move(photo->image);
}

}  // namespace

StatusOr<KnownTexture> KnownTexture::Load(const PrincipledSpec& spec,
                                          bool wrap_u) {
  KnownTexture out;
  out.wrap_u_ = wrap_u;
  const struct {
    const SurfaceValue& value;
    const char* name;
    bool colour;
    Image* image;
  } parts[] = {{spec.base, "base", true, &out.base_},
               {spec.roughness, "roughness", false, &out.roughness_},
               {spec.metallic, "metallic", false, &out.metallic_},
               {spec.specular, "specular", false, &out.specular_}};
  for (const auto& part : parts) {
    StatusOr<Image> image = LoadValue(part.value, part.name, part.colour);
    if (!image.ok()) return image.status();
    *part.image = *std::move(image);
  }
  return out;
}

Disney KnownTexture::At(const Eigen::Vector2f& uv) const {
  Disney brdf;
  brdf.base = SampleTexture(base_, uv, wrap_u_).cast<double>();
  brdf.roughness = std::max(double{SampleTexture(roughness_, uv, wrap_u_)[0]},
                            kMinRoughness);
  brdf.metallic = SampleTexture(metallic_, uv, wrap_u_)[0];
  brdf.specular = SampleTexture(specular_, uv, wrap_u_)[0];
  return brdf;
}

Disney KnownTexture::Mean(const std::vector<ShadingPoint>& points) const {
  Disney mean;
  mean.base.setZero();
  mean.roughness = mean.metallic = mean.specular = 0.0;
  const double share = 1.0 / static_cast<double>(points.size());
  for (const ShadingPoint& point : points) {
    const Disney here = At(point.texture);
    mean.base += share * here.base;
    mean.roughness += share * here.roughness;
    mean.metallic += share * here.metallic;
    mean.specular += share * here.specular;
  }
  return mean;
}

Disney KnownTexture::Sharpest(const std::vector<ShadingPoint>& points) const {
  Disney sharpest = At(points[0].texture);
  for (const ShadingPoint& point : points) {
    const Disney here = At(point.texture);
    if (here.roughness < sharpest.roughness) sharpest = here;
  }
  return sharpest;
}

SurfaceBrdf KnownTexture::Brdf() const {
  return [this](const ShadingPoint& point) {
    return At(point.texture).Function();
  };
}

}  // namespace ibrdf
