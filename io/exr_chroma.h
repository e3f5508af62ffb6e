// OpenEXR's luminance and chroma (ImfRgbaYca.h).
#pragma once
#include <Eigen/Core>
#include <vector>

namespace ibrdf {

// Fills in chroma that every second column and row has, beginning with the
// first: [ceil(height / 2) * ceil(width / 2)] -> [height * width]. The 27-tap
// filter of OpenEXR's reconstructChromaHoriz and -Vert; edges are repeated.
std::vector<float> UpsampleChroma(const std::vector<float>& chroma, int width,
                                  int height);

// RY = (R - Y) / Y, BY = (B - Y) / Y, Y = weights . (R, G, B); weights sum
// to 1. The result does not alias the arguments, which are values.
void LuminanceChromaToRgb(float y, float ry, float by,
                          const Eigen::Vector3d& weights, float* rgb);

}  // namespace ibrdf
