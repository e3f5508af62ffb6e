#include "ibrdf/brdf/brdf_sampler.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {

constexpr double kLastViewDegrees = 88.5;
constexpr int kSub = 2;  // points of a cell along each axis

// theta_h up to which wi stays above the horizon, phi from the view's azimuth:
// cos(theta_i) is proportional to cos(2 theta_h - delta).
double HorizonBound(double theta_o, double phi) {
  const double delta =
      std::atan2(std::sin(theta_o) * std::cos(phi), std::cos(theta_o));
  return 0.5 * (delta + kPi / 2);
}

// 1 - cos(theta) to full precision.
double Versine(double theta) {
  const double s = std::sin(0.5 * theta);
  return 2.0 * s * s;
}
double FromVersine(double v) {
  return 2.0 * std::asin(std::sqrt(std::clamp(0.5 * v, 0.0, 1.0)));
}

// Edge of a cell along theta_h: cells are narrow about the mirror direction.
double Edge(double bound, int i, int cells) {
  const double t = static_cast<double>(i) / cells;
  return bound * t * t;
}

Eigen::Vector3d Direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
          std::cos(theta)};
}

double ThetaOf(const Eigen::Vector3d& w) {
  return std::atan2(std::hypot(w.x(), w.y()), w.z());
}

// The cell of u in cumulative sums [n + 1] from 0 to 1, and where in it.
int Invert(const double* sums, int n, double u, double* rest) {
  int cell =
      static_cast<int>(std::upper_bound(sums, sums + n + 1, u) - sums) - 1;
  cell = std::clamp(cell, 0, n - 1);
  while (cell > 0 && sums[cell + 1] <= sums[cell]) --cell;
  const double width = sums[cell + 1] - sums[cell];
  *rest = width > 0.0 ? std::clamp((u - sums[cell]) / width, 0.0, 1.0) : 0.5;
  return cell;
}

// Cumulative sums from 0 to 1; all equal where values are 0.
void Accumulate(const double* values, int n, double* sums) {
  sums[0] = 0.0;
  for (int i = 0; i < n; ++i) sums[i + 1] = sums[i] + values[i];
  const double total = sums[n];
  for (int i = 1; i <= n; ++i) {
    sums[i] = total > 0.0 ? sums[i] / total : static_cast<double>(i) / n;
  }
  sums[n] = 1.0;
}

}  // namespace

BrdfSampler::BrdfSampler(const BrdfBatch& brdf,
                         const BrdfSamplerOptions& options)
    : options_(options) {
  CHECK_GE(options.views, 2);
  CHECK_GE(options.theta_cells, 1);
  CHECK_GE(options.phi_cells, 1);
  CHECK(options.cosine_share > 0.0 && options.cosine_share <= 1.0);
  tables_.resize(options.views);
  for (int view = 0; view < options.views; ++view) Fill(brdf, view);
}

double BrdfSampler::ViewAngle(int view) const {
  return kLastViewDegrees * kPi / 180.0 * view / (options_.views - 1);
}

void BrdfSampler::Fill(const BrdfBatch& brdf, int view) {
  const double theta_o = ViewAngle(view);
  const Eigen::Vector3d wo = Direction(theta_o, 0.0);
  const int nt = options_.theta_cells, np = options_.phi_cells;
  std::vector<HalfDiff> angles;
  std::vector<double> weights;
  std::vector<int> cells;
  for (int j = 0; j < np * kSub; ++j) {
    const double phi = 2.0 * kPi * (j + 0.5) / (np * kSub);
    const double bound = HorizonBound(theta_o, phi);
    for (int i = 0; i < nt; ++i) {
      const double low = Versine(Edge(bound, i, nt));
      const double high = Versine(Edge(bound, i + 1, nt));
      for (int k = 0; k < kSub; ++k) {
        const double v = low + (k + 0.5) / kSub * (high - low);
        const Eigen::Vector3d h = Direction(FromVersine(v), phi);
        const double cos_d = wo.dot(h);
        const Eigen::Vector3d wi = 2.0 * cos_d * h - wo;
        if (wi.z() <= 0.0 || cos_d <= 0.0) continue;  // by rounding
        angles.push_back(ToHalfDiff(wi, wo));
        weights.push_back(4.0 * cos_d * wi.z() * (high - low));
        cells.push_back(i * np + j / kSub);
      }
    }
  }
  const std::vector<Eigen::Array3d> f = brdf(angles);
  Table& table = tables_[view];
  table.mass.assign(static_cast<size_t>(nt) * np, 0.0);
  double total = 0.0;
  for (size_t i = 0; i < f.size(); ++i) {
    const double mass = weights[i] * f[i].mean();
    if (!(mass > 0.0) || !std::isfinite(mass)) continue;
    table.mass[cells[i]] += mass;
    total += mass;
  }
  table.empty = !(total > 0.0) || !std::isfinite(total);
  if (table.empty) return;
  for (double& m : table.mass) m /= total;
  std::vector<double> rows(nt, 0.0);
  table.phi_sum.resize(static_cast<size_t>(nt) * (np + 1));
  table.theta_sum.resize(nt + 1);
  for (int i = 0; i < nt; ++i) {
    const double* mass = table.mass.data() + static_cast<size_t>(i) * np;
    for (int j = 0; j < np; ++j) rows[i] += mass[j];
    Accumulate(mass, np,
               table.phi_sum.data() + static_cast<size_t>(i) * (np + 1));
  }
  Accumulate(rows.data(), nt, table.theta_sum.data());
}

