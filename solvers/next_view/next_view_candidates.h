// What photographs from other places would show of a problem's object.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/io/calibrated_views.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/next_view/candidate_views.h"
#include "ibrdf/solvers/problem/load_object.h"

namespace ibrdf {

struct NextViewCandidates {
  std::string from;  // LoadCandidates' text
  std::vector<CalibratedView> views;
  // The points of each view, spread over what it sees; empty: it sees nothing.
  // Indices count from 0.
  std::vector<std::vector<ShadingPoint>> points;
  Scene scene = Scene::UnitSphere();
  CandidateSetting setting;
};

// kInvalidInput where next views cannot be chosen for a problem: it must be
// joint, of one material, estimated with the light integrated out, and of a
// shape that can be seen from elsewhere.
Status CheckNextViews(const Problem& problem);

// Candidates as LoadCandidates has them. Refuses those of which none sees the
// object. Checks the problem as well.
StatusOr<NextViewCandidates> LoadNextViewCandidates(
    const Problem& problem, const PhotographedObject& object,
    const std::string& text, int num_threads);

}  // namespace ibrdf
