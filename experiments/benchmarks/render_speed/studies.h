// The studies of render_speed, each printing its rows of results.csv:
// study,case,quantity,value.
#pragma once
#include <string>

namespace ibrdf {

// One row.
void Row(const std::string& study, const std::string& what,
         const std::string& quantity, double value);

// RenderByNormal against rendering every point: seconds and errors.
void MapStudy(const std::string& meshes);
// Shadow rays a microsecond, one thread: the library's and Embree's own.
void RayStudy(const std::string& meshes);

// BRDF-light pairs a second of Transport and LightOperator, one thread, beside
// a stream through memory.
void PairStudy(const std::string& meshes);

// Seconds to 1 % of the reference for settings of Transport's quadrature.
void OnePercentStudy(const std::string& meshes);

// Errors of HarmonicTransport by order, found and predicted, and its speed.
void HarmonicStudy(const std::string& meshes);

// Errors and milliseconds of an image by quadrature, by normal, in harmonics
// and in Gaussians.
void GaussianStudy(const std::string& meshes);

}  // namespace ibrdf
