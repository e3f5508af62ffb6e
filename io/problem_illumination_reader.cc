// The reader of the section `illumination`.
#include <algorithm>

#include "ibrdf/io/problem_section_readers.h"

namespace ibrdf {
namespace {
using Kind = ConfigNode::Kind;

void ReadSky(ProblemReader known, SkyOptions* sky) {
  if (!known.Has("sky")) {
    known.Fail("expected a file or sky");
    return;
  }
  ProblemReader reader = known.Below("sky");
  reader.Read("sun_theta_degrees", &sky->sun_theta_degrees);
  reader.Read("sun_phi_degrees", &sky->sun_phi_degrees);
  reader.Read("sun_radius_degrees", &sky->sun_radius_degrees);
  reader.Read("sun_irradiance", &sky->sun_irradiance);
  reader.Read("zenith_radiance", &sky->zenith_radiance);
  reader.Read("haze", &sky->haze);
  reader.Read("clouds", &sky->clouds);
  reader.Read("skyline", &sky->skyline);
  reader.Read("ground_albedo", &sky->ground_albedo);
}

// One side alone sets the other: the map is twice as wide as high.
void ReadMapSize(ProblemReader* reader, IlluminationSpec* illumination) {
  reader->Read("width", &illumination->width);
  illumination->sized = reader->Has("width") || reader->Has("height");
  if (reader->Has("width") && !reader->Has("height")) {
    illumination->height = illumination->width / 2;
  }
  reader->Read("height", &illumination->height);
  if (reader->Has("height") && !reader->Has("width")) {
    const int most = static_cast<int>(reader->Key("width").most);
    illumination->width = std::min(2 * illumination->height, most);
  }
  if (illumination->width % 2 != 0) {
    reader->FailExpected("width", "an even number");
  }
}

}  // namespace

void ReadIllumination(ProblemReader reader, IlluminationSpec* illumination) {
  ReadMapSize(&reader, illumination);
  illumination->prior = IlluminationPrior::kAuto;
  reader.Read("prior", &illumination->prior);
  if (illumination->prior == IlluminationPrior::kAuto &&
      reader.Has("unet_channels")) {
    illumination->prior = IlluminationPrior::kUNet;
  }
  reader.Read("unet_channels", &illumination->unet_channels);
  reader.CheckNeeds("unet_channels",
                    illumination->prior == IlluminationPrior::kUNet);
  reader.Read("frame", &illumination->frame);
  reader.Read("output_frame", &illumination->output_frame);
  const ConfigNode* known = reader.Find("known");
  reader.CheckNeeds("frame", known != nullptr);
  reader.Read("ambient", &illumination->ambient);
  reader.CheckNeeds("ambient", known != nullptr);
  if (known == nullptr) return;
  if (known->kind == Kind::kMap) {
    if (reader.Has("frame")) {
      reader.Fail("frame", "expected with the file of a known map only");
    }
    illumination->sky.emplace();
    ReadSky(reader.Below("known"), &*illumination->sky);
  } else {
    reader.Read("known", &illumination->known_file);
  }
}

void SettlePrior(const SolverSpec& solver, IlluminationSpec* illumination) {
  if (illumination->prior != IlluminationPrior::kAuto) return;
  const bool large =
      std::max(illumination->width, illumination->height) > kMaxProcessSide;
  const bool network = large || solver.estimator == SolverEstimator::kMaximum;
  illumination->prior = network && !illumination->known()
                            ? IlluminationPrior::kUNet
                            : IlluminationPrior::kProcess;
}

}  // namespace ibrdf
