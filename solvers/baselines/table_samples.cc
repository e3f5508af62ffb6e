#include "ibrdf/solvers/baselines/table_samples.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {

constexpr int kBlockH = 2, kBlockD = 4, kBlockP = 15;
constexpr int kHalfPhiD = kMerlPhiD / 2;

// Adds the logarithms of a valid bin; false where it is not valid.
bool AddBin(const MerlTable& table, int bin, Eigen::Array3d* sum) {
  if (!(table.Raw(0, bin) > 0.0)) return false;
  for (int c = 0; c < 3; ++c) {
    (*sum)[c] += std::log(std::max(table.Raw(c, bin), 0.0) + kTableLogFloor);
  }
  return true;
}

Status Check(const MerlTable& table) {
  CHECK_EQ(size_t{3} * kMerlBins, table.raw.size());
  bool any = false;
  for (int bin = 0; bin < kMerlBins; ++bin) {
    for (int c = 0; c < 3; ++c) {
      if (!std::isfinite(table.Raw(c, bin))) {
        return InvalidInput("table: bin " + std::to_string(bin),
                            "expected finite values");
      }
    }
    any = any || table.Raw(0, bin) > 0.0;
  }
  if (any) return OkStatus();
  return InvalidInput("table: red", "expected a bin with a positive value");
}

void Normalise(std::vector<TableSample>* samples) {
  double sum = 0.0;
  for (const TableSample& s : *samples) sum += s.weight;
  for (TableSample& s : *samples) s.weight /= sum;
}

}  // namespace

StatusOr<std::vector<TableSample>> SampleBins(const MerlTable& table,
                                              uint64_t seed) {
  IBRDF_RETURN_IF_ERROR(Check(table));
  std::mt19937_64 rng(seed);
  std::vector<TableSample> samples, block;
  for (int i0 = 0; i0 < kMerlThetaH; i0 += kBlockH) {
    for (int j0 = 0; j0 < kMerlThetaD; j0 += kBlockD) {
      for (int k0 = 0; k0 < kHalfPhiD; k0 += kBlockP) {
        block.clear();
        double bins = 0.0;
        for (int i = i0; i < std::min(i0 + kBlockH, kMerlThetaH); ++i) {
          for (int j = j0; j < std::min(j0 + kBlockD, kMerlThetaD); ++j) {
            for (int k = k0; k < k0 + kBlockP; ++k) {
              Eigen::Array3d sum = Eigen::Array3d::Zero();
              const int count =
                  AddBin(table, MerlTable::Bin(i, j, k), &sum) +
                  AddBin(table, MerlTable::Bin(i, j, kMerlPhiD - 1 - k), &sum);
              if (count == 0) continue;
              bins += count;
              block.push_back({MerlThetaH(i), MerlThetaD(j), MerlPhiD(k),
                               sum / count, static_cast<double>(count)});
            }
          }
        }
        // The draw is made for empty blocks too: a bin that becomes invalid
        // does not change the others.
        const uint64_t draw = rng();
        if (block.empty()) continue;
        samples.push_back(block[draw % block.size()]);
        samples.back().weight = bins;
      }
    }
  }
  Normalise(&samples);
  return samples;
}

StatusOr<std::vector<TableSample>> AverageOverPhi(const MerlTable& table) {
  IBRDF_RETURN_IF_ERROR(Check(table));
  std::vector<TableSample> samples;
  for (int i = 0; i < kMerlThetaH; ++i) {
    for (int j = 0; j < kMerlThetaD; ++j) {
      Eigen::Array3d sum = Eigen::Array3d::Zero();
      int count = 0;
      for (int k = 0; k < kMerlPhiD; ++k) {
        count += AddBin(table, MerlTable::Bin(i, j, k), &sum);
      }
      if (count == 0) continue;
      samples.push_back({MerlThetaH(i), MerlThetaD(j), kPi / 2, sum / count,
                         static_cast<double>(count)});
    }
  }
  Normalise(&samples);
  return samples;
}

MerlTable SampleBrdf(const BrdfFunction& brdf, bool depends_on_phi_d,
                     const MerlTable& like) {
  CHECK_EQ(size_t{3} * kMerlBins, like.raw.size());
  MerlTable table;
  table.raw.assign(size_t{3} * kMerlBins, -1.0);
  for (int i = 0; i < kMerlThetaH; ++i) {
    for (int j = 0; j < kMerlThetaD; ++j) {
      Eigen::Array3d f = brdf(MerlThetaH(i), MerlThetaD(j), kPi / 2);
      for (int k = 0; k < kMerlPhiD; ++k) {
        const int bin = MerlTable::Bin(i, j, k);
        if (!MerlBinAboveHorizon(i, j, k) && !(like.Raw(0, bin) > 0.0)) {
          continue;
        }
        if (depends_on_phi_d) {
          f = brdf(MerlThetaH(i), MerlThetaD(j), MerlPhiD(k));
        }
        for (int c = 0; c < 3; ++c) {
          table.raw[static_cast<size_t>(c) * kMerlBins + bin] =
              f[c] / kMerlScale[c];
        }
      }
    }
  }
  return table;
}

}  // namespace ibrdf
