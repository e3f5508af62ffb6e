#include "ibrdf/solvers/illumination/process_illumination.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/priors/directional_lights.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {

constexpr int kProcessHeight = 4, kProcessWidth = 8,
              kProcessTexels = kProcessHeight * kProcessWidth;
constexpr int kSize = 3 * kProcessTexels;
constexpr double kAmplitude = 1.5;
const LightHyperparameters kProcessHyperparameters = {std::log(kAmplitude),
                                                      {-1.0, 0.5, 0.2, -2.0}};
constexpr double kFloat = 6e-8;  // half a unit in the last place, relative

std::vector<float> Random(int size, unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<float> g;
  std::vector<float> out(size);
  for (float& v : out) v = g(rng);
  return out;
}

double Dot(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0.0;
  for (size_t i = 0; i < a.size(); ++i) sum += double{a[i]} * b[i];
  return sum;
}

// Without directional lights and with them.
class ProcessIlluminationTest : public ::testing::TestWithParam<bool> {
 protected:
  std::vector<float> Forward(const std::vector<float>& parameters) {
    LogMap map;
    model_->Forward(parameters.data(), &map);
    return map.values();
  }
  // S.
  Eigen::MatrixXd Jacobian() { return testing::JacobianOf(model_.get()); }
  // What rounding of parameters and outputs to float leaves of each texel.
  Eigen::VectorXd Rounding(const std::vector<float>& parameters,
                           const std::vector<float>& map) {
    const Eigen::Map<const Eigen::VectorXf> w(
        parameters.data(), static_cast<Eigen::Index>(parameters.size()));
    const Eigen::Map<const Eigen::VectorXf> l(map.data(), kSize);
    return kFloat * (Jacobian().cwiseAbs() * w.cwiseAbs().cast<double>() +
                     l.cwiseAbs().cast<double>());
  }

  const LightProcess process_;
  // Beside the centres of two texels.
  const std::vector<Eigen::Vector3d> directional_lights_ =
      GetParam()
          ? std::vector<Eigen::Vector3d>{MapDirection(1.55, 2.52,
                                                      kProcessHeight,
                                                      kProcessWidth),
                                         MapDirection(2.6, 6.45, kProcessHeight,
                                                      kProcessWidth)}
          : std::vector<Eigen::Vector3d>();
  const std::unique_ptr<IlluminationModel> model_ =
      MakeProcessIllumination(kProcessWidth, kProcessHeight, process_,
                              kProcessHyperparameters, directional_lights_);
  const int num_parameters_ = model_->num_parameters();
};

TEST_P(ProcessIlluminationTest, StandardNormalParametersHaveTheProcess) {
  ASSERT_EQ(kSize, model_->num_outputs());
  EXPECT_EQ(std::vector<float>(num_parameters_, 1.0f), model_->PriorStd());
  const std::vector<DirectionalLightTexel> near =
      NearDirectionalLights(directional_lights_, kProcessHeight, kProcessWidth);
  ASSERT_EQ(directional_lights_.size(), near.size());
  ASSERT_EQ(kSize + 3 * static_cast<int>(near.size()), num_parameters_);
  Eigen::VectorXd of_directional_lights = Eigen::VectorXd::Zero(kProcessTexels);
  for (const DirectionalLightTexel& t : near)
    of_directional_lights[t.texel] = t.weight * t.weight;
  const Eigen::MatrixXd S = Jacobian();
  const Eigen::MatrixXd covariance = S * S.transpose();
  const RowMatrix correlation = LightCorrelation(
      kProcessHeight, kProcessWidth, process_, kProcessHyperparameters);
  for (int c = 0; c < 3; ++c) {
    for (int d = 0; d < 3; ++d) {
      Eigen::MatrixXd expected =
          (kAmplitude * process_.Local()(c, d) * correlation).array() +
          process_.Level()(c, d);
      expected.diagonal() +=
          process_.DirectionalLight()(c, d) * of_directional_lights;
      const Eigen::MatrixXd block =
          covariance.block(c * kProcessTexels, d * kProcessTexels,
                           kProcessTexels, kProcessTexels);
      // |S_i| |S_j| times one rounding of each entry.
      EXPECT_LT((block - expected).cwiseAbs().maxCoeff(),
                4 * kFloat * covariance.diagonal().maxCoeff())
          << c << d;
    }
  }
}

