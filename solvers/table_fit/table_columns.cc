#include "ibrdf/solvers/table_fit/table_columns.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/brdf/void_bins.h"
#include "ibrdf/io/merl.h"

namespace ibrdf {
namespace {

constexpr const char* kChannels[3] = {".red", ".green", ".blue"};

int CountAboveHorizon(int theta_d, int phi_d) {
  int count = 0;
  while (count < kMerlThetaH && MerlBinAboveHorizon(count, theta_d, phi_d)) {
    ++count;
  }
  return count;
}

struct TableFile {
  const TableFolder* folder;
  std::string name;  // without extension
};

// In the order of folders, then of names.
StatusOr<std::vector<TableFile>> ListTableFiles(
    const std::vector<TableFolder>& folders,
    const std::vector<std::string>& leave_out) {
  std::vector<TableFile> files;
  const auto find = [&files](const std::string& name) {
    return std::find_if(files.begin(), files.end(),
                        [&](const TableFile& f) { return f.name == name; });
  };
  std::string paths;
  for (const TableFolder& folder : folders) {
    paths += (paths.empty() ? "" : ", ") + folder.path;
    const StatusOr<std::vector<std::string>> names = ListTables(folder.path);
    if (!names.ok()) return names.status();
    for (const std::string& name : *names) {
      if (find(name) != files.end()) {
        return InvalidInput(
            folder.path, "has a material '" + name + "' as another folder has");
      }
      files.push_back({&folder, name});
    }
  }
  for (const std::string& name : leave_out) {
    const auto found = find(name);
    if (found == files.end()) {
      return InvalidInput(paths, "has no material '" + name + "' to leave out");
    }
    files.erase(found);
  }
  if (files.empty()) {
    return InvalidInput(paths, "expected MERL .binary files, found none");
  }
  return files;
}

}  // namespace

TrainingData TrainingData::Slice(int begin, int end) const {
  CHECK(0 <= begin && begin <= end && end <= num_columns());
  TrainingData part;
  part.names = names;
  part.columns = FlowColumns(end - begin, columns.points);
  part.count.assign(count.begin() + begin, count.begin() + end);
  for (int c = begin; c < end; ++c) {
    part.columns.CopyColumn(c - begin, columns, c);
    for (int i = 0; i < columns.points; ++i) {
      part.columns.x_h[i * (end - begin) + c - begin] =
          columns.x_h[i * num_columns() + c];
    }
  }
  for (int m = 0; m < static_cast<int>(names.size()); ++m) {
    part.log_raw.insert(part.log_raw.end(), LogRaw(m, begin), LogRaw(m, end));
  }
  return part;
}

TrainingData TrainingData::Select(const std::vector<int>& distributions) const {
  TrainingData part;
  part.columns = columns;
  part.count = count;
  for (const int m : distributions) {
    part.names.push_back(names[m]);
    part.log_raw.insert(part.log_raw.end(), LogRaw(m, 0),
                        LogRaw(m, num_columns()));
  }
  return part;
}

std::vector<int> DrawColumns(int count, uint64_t seed) {
  const int all = kMerlThetaD * kMerlPhiD;
  // Exponential races: the first to arrive at rates by the number of bins.
  std::mt19937_64 rng(seed);
  std::exponential_distribution<double> wait;
  std::vector<std::pair<double, int>> arrivals(all);
  for (int c = 0; c < all; ++c) {
    const int bins = CountAboveHorizon(c / kMerlPhiD, c % kMerlPhiD);
    arrivals[c] = {wait(rng) / (bins + 1e-9), c};
  }
  std::sort(arrivals.begin(), arrivals.end());
  std::vector<int> columns;
  for (int i = 0; i < std::min(count, all); ++i) {
    columns.push_back(arrivals[i].second);
  }
  return columns;
}

TrainingData ColumnsOfTable(const std::vector<int>& columns) {
  TrainingData data;
  const int n = static_cast<int>(columns.size());
  data.columns = FlowColumns(n, kMerlThetaH);
  for (int c = 0; c < n; ++c) {
    const int theta_d = columns[c] / kMerlPhiD, phi_d = columns[c] % kMerlPhiD;
    data.count.push_back(CountAboveHorizon(theta_d, phi_d));
    for (int i = 0; i < kMerlThetaH; ++i) {
      const Eigen::Vector3d x =
          ToUnitCube(MerlThetaH(i), MerlThetaD(theta_d), MerlPhiD(phi_d));
      if (i == 0) data.columns.SetColumn(c, x[1], x[2]);
      data.columns.x_h[static_cast<size_t>(i) * n + c] =
          std::min(static_cast<float>(x[0]), 1.0f);
    }
  }
  return data;
}

void AddTable(const MerlTable& table, const std::vector<int>& columns,
              const std::string& name, TrainingData* data) {
  for (int c = 0; c < 3; ++c) {
    data->names.push_back(name + kChannels[c]);
    for (const int column : columns) {
      for (int i = 0; i < kMerlThetaH; ++i) {
        const double raw = table.Raw(c, i * kMerlThetaD * kMerlPhiD + column);
        data->log_raw.push_back(
            raw < 0.0 ? kNotMeasured
                      : static_cast<float>(std::log(raw + kLogFloor)));
      }
    }
  }
}

StatusOr<std::vector<std::string>> ListTables(const std::string& folder) {
  namespace fs = std::filesystem;
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".binary") {
      names.push_back(entry.path().stem().string());
    }
  }
  if (error) return InvalidInput(folder, "cannot list: " + error.message());
  if (names.empty()) {
    return InvalidInput(folder, "expected MERL .binary files, found none");
  }
  std::sort(names.begin(), names.end());
  return names;
}

StatusOr<TrainingData> ReadTrainingData(
    const std::vector<TableFolder>& folders,
    const std::vector<std::string>& leave_out, int num_columns, uint64_t seed) {
  const StatusOr<std::vector<TableFile>> files =
      ListTableFiles(folders, leave_out);
  if (!files.ok()) return files.status();
  const std::vector<int> columns = DrawColumns(num_columns, seed);
  TrainingData data = ColumnsOfTable(columns);
  data.log_raw.reserve(files->size() * 3 * columns.size() * kMerlThetaH);
  for (const TableFile& file : *files) {
    const std::string path =
        (std::filesystem::path(file.folder->path) / (file.name + ".binary"))
            .string();
    StatusOr<MerlTable> table = ReadMerl(path);
    if (!table.ok()) return table.status();
    VoidBeyond(file.folder->trusted_to, &*table);
    AddTable(*table, columns, file.name, &data);
    LOG_EVERY_N(INFO, 10) << "read " << path;
  }
  return data;
}

}  // namespace ibrdf
