#include "ibrdf/solvers/bench/embedding_pages.h"

#include <algorithm>
#include <cmath>

#include "ibrdf/base/format.h"
#include "ibrdf/solvers/drawing/picture.h"

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

// One page of an embedding, drawn in layers.
class MapDrawing {
 public:
  MapDrawing(const EmbeddingMap& map, const std::vector<NamedSphere>& spheres,
             double exposure)
      : map_(map),
        spheres_(spheres),
        exposure_(exposure),
        n_(static_cast<int>(spheres.size())),
        page_(kWidth, kHeight) {
    PlaceSpheres();
  }

  Rgb8Image Draw() {
    DrawHead();
    DrawAxes();
    DrawPlaces();
    DrawSpheres();
    for (int i = 0; i < n_; ++i) DrawName(i);
    return page_.ToImage();
  }

 private:
  static constexpr int kWidth = 1600, kHeight = 1200, kDiameter = 68;
  static constexpr double kTop = 96.0, kBottom = 60.0, kLabelGap = 3.0;

  // One scale for both axes would leave a band: axes are scaled by themselves.
  void PlaceSpheres() {
    const double radius = kDiameter / 2.0;
    const Eigen::Array2d low(kMargin + radius + 20, kTop + radius);
    const Eigen::Array2d high(kWidth - kMargin - radius - 20,
                              kHeight - kBottom - radius - 16);
    places_.resize(n_, 2);
    for (int k = 0; k < 2; ++k) {
      const Eigen::VectorXd scores = map_.scores.col(k);
      const double span =
          std::max(scores.maxCoeff() - scores.minCoeff(), 1e-12);
      for (int i = 0; i < n_; ++i) {
        const double t = (scores[i] - scores.minCoeff()) / span;
        places_(i, k) =
            k == 0 ? low[0] + t * (high[0] - low[0])
                   : high[1] - t * (high[1] - low[1]);  // up is positive
      }
    }
    // Room for a line of text below each sphere, as far as there is.
    const double cell = std::sqrt((high - low).prod() / n_);
    distance_ = std::min(kDiameter + 40.0, 0.93 * cell);
    diameter_ = static_cast<int>(std::min<double>(kDiameter, distance_ - 6.0));
    at_ = SpreadApart(places_, distance_, low, high);
  }

  void DrawHead() {
    page_.Text("Embedding of the materials, first two principal axes", kMargin,
               48.0, kTitleHeight);
    const std::string note = Format(
        "%d materials; codes of the three channels in a row. Spheres "
        "that would overlap are moved; a line leads to the place.",
        n_);
    page_.Text(note, kMargin, 74.0, kTextHeight, Picture::Align::kLeft,
               kGreyInk);
  }

  void DrawAxes() {
    page_.Line(kMargin, kHeight - kBottom + 8, kWidth - kMargin,
               kHeight - kBottom + 8, kFaintInk);
    page_.Text(
        Format("axis 1: %.1f %% of the variance", 100.0 * map_.variance[0]),
        kWidth - kMargin, kHeight - kBottom + 32, kTextHeight,
        Picture::Align::kRight, kGreyInk);
    page_.Text(Format("axis 2, upwards: %.1f %% of the variance",
                      100.0 * map_.variance[1]),
               kMargin, kHeight - kBottom + 32, kTextHeight,
               Picture::Align::kLeft, kGreyInk);
  }

  // Where the spheres belong, and lines to where they are.
  void DrawPlaces() {
    for (int i = 0; i < n_; ++i) {
      page_.Line(places_(i, 0), places_(i, 1), at_(i, 0), at_(i, 1), kFaintInk);
      page_.Dot(places_(i, 0), places_(i, 1), 2.5, kGreyInk);
    }
  }

  void DrawSpheres() {
    // The head of the page, and a strip at its foot.
    taken_ = {{0, 0, kWidth, 82}, {0, kHeight - kBottom, kWidth, kHeight}};
    for (int i = 0; i < n_; ++i) {
      page_.Sphere(spheres_[i].image, at_(i, 0), at_(i, 1), diameter_,
                   exposure_);
      const double r = 0.46 * diameter_;
      taken_.push_back(
          {at_(i, 0) - r, at_(i, 1) - r, at_(i, 0) + r, at_(i, 1) + r});
    }
  }

  bool IsFree(const Box& box) const {
    return box.left >= 12 && box.right <= kWidth - 12 &&
           std::none_of(taken_.begin(), taken_.end(),
                        [&](const Box& o) { return box.Meets(o); });
  }

