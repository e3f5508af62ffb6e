// What a problem file's quadrature level stands for.
#pragma once
#include "ibrdf/io/problem.h"
#include "ibrdf/transport/quadrature.h"

namespace ibrdf {

// `standard` with half, all or twice its half-vectors and with a map's blocks
// of texels twice, as or half as wide.
QuadratureOptions AtLevel(QuadratureOptions standard, QuadratureLevel level);

}  // namespace ibrdf
