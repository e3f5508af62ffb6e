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

// The map's page in pixels: head, spheres, foot.
constexpr int kMapWidth = 1600, kMapHeight = 1200, kMapDiameter = 68;
constexpr double kMapTop = 96.0, kMapBottom = 60.0;

void DrawMapText(int materials, const Eigen::VectorXd& variance,
                 Picture* page) {
  page->Text("Embedding of the materials, first two principal axes", kMargin,
             48.0, kTitleHeight);
  const std::string note = Format(
      "%d materials; codes of the three channels in a row. Spheres "
      "that would overlap are moved; a line leads to the place.",
      materials);
  page->Text(note, kMargin, 74.0, kTextHeight, Picture::Align::kLeft, kGreyInk);
  constexpr double kLine = kMapHeight - kMapBottom + 8;
  page->Line(kMargin, kLine, kMapWidth - kMargin, kLine, kFaintInk);
  page->Text(Format("axis 1: %.1f %% of the variance", 100.0 * variance[0]),
             kMapWidth - kMargin, kLine + 24, kTextHeight,
             Picture::Align::kRight, kGreyInk);
  page->Text(
      Format("axis 2, upwards: %.1f %% of the variance", 100.0 * variance[1]),
      kMargin, kLine + 24, kTextHeight, Picture::Align::kLeft, kGreyInk);
}

// Scores along the first two axes as places [n, 2] in the box from low to high.
// One scale for both would leave a band: each axis has its own.
Eigen::MatrixXd PlacesOf(const Eigen::MatrixXd& scores,
                         const Eigen::Array2d& low,
                         const Eigen::Array2d& high) {
  Eigen::MatrixXd places(scores.rows(), 2);
  for (int k = 0; k < 2; ++k) {
    const double least = scores.col(k).minCoeff();
    const double span = std::max(scores.col(k).maxCoeff() - least, 1e-12);
    for (Eigen::Index i = 0; i < scores.rows(); ++i) {
      const double t = (scores(i, k) - least) / span;
      places(i, k) = k == 0
                         ? low[0] + t * (high[0] - low[0])
                         : high[1] - t * (high[1] - low[1]);  // up is positive
    }
  }
  return places;
}

// The lines of a name and how much room they take.
struct NameLines {
  static constexpr double kLine = kNameHeight + 4.0;
  NameLines(const std::string& name, double width_limit)
      : lines(WrapName(name, width_limit, kNameHeight)) {
    for (const std::string& line : lines) {
      width = std::max(width, Picture::TextWidth(line, kNameHeight));
    }
    height = kLine * static_cast<double>(lines.size());
  }

  std::vector<std::string> lines;
  double width = 0.0, height = 0.0;
};

// Draws the name below or above its sphere, or either with a shift to a side,
// and adds it to what is taken; where nothing is free the csv has to do.
void DrawName(const NameLines& name, double sphere_x, double sphere_y,
              int diameter, std::vector<Box>* taken, Picture* page) {
  constexpr double kLabelGap = 3.0;
  const double shift = 0.35 * diameter;
  for (const double aside : {0.0, shift, -shift}) {
    for (const bool below : {true, false}) {
      const double x = sphere_x + aside;
      const double top =
          below ? sphere_y + 0.5 * diameter + kLabelGap
                : sphere_y - 0.5 * diameter - kLabelGap - name.height;
      const Box box{x - name.width / 2, top, x + name.width / 2,
                    top + name.height};
      const bool free =
          std::none_of(taken->begin(), taken->end(),
                       [&](const Box& o) { return box.Meets(o); });
      if (!free || box.left < 12 || box.right > kMapWidth - 12) continue;
      for (size_t k = 0; k < name.lines.size(); ++k) {
        page->Text(name.lines[k], x, top + kNameHeight + k * NameLines::kLine,
                   kNameHeight, Picture::Align::kCentre);
      }
      taken->push_back(box);
      return;
    }
  }
}

}  // namespace

Rgb8Image MapPage(const EmbeddingMap& map,
                  const std::vector<NamedSphere>& spheres, double exposure) {
  const int n = static_cast<int>(spheres.size());
  Picture page(kMapWidth, kMapHeight);
  DrawMapText(n, map.variance, &page);
  constexpr double kRadius = kMapDiameter / 2.0;
  const Eigen::Array2d low(kMargin + kRadius + 20, kMapTop + kRadius);
  const Eigen::Array2d high(kMapWidth - kMargin - kRadius - 20,
                            kMapHeight - kMapBottom - kRadius - 16);
  const Eigen::MatrixXd places = PlacesOf(map.scores, low, high);
  // Room for a line of text below each sphere, as far as there is.
  const double cell = std::sqrt((high - low).prod() / n);
  const double distance = std::min(kMapDiameter + 40.0, 0.93 * cell);
  const Eigen::MatrixXd at = SpreadApart(places, distance, low, high);
  for (int i = 0; i < n; ++i) {
    page.Line(places(i, 0), places(i, 1), at(i, 0), at(i, 1), kFaintInk);
    page.Dot(places(i, 0), places(i, 1), 2.5, kGreyInk);
  }
  const int diameter =
      static_cast<int>(std::min<double>(kMapDiameter, distance - 6.0));
  // The head of the page, and a strip at its foot.
  std::vector<Box> taken = {
      {0, 0, kMapWidth, 82},
      {0, kMapHeight - kMapBottom, kMapWidth, kMapHeight}};
  for (int i = 0; i < n; ++i) {
    page.Sphere(spheres[i].image, at(i, 0), at(i, 1), diameter, exposure);
    const double r = 0.46 * diameter;
    taken.push_back({at(i, 0) - r, at(i, 1) - r, at(i, 0) + r, at(i, 1) + r});
  }
  for (int i = 0; i < n; ++i) {
    DrawName(NameLines(spheres[i].name, 1.2 * distance), at(i, 0), at(i, 1),
             diameter, &taken, &page);
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