  // Below the sphere, above it, and either with a shift to a side; where
  // nothing is free the csv has to do.
  void DrawName(int i) {
    const std::vector<std::string> lines =
        WrapName(spheres_[i].name, 1.2 * distance_, kNameHeight);
    double width = 0.0;
    for (const std::string& text : lines) {
      width = std::max(width, Picture::TextWidth(text, kNameHeight));
    }
    const double line = kNameHeight + 4.0;
    const double height = line * static_cast<double>(lines.size());
    const double shift = 0.35 * diameter_;
    for (const double aside : {0.0, shift, -shift}) {
      for (const bool below : {true, false}) {
        const double x = at_(i, 0) + aside;
        const double top =
            below ? at_(i, 1) + 0.5 * diameter_ + kLabelGap
                  : at_(i, 1) - 0.5 * diameter_ - kLabelGap - height;
        const Box box{x - width / 2, top, x + width / 2, top + height};
        if (!IsFree(box)) continue;
        for (size_t k = 0; k < lines.size(); ++k) {
          page_.Text(lines[k], x, top + kNameHeight + k * line, kNameHeight,
                     Picture::Align::kCentre);
        }
        taken_.push_back(box);
        return;
      }
    }
  }

  const EmbeddingMap& map_;
  const std::vector<NamedSphere>& spheres_;
  const double exposure_;
  const int n_;
  Picture page_;
  Eigen::MatrixXd places_, at_;  // [n, 2], pixels
  double distance_ = 0.0;        // between centres, at least
  int diameter_ = 0;
  std::vector<Box> taken_;
};

// Rows of materials and their neighbours.
class NeighbourDrawing {
 public:
  NeighbourDrawing(const std::vector<NeighbourRow>& rows, double exposure)
      : rows_(rows),
        exposure_(exposure),
        measured_(std::any_of(
            rows.begin(), rows.end(),
            [](const NeighbourRow& row) { return !row.measured.empty(); })),
        first_(measured_ ? 2 : 1),
        page_(Width(), static_cast<int>(kTop) +
                           static_cast<int>(rows.size()) * kStepY + 10) {}

  Rgb8Image Draw() {
    DrawHead();
    for (size_t r = 0; r < rows_.size(); ++r) {
      DrawRow(rows_[r], kTop + r * kStepY + kDiameter / 2.0);
    }
    return page_.ToImage();
  }

 private:
  static constexpr int kDiameter = 116, kStepX = 184, kStepY = 176;
  static constexpr double kTop = 116.0;
  static constexpr double kGap = 40.0;  // between materials and neighbours

  int Width() const {
    size_t most = 0;
    for (const NeighbourRow& row : rows_) {
      most = std::max(most, row.neighbours.size());
    }
    return static_cast<int>(2 * kMargin + kGap) +
           (first_ + static_cast<int>(most)) * kStepX;
  }

  double Column(int c) const {
    return kMargin + (c + 0.5) * kStepX + (c >= first_ ? kGap : 0.0);
  }

  void DrawHead() {
    page_.Text("Nearest neighbours in code space", kMargin, 46.0, kTitleHeight);
    page_.Text("Materials from matte to glossy; numbers are distances.",
               kMargin, 72.0, kTextHeight, Picture::Align::kLeft, kGreyInk);
    if (measured_) {
      page_.Text("measured", Column(0), kTop - 14, kTextHeight,
                 Picture::Align::kCentre, kGreyInk);
    }
    page_.Text("model", Column(first_ - 1), kTop - 14, kTextHeight,
               Picture::Align::kCentre, kGreyInk);
    const double divider = kMargin + first_ * kStepX + kGap / 2;
    page_.Line(divider, kTop - 28, divider, kTop + rows_.size() * kStepY - 16,
               kFaintInk);
  }

  // Returns the baseline below the name.
  double DrawSphere(const Image& image, const std::string& name, int column,
                    double y) {
    page_.Sphere(image, Column(column), y, kDiameter, exposure_);
    double baseline = y + kDiameter / 2.0 + 17;
    for (const std::string& line : WrapName(name, kStepX - 10.0, kNameHeight)) {
      page_.Text(line, Column(column), baseline, kNameHeight,
                 Picture::Align::kCentre);
      baseline += kNameHeight + 5.0;
    }
    return baseline;
  }

  void DrawRow(const NeighbourRow& row, double y) {
    if (!row.measured.empty())
      DrawSphere(row.measured, row.material.name, 0, y);
    DrawSphere(row.material.image, row.material.name, first_ - 1, y);
    for (size_t k = 0; k < row.neighbours.size(); ++k) {
      const int c = first_ + static_cast<int>(k);
      const double baseline =
          DrawSphere(row.neighbours[k].image, row.neighbours[k].name, c, y);
      page_.Text(Format("%.2f", row.distances[k]), Column(c), baseline + 1,
                 kNameHeight, Picture::Align::kCentre, kGreyInk);
    }
  }

  const std::vector<NeighbourRow>& rows_;
  const double exposure_;
  const bool measured_;
  const int first_;  // column of the nearest
  Picture page_;
};

}  // namespace

Rgb8Image MapPage(const EmbeddingMap& map,
                  const std::vector<NamedSphere>& spheres, double exposure) {
  return MapDrawing(map, spheres, exposure).Draw();
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
  return NeighbourDrawing(rows, exposure).Draw();
}

}  // namespace ibrdf
