#include "ibrdf/solvers/segmentation/material_pixels.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "ibrdf/solvers/observation/normal_bins.h"

namespace ibrdf {
namespace {

// Neighbours whose logs differ by less are drawn to one material.
constexpr double kEdge = 0.25;
constexpr double kNeighbour = 3.0;
// The bilateral filter: pixels across, and deviations of logs and of pixels.
constexpr int kFilterSize = 5;
constexpr double kFilterLog = 0.15, kFilterPixels = 2.0;
// The log where the object is not: far from any radiance of it.
constexpr float kNoLog = -1e4f;

// The sums over a block's points.
struct Block {
  int points = 0;
  Eigen::Vector3d log = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  int pixel = -1;  // of MaterialPixels
};

// The image in blocks.
class BlockGrid {
 public:
  BlockGrid(int width, int height, int block)
      : width_((width + block - 1) / block),
        height_((height + block - 1) / block),
        image_width_(width),
        block_(block),
        blocks_(static_cast<size_t>(width_) * height_) {}

  int width() const { return width_; }
  int height() const { return height_; }
  Block& Of(const ShadingPoint& point) {
    return At(point.pixel % image_width_ / block_,
              point.pixel / image_width_ / block_);
  }
  Block& At(int x, int y) {
    return blocks_[static_cast<size_t>(y) * width_ + x];
  }
  // -1: none is there.
  int PixelAt(int x, int y) const {
    return x < 0 || x >= width_ || y >= height_
               ? -1
               : blocks_[static_cast<size_t>(y) * width_ + x].pixel;
  }

 private:
  const int width_, height_, image_width_, block_;
  std::vector<Block> blocks_;
};

// As in searches.
bool TakesPart(const ShadingPoint& point) {
  return point.normal.dot(point.wo) >= NormalBinOptions().min_cosine;
}

// Where the pixels are in the grid.
using Places = std::vector<Eigen::Vector2i>;

// Numbers the blocks that take part, row by row.
Places NumberBlocks(int block, BlockGrid* grid) {
  const int least = (block * block + 1) / 2;
  Places places;
  for (int y = 0; y < grid->height(); ++y) {
    for (int x = 0; x < grid->width(); ++x) {
      Block& b = grid->At(x, y);
      if (b.points < least) continue;
      b.pixel = static_cast<int>(places.size());
      places.emplace_back(x, y);
    }
  }
  return places;
}

// Axes of log colour in rows.
Eigen::Matrix3d ColourAxes() {
  Eigen::Matrix3d axes;
  axes << 1, 1, 1, 1, -1, 0, 1, 1, -2;
  return axes.rowwise().normalized();
}

Eigen::MatrixX3d SmoothLogs(const Eigen::MatrixX3d& logs, const Places& places,
                            const BlockGrid& grid) {
  cv::Mat image(grid.height(), grid.width(), CV_32FC3,
                cv::Scalar(kNoLog, kNoLog, kNoLog));
  for (size_t i = 0; i < places.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      image.at<cv::Vec3f>(places[i].y(), places[i].x())[c] =
          static_cast<float>(logs(i, c));
    }
  }
  cv::Mat filtered;
  cv::bilateralFilter(image, filtered, kFilterSize, kFilterLog, kFilterPixels);
  Eigen::MatrixX3d smooth(logs.rows(), 3);
  for (size_t i = 0; i < places.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      smooth(i, c) = filtered.at<cv::Vec3f>(places[i].y(), places[i].x())[c];
    }
  }
  return smooth;
}

std::vector<PixelPair> PairsOf(const Eigen::MatrixX3d& logs,
                               const Places& places, const BlockGrid& grid) {
  constexpr int kBeside[4][2] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}};
  std::vector<PixelPair> pairs;
  for (size_t i = 0; i < places.size(); ++i) {
    for (const auto& [right, down] : kBeside) {
      const int second =
          grid.PixelAt(places[i].x() + right, places[i].y() + down);
      if (second < 0) continue;
      const double step =
          (logs.row(i) - logs.row(second)).cwiseAbs().maxCoeff() / kEdge;
      pairs.push_back({static_cast<int>(i), second, right * down == 0,
                       kNeighbour * std::exp(-step * step)});
    }
  }
  return pairs;
}

}  // namespace

MaterialPixels GatherPixels(const std::vector<ShadingPoint>& points,
                            const Observations& observed, int image_width,
                            int block) {
  CHECK(image_width > 0 && block > 0);
  CHECK_EQ(observed.radiance.size(), 3 * points.size());
  int last = 0;
  for (const ShadingPoint& p : points) last = std::max(last, p.pixel);
  BlockGrid grid(image_width, last / image_width + 1, block);
  for (size_t i = 0; i < points.size(); ++i) {
    if (!observed.valid[i] || !TakesPart(points[i])) continue;
    Block& b = grid.Of(points[i]);
    ++b.points;
    b.log += Eigen::Map<const Eigen::Array3d>(&observed.radiance[3 * i])
                 .log()
                 .matrix();
    b.normal += points[i].normal.cast<double>();
  }
  MaterialPixels out;
  const Places places = NumberBlocks(block, &grid);
  const auto count = static_cast<Eigen::Index>(places.size());
  Eigen::MatrixX3d logs(count, 3);
  out.normals.resize(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Block& b = grid.At(places[i].x(), places[i].y());
    logs.row(i) = b.log.transpose() / b.points;
    out.normals.row(i) = b.normal.normalized().transpose();
  }
  for (size_t i = 0; i < points.size(); ++i) {
    const bool part = observed.valid[i] && TakesPart(points[i]);
    out.pixel_of_point.push_back(part ? grid.Of(points[i]).pixel : -1);
  }
  out.colours = logs * ColourAxes().transpose();
  out.smooth = SmoothLogs(logs, places, grid);
  out.neighbours = PairsOf(logs, places, grid);
  return out;
}

}  // namespace ibrdf
