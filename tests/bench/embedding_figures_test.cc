#include "ibrdf/solvers/bench/embedding_figures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>

#include "ibrdf/base/pi.h"
#include "ibrdf/io/model_file.h"
#include "ibrdf/solvers/bench/embedding_map.h"
#include "tests/support/small_embedding.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

constexpr double kRounding = 1e-12;

TEST(PrincipalAxes, FindsThePlaneOfPoints) {
  // Points of an ellipse, half-axes 5 and 2, in a tilted plane of R^4.
  const Eigen::RowVector4d a(0.6, 0.8, 0, 0), b(0, 0, -0.6, 0.8);
  Eigen::MatrixXd points(16, 4);
  for (int i = 0; i < 16; ++i) {
    const double t = 2 * kPi * i / 16;
    points.row(i) = Eigen::RowVector4d(1, 2, 3, 4) + 5 * std::cos(t) * a +
                    2 * std::sin(t) * b;
  }
  const EmbeddingMap map = PrincipalAxes(points);
  EXPECT_NEAR(map.variance[0], 25.0 / 29, kRounding);
  EXPECT_NEAR(map.variance[1], 4.0 / 29, kRounding);
  EXPECT_NEAR(map.variance[2], 0.0, kRounding);
  for (int i = 0; i < 16; ++i) {
    const double t = 2 * kPi * i / 16;
    EXPECT_NEAR(map.scores(i, 0), 5 * std::cos(t), kRounding * 10);
    EXPECT_NEAR(map.scores(i, 1), 2 * std::sin(t), kRounding * 10);
  }
}

TEST(NearestNeighbours, AreInOrder) {
  Eigen::MatrixXd points(4, 1);
  points << 0.0, 10.0, 3.0, 4.0;
  const auto nearest = NearestNeighbours(points, 2);
  ASSERT_EQ(nearest[0].size(), 2u);
  EXPECT_EQ(nearest[0][0].index, 2);
  EXPECT_EQ(nearest[0][1].index, 3);
  EXPECT_EQ(nearest[1][0].index, 3);
  EXPECT_DOUBLE_EQ(nearest[1][0].distance, 6.0);
  EXPECT_EQ(NearestNeighbours(points, 9)[0].size(), 3u);
}

TEST(SpreadApart, LeavesRoomAndStaysInTheBox) {
  std::mt19937 rng(3);
  std::normal_distribution<double> normal(50.0, 4.0);
  Eigen::MatrixXd places(30, 2);
  for (int i = 0; i < 60; ++i) places(i / 2, i % 2) = normal(rng);
  places.row(7) = places.row(8);
  const Eigen::MatrixXd at = SpreadApart(places, 10.0, {0, 0}, {100, 100});
  for (int i = 0; i < 30; ++i) {
    EXPECT_TRUE((at.row(i).array() >= 0.0).all() &&
                (at.row(i).array() <= 100.0).all());
    for (int j = 0; j < i; ++j) {
      EXPECT_GT((at.row(i) - at.row(j)).norm(), 9.9) << i << " " << j;
    }
  }
  // What does not crowd stays.
  Eigen::MatrixXd apart(2, 2);
  apart << 10, 10, 60, 10;
  EXPECT_EQ(SpreadApart(apart, 10.0, {0, 0}, {100, 100}), apart);
}

TEST(Embedding, WritesPicturesAndTables) {
  const TempDir dir;
  EmbeddingOptions options;
  options.model = dir.File("small.ibrdf");
  options.out = dir.File("out");
  options.num_threads = 1;
  options.sphere_size = 16;
  ASSERT_TRUE(WriteModel(SmallEmbedding(4), options.model).ok());
  const Status status = DrawEmbedding(options);
  ASSERT_TRUE(status.ok()) << status.message();
  for (const char* name : {"embedding.png", "walk.png", "neighbours.png"}) {
    EXPECT_EQ(ReadBytes(dir.File(std::string("out/") + name)).substr(1, 3),
              "PNG");
  }
  std::istringstream csv(ReadBytes(dir.File("out/embedding.csv")));
  std::string line;
  int lines = 0;
  while (std::getline(csv, line)) {
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), 13) << line;
    ++lines;
  }
  EXPECT_EQ(lines, 5);
  // Shares of nine components, three of which can differ from 0.
  std::istringstream variance(ReadBytes(dir.File("out/variance.csv")));
  lines = 0;
  while (std::getline(variance, line)) ++lines;
  EXPECT_EQ(lines, 10);

  options.to = "m9";
  EXPECT_EQ(DrawEmbedding(options).code(), StatusCode::kInvalidInput);
}

}  // namespace
}  // namespace ibrdf
