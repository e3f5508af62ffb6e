// What rendering costs, part by part.
// usage: render_speed MESHES STUDY...
#include <cstdio>
#include <functional>
#include <map>
#include <string>

#include "experiments/benchmarks/render_speed/studies.h"

namespace ibrdf {

void Row(const std::string& study, const std::string& what,
         const std::string& quantity, double value) {
  std::printf("%s,%s,%s,%.4g\n", study.c_str(), what.c_str(), quantity.c_str(),
              value);
  std::fflush(stdout);
}

}  // namespace ibrdf

int main(int argc, char** argv) {
  const std::map<std::string, std::function<void(const std::string&)>> studies =
      {{"rays", ibrdf::RayStudy},
       {"pairs", ibrdf::PairStudy},
       {"one_percent", ibrdf::OnePercentStudy},
       {"maps", ibrdf::MapStudy},
       {"harmonics", ibrdf::HarmonicStudy},
       {"gaussians", ibrdf::GaussianStudy}};
  if (argc < 3) {
    std::fprintf(stderr, "usage: render_speed MESHES STUDY...; studies:");
    for (const auto& study : studies) {
      std::fprintf(stderr, " %s", study.first.c_str());
    }
    std::fprintf(stderr, "\n");
    return 2;
  }
  std::printf("study,case,quantity,value\n");
  for (int k = 2; k < argc; ++k) {
    const auto study = studies.find(argv[k]);
    if (study == studies.end()) {
      std::fprintf(stderr, "no study named %s\n", argv[k]);
      return 2;
    }
    study->second(argv[1]);
  }
}
