#include "solvers/trainer/training_data.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include "ibrdf/brdf/brdf_grid.h"
#include "io/merl.h"

namespace ibrdf {
namespace {
constexpr const char* kChannels[3] = {".red", ".green", ".blue"};
}  // namespace

TrainingData TrainingData::Slice(int begin, int end) const {
  TrainingData part;
  part.names = names;
  part.num_points = end - begin;
  const auto copy = [&](const std::vector<float>& from,
                        std::vector<float>* to) {
    for (size_t row = 0; row < from.size() / num_points; ++row) {
      const float* start = from.data() + row * num_points;
      to->insert(to->end(), start + begin, start + end);
    }
  };
  copy(x, &part.x);
  copy(log_raw, &part.log_raw);
  return part;
}

std::vector<int> ShuffledBins(uint64_t seed) {
  std::vector<int> bins;
  for (int i = 0; i < kMerlThetaH; ++i) {
    for (int j = 0; j < kMerlThetaD; ++j) {
      for (int k = 0; k < kMerlPhiD; ++k) {
        if (MerlBinAboveHorizon(i, j, k))
          bins.push_back(MerlTable::Bin(i, j, k));
      }
    }
  }
  std::mt19937_64 rng(seed);
  std::shuffle(bins.begin(), bins.end(), rng);
  return bins;
}

std::vector<float> CubeCoordinates(const std::vector<int>& bins) {
  const size_t n = bins.size();
  std::vector<float> x(3 * n);
  for (size_t p = 0; p < n; ++p) {
    const Eigen::Vector3d cube =
        ToUnitCube(MerlThetaH(bins[p] / (kMerlThetaD * kMerlPhiD)),
                   MerlThetaD(bins[p] / kMerlPhiD % kMerlThetaD),
                   MerlPhiD(bins[p] % kMerlPhiD));
    for (int i = 0; i < 3; ++i) x[i * n + p] = static_cast<float>(cube[i]);
  }
  return x;
}

StatusOr<TrainingData> ReadTrainingData(
    const std::string& folder, const std::vector<std::string>& leave_out,
    int num_points, uint64_t seed) {
  namespace fs = std::filesystem;
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".binary") files.push_back(entry.path());
  }
  if (error) return InvalidInput(folder, "cannot list: " + error.message());
  std::sort(files.begin(), files.end());
  for (const std::string& name : leave_out) {
    const auto found =
        std::find_if(files.begin(), files.end(),
                     [&](const fs::path& f) { return f.stem() == name; });
    if (found == files.end()) {
      return InvalidInput(folder,
                          "has no material '" + name + "' to leave out");
    }
    files.erase(found);
  }
  if (files.empty()) {
    return InvalidInput(folder, "expected MERL .binary files, found none");
  }
  std::vector<int> bins = ShuffledBins(seed);
  bins.resize(std::min<size_t>(bins.size(), num_points));
  TrainingData data;
  data.num_points = static_cast<int>(bins.size());
  data.x = CubeCoordinates(bins);
  data.log_raw.reserve(files.size() * 3 * bins.size());
  for (const fs::path& file : files) {
    const StatusOr<MerlTable> table = ReadMerl(file.string());
    if (!table.ok()) return table.status();
    for (int c = 0; c < 3; ++c) {
      data.names.push_back(file.stem().string() + kChannels[c]);
      for (const int bin : bins) {
        data.log_raw.push_back(static_cast<float>(
            std::log(std::max(table->Raw(c, bin), 0.0) + kLogFloor)));
      }
    }
    LOG_EVERY_N(INFO, 10) << "read " << file.string();
  }
  return data;
}

}  // namespace ibrdf
