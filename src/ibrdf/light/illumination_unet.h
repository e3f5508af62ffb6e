// Deep illumination prior: an equirectangular log-radiance map as the output of
// an encoder-decoder network of a fixed noise (Chen et al. 2020, Sec. 5), with
// its derivative products by hand.
//
// Differs from the paper's network: instance instead of batch normalisation
// (there is one map), a smooth activation, evenly placed 4 x 4 taps where a map
// is halved, and maps that continue over the poles.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "ibrdf/base/simd_dispatch.h"
#include "ibrdf/light/illumination_unet_plan.h"

namespace ibrdf {

class UnetEngine;
struct UnetBuffers;
template <typename T>
class UnetReference;

// Immutable after construction: const methods may run at the same time in many
// threads, each with its own Workspace and Scratch.
class IlluminationUnet {
 public:
  // Invalid sizes (see MakeUnetPlan) are a bug of the caller.
  explicit IlluminationUnet(const IlluminationUnetOptions& options);

  // With the caller's noise [noise channel][row][column] and instruction set.
  IlluminationUnet(const IlluminationUnetOptions& options,
                   std::vector<float> noise,
                   SimdLevel level = ActiveSimdLevel());
  ~IlluminationUnet();
  IlluminationUnet(const IlluminationUnet&) = delete;
  IlluminationUnet& operator=(const IlluminationUnet&) = delete;

  const IlluminationUnetOptions& options() const { return options_; }
  const std::vector<float>& noise() const { return noise_; }

  // Layout of the weights by name: plan().blocks; scales in use: plan().scales.
  const UnetPlan& plan() const { return plan_; }
  int num_weights() const { return plan_.num_weights; }
  int num_outputs() const { return 3 * options_.height * options_.width; }

  // A draw from the prior, but with a last layer of zeros: the map is constant,
  // log L = 0, until the last three weights, the biases of R, G, B, are set.
  std::vector<float> InitialWeights(uint64_t seed) const;

  // Standard deviation of every weight under a zero-mean Gaussian prior that
  // keeps the variance of features about 1 from layer to layer; > 0.
  std::vector<float> PriorStd() const;

  // What Forward leaves for the products. Sized at its first use by a network
  // and again when another network uses it.
  class Workspace {
   public:
    Workspace();
    ~Workspace();
    Workspace(Workspace&&) noexcept;
    Workspace& operator=(Workspace&&) noexcept;

   private:
    friend class IlluminationUnet;
    std::unique_ptr<UnetBuffers> buffers_;
  };

  // Room for one product at a time; not the Workspace of Forward.
  using Scratch = Workspace;

  // log_radiance: [3][row][column], overwritten.
  void Forward(const float* weights, Workspace* workspace,
               float* log_radiance) const;

  // Derivative of log-radiance, [3][row][column], along `tangent`
  // [num_weights], at the weights of the last Forward into `workspace`.
  void Jvp(const float* tangent, const Workspace& workspace, Scratch* scratch,
           float* d_log_radiance) const;

  // Gradient [num_weights] of sum(adjoint * log-radiance), adjoint
  // [3][row][column], at the weights of the last Forward into `workspace`.
  void Vjp(const float* adjoint, const Workspace& workspace, Scratch* scratch,
           float* weight_gradient) const;

 private:
  const IlluminationUnetOptions options_;
  const UnetPlan plan_;
  const std::vector<float> noise_;
  const std::unique_ptr<const UnetEngine> engine_;
  // In place of the engine's passes at SimdLevel::kDouble, else null.
  const std::unique_ptr<const UnetReference<double>> plain_;
};

}  // namespace ibrdf
