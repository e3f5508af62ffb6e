#include "ibrdf/solvers/bench/embedding_pages.h"

#include <algorithm>
#include <cmath>

#include "ibrdf/base/format.h"
#include "ibrdf/solvers/report/picture.h"

namespace ibrdf {
namespace {

constexpr double kTitleHeight = 17.0, kTextHeight = 11.0, kNameHeight = 9.0;
constexpr double kMargin = 36.0;

// Names wrap at a hyphen into lines no wider than `width`.
std::vector<std::string> WrapName(const std::string& name, double width,
                                  double height) {
  std::vector<std::string> lines(1);
  size_t begin = 0;
  while (begin < name.size()) {
    const size_t hyphen = name.find('-', begin);
    const size_t end = hyphen == std::string::npos ? name.size() : hyphen + 1;
    const std::string part = name.substr(begin, end - begin);
    if (!lines.back().empty() &&
        Picture::TextWidth(lines.back() + part, height) > width) {
      lines.emplace_back();
    }
    lines.back() += part;
    begin = end;
  }
  return lines;
}

struct Box {
  double left, top, right, bottom;
  bool Meets(const Box& o) const {
    return left < o.right && o.left < right && top < o.bottom && o.top < bottom;
  }
};

}  // namespace

Rgb8Image MapPage(const EmbeddingMap& map,
                  const std::vector<NamedSphere>& spheres, double exposure) {
  constexpr int kWidth = 1600, kHeight = 1200, kDiameter = 68;
  constexpr double kTop = 96.0, kBottom = 60.0, kLabelGap = 3.0;
  const int n = static_cast<int>(spheres.size());
  Picture page(kWidth, kHeight);
  page.Text("Embedding of the materials, first two principal axes", kMargin,
            48.0, kTitleHeight);
  const std::string note = Format(
      "%d materials; codes of the three channels in a row. Spheres "
      "that would overlap are moved; a line leads to the place.",
      n);
  page.Text(note, kMargin, 74.0, kTextHeight, Picture::Align::kLeft, kGreyInk);

  // One scale for both axes would leave a band: axes are scaled by themselves.
  const double radius = kDiameter / 2.0;
  const Eigen::Array2d low(kMargin + radius + 20, kTop + radius);
  const Eigen::Array2d high(kWidth - kMargin - radius - 20,
                            kHeight - kBottom - radius - 16);
  Eigen::MatrixXd places(n, 2);
  for (int k = 0; k < 2; ++k) {
    const Eigen::VectorXd scores = map.scores.col(k);
    const double span = std::max(scores.maxCoeff() - scores.minCoeff(), 1e-12);
    for (int i = 0; i < n; ++i) {
      const double t = (scores[i] - scores.minCoeff()) / span;
      places(i, k) = k == 0
                         ? low[0] + t * (high[0] - low[0])
                         : high[1] - t * (high[1] - low[1]);  // up is positive
    }
  }
  // Room for a line of text below each sphere, as far as there is.
  const double cell = std::sqrt((high - low).prod() / n);
  const double distance = std::min(kDiameter + 40.0, 0.93 * cell);
  const Eigen::MatrixXd at = SpreadApart(places, distance, low, high);

  page.Line(kMargin, kHeight - kBottom + 8, kWidth - kMargin,
            kHeight - kBottom + 8, kFaintInk);
  page.Text(Format("axis 1: %.1f %% of the variance", 100.0 * map.variance[0]),
            kWidth - kMargin, kHeight - kBottom + 32, kTextHeight,
            Picture::Align::kRight, kGreyInk);
  page.Text(Format("axis 2, upwards: %.1f %% of the variance",
                   100.0 * map.variance[1]),
            kMargin, kHeight - kBottom + 32, kTextHeight, Picture::Align::kLeft,
            kGreyInk);
  for (int i = 0; i < n; ++i) {
    page.Line(places(i, 0), places(i, 1), at(i, 0), at(i, 1), kFaintInk);
    page.Dot(places(i, 0), places(i, 1), 2.5, kGreyInk);
  }
  const int diameter =
      static_cast<int>(std::min<double>(kDiameter, distance - 6.0));
  // The head of the page, and a strip at its foot.
  std::vector<Box> taken = {{0, 0, kWidth, 82},
                            {0, kHeight - kBottom, kWidth, kHeight}};
  for (int i = 0; i < n; ++i) {
    page.Sphere(spheres[i].image, at(i, 0), at(i, 1), diameter, exposure);
    const double r = 0.46 * diameter;
    taken.push_back({at(i, 0) - r, at(i, 1) - r, at(i, 0) + r, at(i, 1) + r});
  }
  // Names: below, above, and either with a shift to a side; where nothing is
  // free the csv has to do.
  const double line = kNameHeight + 4.0;
  const double shift = 0.35 * diameter;
  for (int i = 0; i < n; ++i) {
    const std::vector<std::string> lines =
        WrapName(spheres[i].name, 1.2 * distance, kNameHeight);
    double width = 0.0;
    for (const std::string& text : lines) {
      width = std::max(width, Picture::TextWidth(text, kNameHeight));
    }
    const double height = line * static_cast<double>(lines.size());
    for (int place = 0; place < 6; ++place) {
      const double aside = place / 2 == 0   ? 0.0
                           : place / 2 == 1 ? shift
                                            : -shift;
      const double x = at(i, 0) + aside;
      const double top = place % 2 == 0
                             ? at(i, 1) + 0.5 * diameter + kLabelGap
                             : at(i, 1) - 0.5 * diameter - kLabelGap - height;
      const Box box{x - width / 2, top, x + width / 2, top + height};
      const bool free =
          std::none_of(taken.begin(), taken.end(),
                       [&](const Box& o) { return box.Meets(o); });
      if (!free || box.left < 12 || box.right > kWidth - 12) continue;
      for (size_t k = 0; k < lines.size(); ++k) {
        page.Text(lines[k], x, top + kNameHeight + k * line, kNameHeight,
                  Picture::Align::kCentre);
      }
      taken.push_back(box);
      break;
    }
  }
  return page.ToImage();
}

Rgb8Image WalkPage(const std::vector<NamedSphere>& steps,
                   const std::string& from, const std::string& to,
                   double distance, double exposure) {
  constexpr int kDiameter = 136, kStep = 152;
  const int n = static_cast<int>(steps.size());
  const double top = 96.0;
  Picture page(static_cast<int>(2 * kMargin) + n * kStep,
               static_cast<int>(top) + kDiameter + 70);
  page.Text("From " + from + " to " + to, kMargin, 46.0, kTitleHeight);
  page.Text("Codes and log colours interpolated; distance in code space " +
                Format("%.2f", distance) + ". The same sky for all.",
            kMargin, 72.0, kTextHeight, Picture::Align::kLeft, kGreyInk);
  for (int i = 0; i < n; ++i) {
    const double x = kMargin + (i + 0.5) * kStep;
    page.Sphere(steps[i].image, x, top + kDiameter / 2.0, kDiameter, exposure);
    page.Text(steps[i].name, x, top + kDiameter + 22, kTextHeight,
              Picture::Align::kCentre, kGreyInk);
    if (i == 0 || i == n - 1) {
      page.Text(i == 0 ? from : to, x, top + kDiameter + 44, kTextHeight,
                Picture::Align::kCentre);
    }
  }
  return page.ToImage();
}

Rgb8Image NeighbourPage(const std::vector<NeighbourRow>& rows,
                        double exposure) {
  constexpr int kDiameter = 116, kStepX = 184, kStepY = 176;
  const double top = 116.0;
  size_t most = 0;
  bool measured = false;
  for (const NeighbourRow& row : rows) {
    most = std::max(most, row.neighbours.size());
    measured = measured || !row.measured.empty();
  }
  const int first = measured ? 2 : 1;  // column of the nearest
  constexpr double kGap = 40.0;        // between materials and neighbours
  const auto column = [&](int c) {
    return kMargin + (c + 0.5) * kStepX + (c >= first ? kGap : 0.0);
  };
  Picture page(
      static_cast<int>(2 * kMargin + kGap) +
          (first + static_cast<int>(most)) * kStepX,
      static_cast<int>(top) + static_cast<int>(rows.size()) * kStepY + 10);
  page.Text("Nearest neighbours in code space", kMargin, 46.0, kTitleHeight);
  page.Text("Materials from matte to glossy; numbers are distances.", kMargin,
            72.0, kTextHeight, Picture::Align::kLeft, kGreyInk);
  if (measured) {
    page.Text("measured", column(0), top - 14, kTextHeight,
              Picture::Align::kCentre, kGreyInk);
  }
  page.Text("model", column(first - 1), top - 14, kTextHeight,
            Picture::Align::kCentre, kGreyInk);
  const double divider = kMargin + first * kStepX + kGap / 2;
  page.Line(divider, top - 28, divider, top + rows.size() * kStepY - 16,
            kFaintInk);
  for (size_t r = 0; r < rows.size(); ++r) {
    const NeighbourRow& row = rows[r];
    const double y = top + r * kStepY + kDiameter / 2.0;
    const auto draw = [&](const Image& image, const std::string& name, int c) {
      page.Sphere(image, column(c), y, kDiameter, exposure);
      double baseline = y + kDiameter / 2.0 + 17;
      for (const std::string& line :
           WrapName(name, kStepX - 10.0, kNameHeight)) {
        page.Text(line, column(c), baseline, kNameHeight,
                  Picture::Align::kCentre);
        baseline += kNameHeight + 5.0;
      }
      return baseline;
    };
    if (!row.measured.empty()) draw(row.measured, row.material.name, 0);
    draw(row.material.image, row.material.name, first - 1);
    for (size_t k = 0; k < row.neighbours.size(); ++k) {
      const int c = first + static_cast<int>(k);
      const double baseline =
          draw(row.neighbours[k].image, row.neighbours[k].name, c);
      page.Text(Format("%.2f", row.distances[k]), column(c), baseline + 1,
                kNameHeight, Picture::Align::kCentre, kGreyInk);
    }
  }
  return page.ToImage();
}

}  // namespace ibrdf
