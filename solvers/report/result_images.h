// Images that follow from a problem and its solution.
#pragma once
#include <string>

#include "ibrdf/geometry/camera.h"
#include "ibrdf/image/image.h"
#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/problem/inverse_problem.h"

namespace ibrdf {

// The pixels that a solution renders.
Mask ObjectMask(const InverseProblem& inverse);

// The pixels that a solution is judged by: those whose radiance is known in all
// three channels, from one side at least, and that a known light reaches.
Mask UsedMask(const InverseProblem& inverse);

// The image; where it bounds radiance alone, what is in the bounds and nearest
// to the render.
Image NearestObserved(const InverseProblem& inverse, const Solution& solution);

// log(L_o + epsilon) - log(I + epsilon) with the likelihood's epsilon, I of
// NearestObserved; 0
// outside the object and where the pixel took no part, because other programs
// sum over the file.
Image LogResidual(const InverseProblem& inverse, const Solution& solution);

// A map of the library as pictures show it: in the frame camera.
Image MapForPicture(const Image& map);

// What is in the middle of such a picture: "what the camera looks at", or "-z"
// where that is more than some degrees off.
std::string MiddleOfMapPicture(const Camera& camera);

}  // namespace ibrdf
