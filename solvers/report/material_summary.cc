#include "ibrdf/solvers/report/material_summary.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/base/format.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/geometry/half_diff.h"
#include "ibrdf/solvers/priors/material_prior.h"
#include "ibrdf/solvers/solve/reflectance_spread.h"

namespace ibrdf {
namespace {

constexpr size_t kNearest = 3;
// For names a hundredth of the metric's nodes will do.
constexpr BrdfGridShape kCoarseGrid = {18, 8, 12};

double Luminance(const Eigen::Array3d& rgb) {
  return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

std::vector<NearMaterial> NearestMaterials(const InverseProblem& inverse,
                                           const std::vector<double>& lobes) {
  const LobeLayout layout =
      LobeLayout::OfSize(lobes.size(), inverse.model->shape.code_size());
  const LobeDistance distance(
      FlowLobes::Factory(*inverse.model, layout, inverse.num_threads),
      kCoarseGrid);
  const std::vector<double> found = distance.LogValues(lobes);
  std::vector<NearMaterial> all;
  for (const MaterialPrior::Material& material :
       JointMaterialPrior(*inverse.model, layout, inverse.prior_sigma)
           .materials) {
    if (static_cast<size_t>(material.parameters.size()) != lobes.size()) {
      continue;
    }
    const double difference = distance.Aligned(
        distance.LogValues(ToVector(material.parameters)), found);
    if (std::isfinite(difference)) all.push_back({material.name, difference});
  }
  std::sort(all.begin(), all.end(),
            [](const NearMaterial& a, const NearMaterial& b) {
              return a.brdf_log_difference < b.brdf_log_difference;
            });
  all.resize(std::min(all.size(), kNearest));
  return all;
}

}  // namespace

ReflectanceShares SharesOf(const MerlTable& brdf) {
  constexpr int kThetas = 96, kPhis = 192;
  const Eigen::Vector3d wo(std::sin(kPi / 6), 0.0, std::cos(kPi / 6));
  double albedo = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kThetas; ++i) {
    // Rings of one projected solid angle.
    const double sine = std::sqrt((i + 0.5) / kThetas);
    const double cosine = std::sqrt(1.0 - sine * sine);
    for (int j = 0; j < kPhis; ++j) {
      const double phi = 2.0 * kPi * (j + 0.5) / kPhis;
      const HalfDiff angles =
          ToHalfDiff({sine * std::cos(phi), sine * std::sin(phi), cosine}, wo);
      const double f_r = Luminance(
          InterpolateMerl(brdf, angles.theta_h, angles.theta_d, angles.phi_d));
      albedo += f_r * kPi / (kThetas * kPhis);
      if (cosine >= 0.5) least = std::min(least, f_r);
    }
  }
  if (!(albedo > 0.0) || !std::isfinite(albedo)) return {};
  const double diffuse = std::clamp(kPi * least / albedo, 0.0, 1.0);
  return {diffuse, 1.0 - diffuse};
}

MaterialSummary SummariseMaterial(const InverseProblem& inverse,
                                  const Solution& solution) {
  MaterialSummary summary;
  if (!solution.lobe_parameters.empty()) {
    summary.nearest = NearestMaterials(inverse, solution.lobe_parameters);
  }
  if (solution.brdf.raw.size() == size_t{3} * kMerlBins) {
    summary.shares = SharesOf(solution.brdf);
  }
  return summary;
}

std::string MaterialWords(const MaterialSummary& summary) {
  std::string words;
  for (const NearMaterial& near : summary.nearest) {
    words += (words.empty() ? "Nearest training materials, with the "
                              "difference in the logarithm (root mean square "
                              "over all angles, after the best scale): "
                            : ", ") +
             near.name + " (" + Format("%.2f", near.brdf_log_difference) + ")";
  }
  if (!words.empty()) words += ".";
  if (std::isfinite(summary.shares.diffuse)) {
    words += std::string(words.empty() ? "" : " ") +
             "Of the reflected light, " +
             Format("%.0f %% is diffuse and %.0f %% specular",
                    100.0 * summary.shares.diffuse,
                    100.0 * summary.shares.specular) +
             ", seen from 30 degrees off the normal. Diffuse is here what a "
             "Lambertian surface can have at most of it: pi times the least "
             "BRDF for light within 60 degrees of the normal.";
  }
  return words;
}

}  // namespace ibrdf