BrdfSampler::Neighbours BrdfSampler::Near(double theta_o) const {
  const double at =
      std::min(theta_o / ViewAngle(1), static_cast<double>(options_.views - 1));
  const int first = std::min(static_cast<int>(at), options_.views - 2);
  return {first, first + 1, at - first};
}

double BrdfSampler::CosineShare(const Table& a, const Table& b) const {
  return a.empty || b.empty ? 1.0 : options_.cosine_share;
}

Eigen::Vector3d BrdfSampler::DrawHalfVector(const Table& table, double theta_o,
                                            double u1, double u2) const {
  const int nt = options_.theta_cells, np = options_.phi_cells;
  double in_theta = 0.0, in_phi = 0.0;
  const int i = Invert(table.theta_sum.data(), nt, u1, &in_theta);
  const int j = Invert(table.phi_sum.data() + static_cast<size_t>(i) * (np + 1),
                       np, u2, &in_phi);
  const double phi = 2.0 * kPi * (j + in_phi) / np;
  const double bound = HorizonBound(theta_o, phi);
  const double low = Versine(Edge(bound, i, nt));
  const double high = Versine(Edge(bound, i + 1, nt));
  return Direction(FromVersine(low + in_theta * (high - low)), phi);
}

BrdfSampler::Sample BrdfSampler::Draw(const Eigen::Vector3d& wo, double u1,
                                      double u2, double u3) const {
  const double theta_o = ThetaOf(wo);
  const Neighbours near = Near(theta_o);
  const Table& first = tables_[near.first];
  const Table& second = tables_[near.second];
  const double cosine = CosineShare(first, second);
  Sample sample;
  if (u3 < cosine) {
    sample.wi = Direction(std::asin(std::sqrt(u1)), 2.0 * kPi * u2);
  } else {
    const bool take_second = (u3 - cosine) / (1.0 - cosine) < near.share;
    const Eigen::Vector3d h =
        DrawHalfVector(take_second ? second : first, theta_o, u1, u2);
    // In the frame whose first axis lies below the view.
    const Eigen::Vector3d view = Direction(theta_o, 0.0);
    const Eigen::Vector3d w = 2.0 * view.dot(h) * h - view;
    const double sin_o = std::hypot(wo.x(), wo.y());
    const double c = sin_o > 0.0 ? wo.x() / sin_o : 1.0;
    const double s = sin_o > 0.0 ? wo.y() / sin_o : 0.0;
    sample.wi = {c * w.x() - s * w.y(), s * w.x() + c * w.y(), w.z()};
  }
  sample.pdf = Pdf(wo, sample.wi);
  return sample;
}

double BrdfSampler::Pdf(const Eigen::Vector3d& wo,
                        const Eigen::Vector3d& wi) const {
  if (wi.z() <= 0.0 || wo.z() <= 0.0) return 0.0;
  const double theta_o = ThetaOf(wo);
  const Neighbours near = Near(theta_o);
  const Table& first = tables_[near.first];
  const Table& second = tables_[near.second];
  const double cosine = CosineShare(first, second);
  const double pdf = cosine * wi.z() / kPi;
  if (cosine == 1.0) return pdf;

  const Eigen::Vector3d h = (wi + wo).normalized();
  const double sin_o = std::hypot(wo.x(), wo.y());
  const double c = sin_o > 0.0 ? wo.x() / sin_o : 1.0;
  const double s = sin_o > 0.0 ? wo.y() / sin_o : 0.0;
  double phi = std::atan2(c * h.y() - s * h.x(), c * h.x() + s * h.y());
  if (phi < 0.0) phi += 2.0 * kPi;
  const int nt = options_.theta_cells, np = options_.phi_cells;
  const int j = std::min(static_cast<int>(phi / (2.0 * kPi) * np), np - 1);
  const double bound = HorizonBound(theta_o, phi);
  const double t = std::sqrt(ThetaOf(h) / bound);
  const int i = std::min(static_cast<int>(t * nt), nt - 1);
  const double mass = (1.0 - near.share) * first.mass[i * np + j] +
                      near.share * second.mass[i * np + j];
  const double solid_angle =
      2.0 * kPi / np *
      (Versine(Edge(bound, i + 1, nt)) - Versine(Edge(bound, i, nt)));
  if (!(solid_angle > 0.0)) return pdf;
  return pdf + (1.0 - cosine) * mass / solid_angle / (4.0 * wo.dot(h));
}

}  // namespace ibrdf
