#include "ibrdf/brdf/table_lobes.h"

#include <memory>

#include "ibrdf/brdf/sample_merl.h"

namespace ibrdf {
namespace {

constexpr int kChannels = 3;
// exp(it) is 0.
constexpr double kBlack = -1000.0;

}  // namespace

TableLobes::TableLobes(const BrdfGrid& brdf, const BrdfGridShape& grid)
    : LobeModel({kChannels, 0}, grid),
      shapes_(size_t{kChannels} * grid.num_nodes()) {
  const size_t nodes = grid.num_nodes();
  for (size_t i = 0; i < nodes; ++i) {
    const Eigen::Vector3d a = grid.NodeAngles(static_cast<int>(i));
    const Eigen::Array3d f = brdf.Evaluate(a[0], a[1], a[2]);
    for (int c = 0; c < kChannels; ++c) {
      shapes_[c * nodes + i] = static_cast<float>(f[c] / LobeColour(0.0, c));
    }
  }
}

LobeFactory TableLobes::Factory(const BrdfGrid& brdf) {
  return [&brdf](const BrdfGridShape& grid) {
    return std::make_unique<TableLobes>(brdf, grid);
  };
}

void TableLobes::Tabulate(const double*, bool,
                          std::vector<float>* fields) const {
  *fields = shapes_;
}

MerlTable TableLobes::ToMerl(const double* parameters) const {
  const BrdfGrid grid = Grid(parameters);
  return SampleMerl([&](double theta_h, double theta_d, double phi_d) {
    return grid.Evaluate(theta_h, theta_d, phi_d);
  });
}

std::vector<double> TableLobes::KnownParameters() {
  constexpr LobeLayout kLayout = {kChannels, 0};
  std::vector<double> parameters(kLayout.num_parameters(), kBlack);
  const MutableLobeMixture lobes(kLayout, parameters.data());
  for (int c = 0; c < kChannels; ++c) lobes.log_colour(c)[c] = 0.0;
  return parameters;
}

}  // namespace ibrdf
