// What the training materials say about lobes before an image is seen.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "ibrdf/brdf/lobe_mixture.h"
#include "ibrdf/flow/neural_brdf_model.h"

namespace ibrdf {

// Gaussian over the parameters of a LobeMixture, with materials to start from.
struct MaterialPrior {
  struct Material {
    std::string name;
    Eigen::VectorXd parameters;
  };

  Eigen::VectorXd mean;
  Eigen::MatrixXd factor;  // lower; covariance = factor factor^T
  std::vector<Material> materials;
  int code_size = 0;
  // That many materials of the same layout, one's parameters after the other's
  // (RepeatPrior).
  int num_materials = 1;
  // Weight of the wall where the unit ball of codes ends (LobePrior::wall).
  double wall = 30.0;

  int num_parameters() const { return static_cast<int>(mean.size()); }
  // One material's.
  LobeLayout layout() const {
    return LobeLayout::OfSize(mean.size() / num_materials, code_size);
  }
  int num_lobes() const { return layout().num_lobes; }
  // The material of this name; null where there is none.
  const Material* Find(const std::string& name) const;

  // 1/2 |factor^-1 (x - mean)|^2 + 1/2 wall^2 sum_k max(0, |z_k| - 1)^2;
  // gradient (may be null) is added to.
  double Cost(const Eigen::VectorXd& x, Eigen::VectorXd* gradient) const;
  // The least of it over one level added to the log colours of all lobes and
  // channels: what the prior says where a gauge has set the level. The prior
  // must be of one material.
  double CostAtBestLevel(const Eigen::VectorXd& x) const;
  // The wall's part alone, with y = factor^-1 (x - mean) in its place.
  double WallCost(const Eigen::VectorXd& x, Eigen::VectorXd* gradient) const;
  // Adds the wall's Gauss-Newton Hessian to the first rows and columns.
  void AddWallInformation(const Eigen::VectorXd& x,
                          Eigen::MatrixXd* information) const;

 private:
  // Where the code of each lobe that has one begins.
  std::vector<int> FirstOfCodes() const;
};

// Mean and covariance of materials, at least three, of parameters of one size.
// A part of the covariance's off-diagonal is given up, as materials are few.
MaterialPrior GaussianPrior(std::vector<MaterialPrior::Material> materials,
                            int code_size);

// So many lobes of the flow, and a Lambertian one beside them where the model's
// fits have one and are of no more lobes.
LobeLayout FittedLayout(const NeuralBrdfModel& model, int lobes);

// GaussianPrior of the materials' lobes (NeuralBrdfModel::lobe_fits): how
// the codes of two lobes, the colours of both and a Lambertian lobe's go
// together. Lobes beyond those of the fits are independent: codes
// N(0, code_sigma^2 I), colours as the embedding's. Without fits, the first
// lobe has the Gaussian of the materials' mean codes, or that one where there
// are fewer than three materials. layout: FittedLayout, or that without its
// Lambertian lobe; with a number of lobes FittedLayout.
MaterialPrior JointMaterialPrior(const NeuralBrdfModel& model,
                                 const LobeLayout& layout, double code_sigma);
MaterialPrior JointMaterialPrior(const NeuralBrdfModel& model, int lobes,
                                 double code_sigma);

// One material without codes that is known: no step moves its lobes.
MaterialPrior KnownMaterial(const Eigen::VectorXd& parameters);

// The paper's: lobes of the flow alone, codes N(0, code_sigma^2 I), colours as
// the embedding's (Chen et al. 2020, Sec. 4.3).
MaterialPrior BallPrior(const NeuralBrdfModel& model, int lobes,
                        double code_sigma);

}  // namespace ibrdf
