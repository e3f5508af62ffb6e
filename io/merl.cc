#include "io/merl.h"

#include <cmath>
#include <cstdint>
#include <cstring>

#include "io/atomic_file.h"

namespace ibrdf {
namespace {
constexpr size_t kHeaderBytes = 3 * sizeof(int32_t);
constexpr size_t kTableBytes = size_t{3} * kMerlBins * sizeof(double);
}  // namespace

StatusOr<MerlTable> ReadMerl(const std::string& path) {
  StatusOr<std::string> bytes = ReadFile(path, kHeaderBytes + kTableBytes);
  if (!bytes.ok()) return bytes.status();
  int32_t dims[3];
  if (bytes->size() < kHeaderBytes) {
    return InvalidInput(path, "truncated MERL header, expected 12 bytes");
  }
  std::memcpy(dims, bytes->data(), kHeaderBytes);
  if (dims[0] != kMerlThetaH || dims[1] != kMerlThetaD ||
      dims[2] != kMerlPhiD) {
    return InvalidInput(path + ": dimensions",
                        "expected 90 90 180, found " + std::to_string(dims[0]) +
                            " " + std::to_string(dims[1]) + " " +
                            std::to_string(dims[2]));
  }
  if (bytes->size() != kHeaderBytes + kTableBytes) {
    return InvalidInput(path, "truncated MERL table, expected " +
                                  std::to_string(kHeaderBytes + kTableBytes) +
                                  " bytes, found " +
                                  std::to_string(bytes->size()));
  }
  MerlTable table;
  table.raw.resize(size_t{3} * kMerlBins);
  std::memcpy(table.raw.data(), bytes->data() + kHeaderBytes, kTableBytes);
  for (size_t i = 0; i < table.raw.size(); ++i) {
    if (!std::isfinite(table.raw[i])) {
      return InvalidInput(path + ": entry " + std::to_string(i),
                          "expected a finite number");
    }
  }
  return table;
}

Status WriteMerl(const MerlTable& table, const std::string& path) {
  if (table.raw.size() != size_t{3} * kMerlBins) {
    return Status(StatusCode::kInternal, path + ": table has a wrong size");
  }
  const int32_t dims[3] = {kMerlThetaH, kMerlThetaD, kMerlPhiD};
  std::string bytes(kHeaderBytes + kTableBytes, '\0');
  std::memcpy(bytes.data(), dims, kHeaderBytes);
  std::memcpy(bytes.data() + kHeaderBytes, table.raw.data(), kTableBytes);
  return WriteFileAtomically(path, bytes);
}

}  // namespace ibrdf
