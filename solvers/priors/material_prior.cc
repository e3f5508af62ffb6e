#include "ibrdf/solvers/priors/material_prior.h"

#include <glog/logging.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/solvers/priors/embedding_prior.h"

namespace ibrdf {
namespace {

// Share of the off-diagonal covariance that is given up: some 90 materials
// stand for 38 dimensions.
constexpr double kShrinkage = 0.2;
// Log colour of lobes beyond a material's own, relative to its last lobe's.
constexpr double kExtraLobe = -3.0;
// Their codes start within so many of the prior's standard deviations, in each
// dimension's mean: a narrow prior would otherwise start at an infinite cost.
constexpr double kExtraDeviations = 2.0;

// Lobes of every material: those of its fit as far as the layout has them, or
// one of its mean code.
std::vector<MaterialPrior::Material> FittedMaterials(
    const NeuralBrdfModel& model, const LobeLayout& layout) {
  std::vector<MaterialPrior::Material> materials;
  if (model.fit_lobes == 0 || layout.num_coded() < model.fit_lobes) {
    const LobeLayout one = {1, model.shape.code_size()};
    const std::vector<MaterialCode> codes = MaterialCodes(model);
    for (size_t m = 0; m < codes.size(); ++m) {
      MaterialPrior::Material material{codes[m].name,
                                       Eigen::VectorXd(one.num_parameters())};
      const MutableLobeMixture lobe(one, material.parameters.data());
      lobe.code(0) = ToEigen(codes[m].code);
      for (int c = 0; c < 3; ++c) {
        lobe.log_colour(0)[c] = model.log_colours[3 * m + c];
      }
      materials.push_back(std::move(material));
    }
    return materials;
  }
  const LobeLayout taken = {model.fit_lobes + (layout.lambertian ? 1 : 0),
                            model.shape.code_size(), layout.lambertian};
  for (int m = 0; m < model.num_materials(); ++m) {
    const std::string& name = model.names[static_cast<size_t>(3) * m];
    materials.push_back(
        {name.substr(0, name.rfind('.')),
         Eigen::Map<const Eigen::VectorXf>(
             &model.lobe_fits[m * model.fit_size()], taken.num_parameters())
             .cast<double>()});
  }
  return materials;
}

// Appends a lobe like the last with a code but fainter, its code no longer than
// `longest`; a Lambertian lobe stays last.
void AddLobe(int code_size, double longest, Eigen::VectorXd* parameters) {
  const LobeLayout before = LobeLayout::OfSize(parameters->size(), code_size);
  const LobeLayout layout = {before.num_lobes + 1, code_size,
                             before.lambertian};
  const int added = before.num_coded();
  const Eigen::VectorXd old = *parameters;
  parameters->resize(layout.num_parameters());
  const LobeMixture from(before, old.data());
  const MutableLobeMixture lobes(layout, parameters->data());
  for (int k = 0; k < added; ++k) lobes.lobe(k) = from.lobe(k);
  lobes.lobe(added) = from.lobe(added - 1);
  const double norm = lobes.code(added).norm();
  if (norm > longest) lobes.code(added) *= longest / norm;
  lobes.log_colour(added) += kExtraLobe;
  if (layout.lambertian) lobes.lobe(added + 1) = from.lobe(added);
}

// Codes N(0, code_sigma^2 I), colours as the embedding's.
MaterialPrior IndependentPrior(const NeuralBrdfModel& model,
                               const LobeLayout& layout, double code_sigma) {
  const LobePrior embedding = EmbeddingPrior(model, code_sigma);
  const int size = layout.code_size;
  MaterialPrior prior;
  prior.code_size = size;
  prior.mean = Eigen::VectorXd::Zero(layout.num_parameters());
  Eigen::VectorXd std =
      Eigen::VectorXd::Constant(prior.mean.size(), code_sigma);
  const MutableLobeMixture of_mean(layout, prior.mean.data());
  const MutableLobeMixture of_std(layout, std.data());
  for (int k = 0; k < layout.num_lobes; ++k) {
    of_mean.log_colour(k) =
        Eigen::Map<const Eigen::Array3d>(embedding.colour_mean);
    of_std.log_colour(k).setConstant(embedding.colour_sigma);
  }
  prior.factor = std.asDiagonal();
  prior.materials = FittedMaterials(model, layout);
  const double longest =
      kExtraDeviations * code_sigma * std::sqrt(static_cast<double>(size));
  for (MaterialPrior::Material& m : prior.materials) {
    while (m.parameters.size() < prior.mean.size()) {
      AddLobe(size, longest, &m.parameters);
    }
  }
  return prior;
}

// The deviation of a known material's parameters: no step or derivative tells
// it from 0.
constexpr double kKnownStd = 1e-9;

}  // namespace

std::vector<int> MaterialPrior::FirstOfCodes() const {
  const LobeLayout of_one = layout();
  std::vector<int> first;
  for (int m = 0; m < num_materials; ++m) {
    for (int k = 0; k < of_one.num_coded(); ++k) {
      first.push_back(m * of_one.num_parameters() + of_one.code(k));
    }
  }
  return first;
}

double MaterialPrior::WallCost(const Eigen::VectorXd& x,
                               Eigen::VectorXd* gradient) const {
  double cost = 0.0;
  for (const int first : FirstOfCodes()) {
    const auto z = x.segment(first, code_size);
    const double norm = z.norm();
    if (norm <= 1.0) continue;
    cost += 0.5 * wall * wall * (norm - 1.0) * (norm - 1.0);
    if (gradient != nullptr) {
      gradient->segment(first, code_size) +=
          wall * wall * (norm - 1.0) / norm * z;
    }
  }
  return cost;
}

void MaterialPrior::AddWallInformation(const Eigen::VectorXd& x,
                                       Eigen::MatrixXd* information) const {
  for (const int first : FirstOfCodes()) {
    const Eigen::VectorXd z = x.segment(first, code_size);
    if (z.norm() <= 1.0) continue;
    const Eigen::VectorXd outward = wall * z.normalized();
    information->block(first, first, code_size, code_size) +=
        outward * outward.transpose();
  }
}

const MaterialPrior::Material* MaterialPrior::Find(
    const std::string& name) const {
  const auto at = std::find_if(materials.begin(), materials.end(),
                               [&](const auto& m) { return m.name == name; });
  return at != materials.end() ? &*at : nullptr;
}

double MaterialPrior::Cost(const Eigen::VectorXd& x,
                           Eigen::VectorXd* gradient) const {
  const auto lower = factor.triangularView<Eigen::Lower>();
  const Eigen::VectorXd y = lower.solve(x - mean);
  if (gradient != nullptr) *gradient += lower.transpose().solve(y);
  return 0.5 * y.squaredNorm() + WallCost(x, gradient);
}

double MaterialPrior::CostAtBestLevel(const Eigen::VectorXd& x) const {
  const auto lower = factor.triangularView<Eigen::Lower>();
  const Eigen::VectorXd y = lower.solve(x - mean);
  Eigen::VectorXd level = Eigen::VectorXd::Zero(x.size());
  MutableLobeMixture(layout(), level.data())
      .ShiftColours(Eigen::Array3d::Ones());
  const Eigen::VectorXd along = lower.solve(level).normalized();
  return 0.5 * (y - y.dot(along) * along).squaredNorm() + WallCost(x, nullptr);
}

MaterialPrior KnownMaterial(const Eigen::VectorXd& parameters) {
  const Eigen::Index n = parameters.size();
  MaterialPrior prior;
  prior.mean = parameters;
  prior.factor = kKnownStd * Eigen::MatrixXd::Identity(n, n);
  prior.materials.push_back({"known", parameters});
  return prior;
}

MaterialPrior BallPrior(const NeuralBrdfModel& model, int lobes,
                        double code_sigma) {
  return IndependentPrior(model, {lobes, model.shape.code_size()}, code_sigma);
}

LobeLayout FittedLayout(const NeuralBrdfModel& model, int lobes) {
  const LobeLayout layout = {lobes, model.shape.code_size()};
  return model.fit_lambertian && lobes >= model.fit_lobes
             ? layout.WithLambertian()
             : layout;
}

MaterialPrior JointMaterialPrior(const NeuralBrdfModel& model,
                                 const LobeLayout& layout, double code_sigma) {
  CHECK(!layout.lambertian || FittedLayout(model, layout.num_coded()) == layout)
      << "no Lambertian lobe was fitted to the materials";
  MaterialPrior prior = IndependentPrior(model, layout, code_sigma);
  const std::vector<MaterialPrior::Material> materials =
      FittedMaterials(model, layout);
  if (materials.size() < 3) return prior;
  const MaterialPrior own = GaussianPrior(materials, prior.code_size);
  // The lobes of the fits come first, but their Lambertian one last.
  const Eigen::Index plain = layout.lambertian ? 3 : 0;
  const Eigen::Index size = own.mean.size() - plain;
  prior.mean.head(size) = own.mean.head(size);
  prior.mean.tail(plain) = own.mean.tail(plain);
  prior.factor.topLeftCorner(size, size) = own.factor.topLeftCorner(size, size);
  prior.factor.bottomLeftCorner(plain, size) =
      own.factor.bottomLeftCorner(plain, size);
  prior.factor.bottomRightCorner(plain, plain) =
      own.factor.bottomRightCorner(plain, plain);
  return prior;
}

MaterialPrior JointMaterialPrior(const NeuralBrdfModel& model, int lobes,
                                 double code_sigma) {
  return JointMaterialPrior(model, FittedLayout(model, lobes), code_sigma);
}

MaterialPrior GaussianPrior(std::vector<MaterialPrior::Material> materials,
                            int code_size) {
  CHECK_GE(materials.size(), 3u);
  const Eigen::Index size = materials.front().parameters.size();
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(size);
  for (const MaterialPrior::Material& m : materials) mean += m.parameters;
  mean /= static_cast<double>(materials.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
  for (const MaterialPrior::Material& m : materials) {
    const Eigen::VectorXd d = m.parameters - mean;
    covariance += d * d.transpose() / (materials.size() - 1.0);
  }
  // A dimension in which the materials do not differ is not known exactly.
  const Eigen::VectorXd variance = covariance.diagonal().cwiseMax(1e-4);
  covariance *= 1.0 - kShrinkage;
  covariance.diagonal() = variance;
  const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
  CHECK(llt.info() == Eigen::Success);
  MaterialPrior prior;
  prior.mean = mean;
  prior.factor = llt.matrixL();
  prior.materials = std::move(materials);
  prior.code_size = code_size;
  return prior;
}

}  // namespace ibrdf
