#include "ibrdf/io/merl.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "ibrdf/io/atomic_file.h"

namespace ibrdf {
namespace {
constexpr size_t kHeaderBytes = 3 * sizeof(int32_t);
constexpr size_t kTableBytes = size_t{3} * kMerlBins * sizeof(double);

// Files that are taken for MERL tables; empty: none of those.
std::optional<std::string> WhatItIs(const std::string& bytes,
                                    const std::array<int32_t, 3>& found,
                                    const std::array<int32_t, 3>& bins) {
  if (bytes.rfind("tensor_file", 0) == 0) {
    return "found a tensor_file, as of the RGL database; resample it to MERL's "
           "angles";
  }
  std::array<int32_t, 3> swapped = found;
  for (int32_t& v : swapped) {
    v = static_cast<int32_t>(__builtin_bswap32(static_cast<uint32_t>(v)));
  }
  if (swapped == bins) return "found them in big-endian byte order";
  return std::nullopt;
}

}  // namespace

StatusOr<MerlTable> ReadMerl(const std::string& path) {
  const StatusOr<std::string> bytes =
      ReadFile(path, kHeaderBytes + kTableBytes);
  if (!bytes.ok()) return bytes.status();
  StatusOr<std::vector<double>> raw = DecodeMerl(path, *bytes);
  if (!raw.ok()) return raw.status();
  MerlTable table;
  table.raw = *std::move(raw);
  if (std::all_of(table.raw.begin(), table.raw.end(),
                  [](double v) { return v < 0.0; })) {
    return InvalidInput(path,
                        "expected a valid bin, found none: all values are "
                        "below 0");
  }
  return table;
}

StatusOr<std::vector<double>> DecodeMerl(const std::string& path,
                                         const std::string& bytes,
                                         const std::array<int32_t, 3>& bins) {
  const auto text = [](const std::array<int32_t, 3>& b) {
    return std::to_string(b[0]) + " " + std::to_string(b[1]) + " " +
           std::to_string(b[2]);
  };
  std::array<int32_t, 3> found;
  if (bytes.size() < kHeaderBytes) {
    return InvalidInput(path, "truncated MERL header, expected 12 bytes");
  }
  std::memcpy(found.data(), bytes.data(), kHeaderBytes);
  if (found != bins) {
    return InvalidInput(
        path + ": dimensions",
        "expected " + text(bins) + " as of a MERL table, " +
            WhatItIs(bytes, found, bins).value_or("found " + text(found)));
  }
  std::vector<double> raw(size_t{3} * bins[0] * bins[1] * bins[2]);
  const size_t size = kHeaderBytes + raw.size() * sizeof(double);
  if (bytes.size() != size) {
    return InvalidInput(path, "truncated MERL table, expected " +
                                  std::to_string(size) + " bytes, found " +
                                  std::to_string(bytes.size()));
  }
  std::memcpy(raw.data(), bytes.data() + kHeaderBytes, size - kHeaderBytes);
  for (size_t i = 0; i < raw.size(); ++i) {
    if (!std::isfinite(raw[i])) {
      return InvalidInput(path + ": entry " + std::to_string(i),
                          "expected a finite number");
    }
  }
  return raw;
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
