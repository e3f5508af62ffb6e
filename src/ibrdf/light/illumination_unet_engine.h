// Fast float passes over a UNet plan; see illumination_unet.h for the meaning
// of the products.
#pragma once
#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

#include "ibrdf/light/illumination_unet_kernels.h"
#include "ibrdf/light/illumination_unet_plan.h"
#include "ibrdf/light/illumination_unet_reference.h"

namespace ibrdf {

// Cache-line alignment, so that no vector load straddles two lines.
template <typename T>
struct CacheLineAllocator {
  using value_type = T;
  CacheLineAllocator() = default;
  template <typename U>
  CacheLineAllocator(const CacheLineAllocator<U>&) {}  // NOLINT
  T* allocate(size_t n) {
    return static_cast<T*>(::operator new(n * sizeof(T), std::align_val_t(64)));
  }
  void deallocate(T* p, size_t) { ::operator delete(p, std::align_val_t(64)); }
  bool operator==(const CacheLineAllocator&) const { return true; }
  bool operator!=(const CacheLineAllocator&) const { return false; }
};
using UnetBuffer = std::vector<float, CacheLineAllocator<float>>;

// Channels of a map or of weights in memory, the rest of a group zero.
inline int PadUnetChannels(int channels) {
  return (channels + kUnetChannelGroup - 1) / kUnetChannelGroup *
         kUnetChannelGroup;
}

// A feature map (or its tangent or adjoint) with a border of one texel:
// [row -1 ... height][column -1 ... width][stride].
struct UnetMap {
  float* data;  // of texel (-1, -1)
  int channels;
  int height;
  int width;
  int stride;  // floats per texel

  int64_t row_stride() const {
    return static_cast<int64_t>(width + 2) * stride;
  }
  float* At(int row, int column) const {
    return data + (row + 1) * row_stride() +
           static_cast<int64_t>(column + 1) * stride;
  }
};

// Buffers of one pass; empty until first used.
struct UnetBuffers {
  std::vector<UnetBuffer> maps;               // by tensor
  std::vector<UnetBuffer> slopes;             // of activations, by step
  std::vector<UnetBuffer> normalized;         // sums, by step
  std::vector<UnetBuffer> inverse_deviation;  // by step and channel
  UnetBuffer weights;                         // packed, or their tangent
  UnetBuffer transposed;                      // packed
  UnetBuffer gradient;                        // packed
  uint64_t owner = 0;  // id of the engine that sized them
  // What SimdLevel::kDouble has in place of all that.
  UnetReferencePass<double> plain;
  std::vector<double> plain_weights;
};

class UnetEngine {
 public:
  // noise: [noise channel][row][column]. plan and kernels must outlive this.
  UnetEngine(const UnetPlan& plan, const std::vector<float>& noise,
             int num_threads, const UnetKernels& kernels);

  void Forward(const float* weights, UnetBuffers* forward,
               float* log_radiance) const;
  void Jvp(const float* tangent, const UnetBuffers& forward,
           UnetBuffers* scratch, float* d_log_radiance) const;
  void Vjp(const float* adjoint, const UnetBuffers& forward,
           UnetBuffers* scratch, float* weight_gradient) const;

 private:
  // Where a step's weights lie in the packed buffers, floats. Channel counts
  // are padded with zeros to kUnetChannelGroup.
  struct Packing {
    int64_t bias;                     // [out]
    std::vector<int64_t> weights;     // by input: [tap][in, unpadded][out]
    std::vector<int64_t> transposed;  // by input: [tap][out, unpadded][in]
    std::vector<int64_t> gradient;    // by input: [tap][in][out]
  };
  // The weights that meet one input: the part of the concatenation it is.
  struct InputSlice {
    int first_channel;
    int channels;
  };

  UnetMap MapOf(int tensor, const std::vector<UnetBuffer>& maps) const;
  void Size(UnetBuffers* buffers) const;
  InputSlice SliceOf(const UnetStep& step, size_t input) const;
  int ThreadsFor(const UnetStep& step) const;

  void PackWeights(const float* weights, UnetBuffer* packed) const;
  void PackTransposed(const UnetBuffer& packed, UnetBuffer* transposed) const;
  void UnpackGradient(const UnetBuffer& gradient, float* weight_gradient) const;

  // In place: normalises a step's sums, adds its bias and activates, leaving in
  // `forward` what the Jacobian needs.
  void NormalizeAndActivate(int step_index, UnetBuffers* forward) const;
  // Applies the Jacobian of the normalisation, which is symmetric, to a tangent
  // or adjoint in place, and adds `shift` [padded channel].
  void ApplyNormJacobian(int step_index, const UnetBuffers& forward,
                         const float* shift, const UnetMap& d) const;
  void Upsample(const UnetStep& step,
                const std::vector<UnetBuffer>& maps) const;
  void PropagateToInput(int step_index, size_t input, bool overwrite,
                        const UnetBuffer& transposed,
                        const std::vector<UnetBuffer>& adjoints) const;
  void AddWeightGradient(int step_index, const std::vector<UnetBuffer>& maps,
                         const std::vector<UnetBuffer>& adjoints,
                         UnetBuffer* gradient) const;

  const UnetPlan& plan_;
  const UnetKernels& kernels_;
  const int num_threads_;
  const uint64_t id_;             // of this engine in the process, not 0
  UnetBuffer noise_;              // as a UnetMap with its border
  std::vector<Packing> packing_;  // by step
  int64_t packed_size_ = 0;
  int64_t transposed_size_ = 0;
  int64_t gradient_size_ = 0;
};

}  // namespace ibrdf
