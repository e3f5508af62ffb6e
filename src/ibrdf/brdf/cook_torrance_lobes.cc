#include "ibrdf/brdf/cook_torrance_lobes.h"

#include <algorithm>
#include <memory>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/brdf/sample_merl.h"

namespace ibrdf {
namespace {

// exp(it) is 0: no diffuse part.
constexpr double kLogZero = -1000.0;
// A shape beyond it, 1/sr, is no reflectance: products with it stay floats.
constexpr double kLargestLobe = 1e30;
// The lobes by name.
constexpr int kDiffuse = 0, kSpecular = 1;

}  // namespace

CookTorranceLobes::CookTorranceLobes(const BrdfGridShape& grid, int num_threads)
    : LobeModel(kLayout, grid), num_threads_(num_threads) {
  for (int i = 0; i < grid.num_nodes(); ++i) {
    node_angles_.push_back(grid.NodeAngles(i));
  }
}

LobeFactory CookTorranceLobes::Factory(int num_threads) {
  return [num_threads](const BrdfGridShape& grid) {
    return std::make_unique<CookTorranceLobes>(grid, num_threads);
  };
}

void CookTorranceLobes::Tabulate(const double* parameters, bool derivatives,
                                 std::vector<float>* fields) const {
  const size_t nodes = node_angles_.size();
  const int stride = derivatives ? 1 + kCode : 1;
  fields->assign(nodes * stride * kLobes, 0.0f);
  std::fill_n(fields->begin(), nodes, static_cast<float>(1.0 / kPi));
  float* const lobe = fields->data() + nodes * stride;
  const auto code = Mixture(parameters).code(kSpecular);
  const CookTorranceLog at(kLogZero, 0.0, code[0], code[1]);
  const int rows = grid_shape().h;
  const size_t row = nodes / rows;
  ParallelFor(rows, num_threads_, [&](int64_t h, int) {
    for (size_t i = h * row; i < (h + 1) * row; ++i) {
      const Eigen::Vector3d& a = node_angles_[i];
      Eigen::Vector4d gradient;
      const double value = EvaluateCookTorrance(
          at, a[0], a[1], a[2], derivatives ? &gradient : nullptr);
      lobe[i] = static_cast<float>(std::min(value, kLargestLobe));
      for (int d = 1; d < stride; ++d) {
        lobe[d * nodes + i] =
            value < kLargestLobe ? static_cast<float>(gradient[1 + d]) : 0.0f;
      }
    }
  });
}

MerlTable CookTorranceLobes::ToMerl(const double* parameters) const {
  return SampleMerl(FromParameters(parameters).Function());
}

CookTorrance CookTorranceLobes::FromParameters(const double* parameters) {
  const LobeMixture lobes(kLayout, parameters);
  const auto code = lobes.code(kSpecular);
  CookTorrance brdf;
  for (int c = 0; c < 3; ++c) {
    FromLogParameters({kLogZero, kLogZero, code[0], code[1]}, c, &brdf);
  }
  const Eigen::Array3Xd colours = lobes.Colours();
  brdf.diffuse = colours.col(kDiffuse);
  brdf.specular = colours.col(kSpecular);
  return brdf;
}

std::vector<double> CookTorranceLobes::ToParameters(const CookTorrance& brdf) {
  std::vector<double> parameters(kLayout.num_parameters(), 0.0);
  const MutableLobeMixture lobes(kLayout, parameters.data());
  for (int c = 0; c < 3; ++c) {
    CookTorrance raw = brdf;
    raw.diffuse[c] /= LobeColour(0.0, c);
    raw.specular[c] /= LobeColour(0.0, c);
    const CookTorranceLog log = ToLogParameters(raw, c);
    lobes.log_colour(kDiffuse)[c] = log[0];
    lobes.log_colour(kSpecular)[c] = log[1];
    if (c == 0) lobes.code(kSpecular) << log[2], log[3];
  }
  return parameters;
}

}  // namespace ibrdf