TEST_P(ProcessIlluminationTest, TangentsAndAdjointsAreTransposes) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const std::vector<float> v = Random(num_parameters_, seed);
    const std::vector<float> a = Random(kSize, seed + 10);
    LogMap tangent;
    std::vector<float> Ja(num_parameters_);
    model_->Jvp(v.data(), &tangent);
    model_->Vjp(LogMap(model_->size(), a), Ja.data());
    const std::vector<float>& Jv = tangent.values();
    EXPECT_NEAR(Dot(a, Jv), Dot(Ja, v),
                2 * kFloat * std::sqrt(Dot(a, a) * Dot(Jv, Jv)) +
                    2 * kFloat * std::sqrt(Dot(Ja, Ja) * Dot(v, v)));
  }
}

TEST_P(ProcessIlluminationTest, ForwardIsLinearAndItsOwnTangent) {
  EXPECT_EQ(std::vector<float>(kSize, 0.0f),
            Forward(std::vector<float>(num_parameters_, 0.0f)));
  const std::vector<float> p = Random(num_parameters_, 4),
                           q = Random(num_parameters_, 5);
  std::vector<float> sum(num_parameters_);
  LogMap tangent, map;
  for (int i = 0; i < num_parameters_; ++i) sum[i] = p[i] - 2 * q[i];
  const std::vector<float> at_p = Forward(p), at_q = Forward(q);
  const std::vector<float> at_sum = Forward(sum);
  const Eigen::VectorXd rounding =
      Rounding(sum, at_sum) + Rounding(p, at_p) + 2 * Rounding(q, at_q);
  for (int i = 0; i < kSize; ++i) {
    EXPECT_NEAR(double{at_p[i]} - 2 * double{at_q[i]}, at_sum[i], rounding[i]);
  }
  // Wherever it is linearised.
  for (const auto& point : {p, q}) {
    model_->Linearise(point.data(), &map);
    EXPECT_EQ(Forward(point), map.values());
    model_->Jvp(sum.data(), &tangent);
    EXPECT_EQ(at_sum, tangent.values());
  }
}

TEST_P(ProcessIlluminationTest, ConstantMapIsConstantAtAnyLevel) {
  for (const double level : {-30.0, -1.0, 0.0, 0.5, 30.0}) {
    for (const double cast : {0.0, 2.0}) {
      const double rgb[3] = {level + cast, level, level - cast};
      const std::vector<float> p = model_->ConstantMap(rgb);
      const std::vector<float> map = Forward(p);
      const Eigen::VectorXd rounding = Rounding(p, map);
      for (int i = 0; i < kSize; ++i) {
        EXPECT_NEAR(rgb[i / kProcessTexels], map[i], rounding[i]);
      }
    }
  }
}

TEST_P(ProcessIlluminationTest, ShiftMovesEachChannelByItsOwnAmount) {
  const std::vector<float> before = Random(num_parameters_, 6);
  std::vector<float> after = before;
  const double shift[3] = {0.5, -2.0, 7.25};
  model_->ShiftChannels(shift, after.data());
  const std::vector<float> from = Forward(before), to = Forward(after);
  const Eigen::VectorXd rounding = Rounding(before, from) + Rounding(after, to);
  for (int i = 0; i < kSize; ++i) {
    EXPECT_NEAR(shift[i / kProcessTexels], double{to[i]} - from[i],
                rounding[i]);
  }
}

// H v of the texels' information R^T R in every channel, with damping.
Eigen::VectorXd HessianTimes(const Eigen::MatrixXd& jacobian,
                             const Eigen::MatrixXd& rows, double damping,
                             const Eigen::VectorXd& v) {
  const Eigen::VectorXd map = jacobian * v;
  Eigen::VectorXd by_map(map.size());
  for (int c = 0; c < 3; ++c) {
    by_map.segment(c * kProcessTexels, kProcessTexels) =
        rows.transpose() *
        (rows * map.segment(c * kProcessTexels, kProcessTexels));
  }
  return jacobian.transpose() * by_map + (1.0 + damping) * v;
}

