// Colour spaces by the CIE 1931 chromaticities of their primaries.
#pragma once
#include <Eigen/Core>
#include <optional>

namespace ibrdf {

// x and y of each.
struct PrimaryColours {
  Eigen::Vector2d red{0.64, 0.33}, green{0.30, 0.60}, blue{0.15, 0.06};
  Eigen::Vector2d white{0.3127, 0.3290};
  // The defaults are Rec. 709 (ITU-R BT.709-6, Table 1).
};

// Whether all coordinates are within 1e-3, as numbers of three digits are.
bool AreSamePrimaries(const PrimaryColours& a, const PrimaryColours& b);

// Linear RGB -> CIE XYZ; RGB 1 1 1 has luminance Y = 1 and the white's
// chromaticity (SMPTE RP 177). Absent where the primaries span no space.
std::optional<Eigen::Matrix3d> RgbToXyz(const PrimaryColours& primaries);

// Linear RGB of `primaries` -> that of Rec. 709 with the same XYZ. The white
// is not adapted, as in OpenEXR: equal energy stays equal energy.
std::optional<Eigen::Matrix3d> RgbToRec709(const PrimaryColours& primaries);

}  // namespace ibrdf
