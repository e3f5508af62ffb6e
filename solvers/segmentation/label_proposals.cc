#include "ibrdf/solvers/segmentation/label_proposals.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/solvers/segmentation/label_overlap.h"
#include "ibrdf/solvers/segmentation/label_spreading.h"

namespace ibrdf {
namespace {

constexpr double kSteps[] = {0.05, 0.08, 0.12, 0.2};
constexpr struct {
  int degree;
  double share;
} kMaterialSettings[] = {{1, 0.15}, {2, 0.05}, {2, 0.5}, {3, 0.15}};
constexpr size_t kMostPixels = 20000;  // at first
constexpr int kTrialRounds = 6, kLastRounds = 15, kFullSizeRounds = 3;
// Labellings that agree on more of the pixels are one.
constexpr double kSame = 0.98;

std::vector<MergeSetting> Settings() {
  std::vector<MergeSetting> settings;
  for (const double step : kSteps) {
    for (const auto& [degree, share] : kMaterialSettings) {
      settings.push_back({step, degree, share});
    }
  }
  return settings;
}

int BlockOf(size_t num_points) {
  int block = 1;
  while (num_points / (static_cast<size_t>(block) * block) > kMostPixels) {
    ++block;
  }
  return block;
}

bool SomeAreAlike(const std::vector<RefinedLabelling>& some,
                  const Labelling& labelling) {
  return std::any_of(some.begin(), some.end(), [&](const auto& other) {
    return Agreement(other.labelling, labelling) > kSame;
  });
}

// What all settings begin with, each but once.
std::vector<Labelling> Starts(const MaterialPixels& pixels,
                              const LabelProposalOptions& options) {
  const std::vector<MergeSetting> settings = Settings();
  std::vector<std::vector<Labelling>> of_setting(settings.size());
  ParallelFor(static_cast<int64_t>(settings.size()), options.num_threads,
              [&](int64_t k, int) {
                of_setting[k] =
                    MergeRegions(pixels, settings[k], options.most_materials);
              });
  std::vector<Labelling> starts;
  for (std::vector<Labelling>& some : of_setting) {
    for (Labelling& labelling : some) {
      const bool known = std::any_of(starts.begin(), starts.end(),
                                     [&](const Labelling& other) {
                                       return other.labels == labelling.labels;
                                     });
      if (!known) starts.push_back(std::move(labelling));
    }
  }
  return starts;
}

// By number of materials, then by energy; those that differ.
std::vector<RefinedLabelling> Distinct(std::vector<RefinedLabelling> all,
                                       size_t most_of_count) {
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return std::pair(a.labelling.count, a.energy) <
           std::pair(b.labelling.count, b.energy);
  });
  std::vector<RefinedLabelling> distinct;
  size_t of_count = 0;
  for (RefinedLabelling& refined : all) {
    if (refined.labelling.count < 2) continue;
    if (distinct.empty() ||
        distinct.back().labelling.count != refined.labelling.count) {
      of_count = 0;
    }
    if (of_count == most_of_count ||
        SomeAreAlike(distinct, refined.labelling)) {
      continue;
    }
    ++of_count;
    distinct.push_back(std::move(refined));
  }
  return distinct;
}

std::vector<RefinedLabelling> RefineAll(const MaterialPixels& pixels,
                                        const std::vector<Labelling>& starts,
                                        int rounds, int num_threads) {
  std::vector<RefinedLabelling> refined(starts.size());
  ParallelFor(static_cast<int64_t>(starts.size()), num_threads,
              [&](int64_t k, int) {
                refined[k] = RefineLabels(pixels, starts[k], rounds);
              });
  return refined;
}

std::vector<Labelling> LabellingsOf(std::vector<RefinedLabelling> refined) {
  std::vector<Labelling> out;
  for (RefinedLabelling& r : refined) out.push_back(std::move(r.labelling));
  return out;
}

// The labels of one list of pixels for another of the same points.
Labelling Moved(const Labelling& labelling, const MaterialPixels& from,
                const MaterialPixels& to) {
  Labelling out{std::vector<int>(to.count(), -1), labelling.count};
  for (size_t i = 0; i < to.pixel_of_point.size(); ++i) {
    const int source = from.pixel_of_point[i];
    const int pixel = to.pixel_of_point[i];
    if (source >= 0 && pixel >= 0) out.labels[pixel] = labelling.labels[source];
  }
  return out;
}

// Labels in order of their points, the most first.
void OrderBySize(LabelProposal* proposal) {
  std::vector<int> points(proposal->count, 0), order(proposal->count);
  for (const int label : proposal->labels) ++points[label];
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return points[a] > points[b]; });
  std::vector<int> place(proposal->count);
  for (int k = 0; k < proposal->count; ++k) place[order[k]] = k;
  for (int& label : proposal->labels) label = place[label];
}

LabelProposal OfPoints(const RefinedLabelling& refined,
                       const MaterialPixels& pixels,
                       const std::vector<ShadingPoint>& points,
                       int image_width) {
  LabelProposal out;
  out.count = refined.labelling.count;
  out.energy = refined.energy;
  for (const int pixel : pixels.pixel_of_point) {
    out.labels.push_back(pixel < 0 ? -1 : refined.labelling.labels[pixel]);
  }
  SpreadLabels(points, image_width, &out.labels);
  OrderBySize(&out);
  return out;
}

}  // namespace

std::vector<LabelProposal> ProposeLabels(
    const std::vector<ShadingPoint>& points, const Observations& observed,
    int image_width, const LabelProposalOptions& options) {
  const int block = BlockOf(points.size());
  MaterialPixels pixels = GatherPixels(points, observed, image_width, block);
  if (pixels.count() == 0) return {};
  std::vector<RefinedLabelling> found =
      Distinct(RefineAll(pixels, Starts(pixels, options), kTrialRounds,
                         options.num_threads),
               options.most_of_count);
  found = Distinct(RefineAll(pixels, LabellingsOf(std::move(found)),
                             kLastRounds, options.num_threads),
                   options.most_of_count);
  if (block > 1) {
    MaterialPixels full = GatherPixels(points, observed, image_width, 1);
    std::vector<Labelling> starts;
    for (const RefinedLabelling& refined : found) {
      starts.push_back(Moved(refined.labelling, pixels, full));
    }
    found =
        Distinct(RefineAll(full, starts, kFullSizeRounds, options.num_threads),
                 options.most_of_count);
    pixels = std::move(full);
  }
  std::vector<LabelProposal> proposals;
  for (const RefinedLabelling& refined : found) {
    proposals.push_back(OfPoints(refined, pixels, points, image_width));
  }
  return proposals;
}

}  // namespace ibrdf
