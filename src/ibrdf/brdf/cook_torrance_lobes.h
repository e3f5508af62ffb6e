// Lambertian plus Cook-Torrance in the place of the flow's lobes.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/brdf/lobe_model.h"

namespace ibrdf {

// Two lobes with codes of two numbers. The first is Lambertian, s = 1 / pi, and
// does not use its code; the second is CookTorrance's with code (log roughness,
// logit f0), the same in all channels.
class CookTorranceLobes final : public LobeModel {
 public:
  static constexpr int kLobes = 2, kCode = 2;
  static constexpr LobeLayout kLayout = {kLobes, kCode};

  CookTorranceLobes(const BrdfGridShape& grid, int num_threads);

  static LobeFactory Factory(int num_threads);

  void Tabulate(const double* parameters, bool derivatives,
                std::vector<float>* fields) const override;
  MerlTable ToMerl(const double* parameters) const override;

  // Parameters in kLayout, and what they stand for. Of `brdf` the
  // second lobe has the red channel's roughness and f0.
  static CookTorrance FromParameters(const double* parameters);
  static std::vector<double> ToParameters(const CookTorrance& brdf);

 private:
  int num_threads_;
  std::vector<Eigen::Vector3d> node_angles_;
};

}  // namespace ibrdf