// What a point says, mirrored and turned into all positions.
InformationRows InAllTurns(const std::vector<float>& point,
                           Eigen::MatrixXd* rows) {
  InformationRows out;
  out.num_points = 2 * kProcessWidth;
  out.of_channel.fill(
      Eigen::MatrixXf(out.num_points * kProcessHeight, kProcessWidth));
  rows->resize(out.num_points, kProcessTexels);
  for (int turn = 0; turn < out.num_points; ++turn) {
    for (int t = 0; t < kProcessTexels; ++t) {
      const int y = t / kProcessWidth;
      const int turned = (t + turn) % kProcessWidth;
      const int x = turn < kProcessWidth ? turned : kProcessWidth - 1 - turned;
      for (Eigen::MatrixXf& of_channel : out.of_channel) {
        of_channel(turn * kProcessHeight + y, x) = point[t];
      }
      (*rows)(turn, y * kProcessWidth + x) = point[t];
    }
  }
  return out;
}

TEST_P(ProcessIlluminationTest, PreconditionerInvertsWhatIsAlikeAtAllTurns) {
  std::vector<float> point = Random(kProcessTexels, 5);
  for (float& v : point) v *= 3.0f;
  Eigen::MatrixXd rows;
  const InformationRows information = InAllTurns(point, &rows);
  const std::unique_ptr<LightPreconditioner> preconditioner =
      model_->Preconditioner([&] { return information; });
  ASSERT_NE(nullptr, preconditioner);
  for (const double damping : {0.0, 1e-3, 4.0}) {
    preconditioner->Damp(damping);
    const std::vector<float> v = Random(num_parameters_, 6);
    Eigen::VectorXd x =
        Eigen::Map<const Eigen::VectorXf>(v.data(), num_parameters_)
            .cast<double>();
    // Directional lights take no part in it.
    x.tail(num_parameters_ - kSize).setZero();
    Eigen::VectorXd r = HessianTimes(Jacobian(), rows, damping, x);
    const double size = r.norm();
    r.tail(num_parameters_ - kSize).setZero();
    Eigen::VectorXd z(num_parameters_);
    preconditioner->Apply(r.data(), z.data());
    EXPECT_GT(size, 20.0 * x.norm());
    EXPECT_LT((z - x).norm(), 1e-3 * x.norm()) << damping;
    // Of which the diagonal alone counts.
    for (int i = kSize; i < num_parameters_; ++i) {
      const Eigen::VectorXd unit = Eigen::VectorXd::Unit(num_parameters_, i);
      preconditioner->Apply(unit.data(), z.data());
      const double diagonal = HessianTimes(Jacobian(), rows, damping, unit)[i];
      EXPECT_NEAR(1.0 / diagonal, z[i], 1e-4 / diagonal);
      EXPECT_EQ(1, (z.array() != 0.0).count());
    }
  }
}

TEST_P(ProcessIlluminationTest, WithoutRowsThereIsNoPreconditioner) {
  EXPECT_EQ(nullptr, model_->Preconditioner([] { return InformationRows(); }));
}

INSTANTIATE_TEST_SUITE_P(DirectionalLights, ProcessIlluminationTest,
                         ::testing::Bool());

// At the size of an estimate, and far above it.
TEST(ProcessIllumination, LargeMapsAreConstantToo) {
  for (const int width : {2, 64, 128}) {
    const int height = width / 2;
    const std::unique_ptr<IlluminationModel> model =
        MakeProcessIllumination(width, height, LightProcess(), {std::log(0.3)});
    for (const double level : {-30.0, 30.0}) {
      const double rgb[3] = {level, level + 1, level - 1};
      const std::vector<float> p = model->ConstantMap(rgb);
      LogMap log_map;
      model->Forward(p.data(), &log_map);
      const std::vector<float>& map = log_map.values();
      double worst = 0.0;
      for (size_t i = 0; i < map.size(); ++i) {
        worst = std::max(worst, std::abs(map[i] - rgb[i / (map.size() / 3)]));
      }
      // Roundings of parameters of size up to 30 and of the map, some units
      // of 2e-6 in the last place.
      EXPECT_LT(worst, 1e-5) << width;
    }
  }
}

}  // namespace
}  // namespace ibrdf
