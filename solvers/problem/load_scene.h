// The known parts of a problem: its shape, light and reflectance.
#pragma once
#include "ibrdf/base/status.h"
#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/image/image.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/scene/scene.h"

namespace ibrdf {

// The geometry of a problem; reads its mesh or normal map.
StatusOr<Scene> LoadScene(const GeometrySpec& geometry);

// The known illumination: the file as it is, or the sky made into a map of the
// problem's size. Refuses values that are negative or not finite.
StatusOr<Image> LoadKnownIllumination(const IlluminationSpec& illumination);

// The known reflectance as a table: the file, or the analytic BRDF at the bin
// centres.
StatusOr<MerlTable> LoadKnownReflectance(const ReflectanceSpec& reflectance);

}  // namespace ibrdf
