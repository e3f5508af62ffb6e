#include "ibrdf/brdf/lobe_mixture.h"

#include <algorithm>
#include <cmath>

#include "ibrdf/brdf/merl_table.h"

namespace ibrdf {

double RawLobeColour(double log_colour) {
  return std::exp(std::min(log_colour, kMaxLogColour));
}

double LobeColour(double log_colour, int channel) {
  return RawLobeColour(log_colour) * kMerlScale[channel];
}

Eigen::Array3Xd LobeMixture::Colours() const {
  Eigen::Array3Xd colours(3, num_lobes());
  for (int k = 0; k < num_lobes(); ++k) {
    for (int c = 0; c < 3; ++c) colours(c, k) = LobeColour(log_colour(k)[c], c);
  }
  return colours;
}

Eigen::Array3Xd LobeMixture::RawColours() const {
  Eigen::Array3Xd colours(3, num_lobes());
  for (int k = 0; k < num_lobes(); ++k) {
    for (int c = 0; c < 3; ++c) colours(c, k) = RawLobeColour(log_colour(k)[c]);
  }
  return colours;
}

Eigen::Array3Xd LobeMixture::ColourSlopes() const {
  Eigen::Array3Xd slopes = Colours();
  for (int k = 0; k < num_lobes(); ++k) {
    for (int c = 0; c < 3; ++c) {
      if (!(log_colour(k)[c] < kMaxLogColour)) slopes(c, k) = 0.0;
    }
  }
  return slopes;
}

void MutableLobeMixture::ShiftColours(const Eigen::Array3d& shift) const {
  for (int k = 0; k < num_lobes(); ++k) log_colour(k) += shift;
}

void MutableLobeMixture::ClampCodes() const {
  for (int k = 0; k < layout().num_coded(); ++k) {
    code(k) /= std::max(code(k).norm(), 1.0);
  }
}

}  // namespace ibrdf
