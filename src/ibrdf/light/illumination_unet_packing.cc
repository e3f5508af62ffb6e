// Buffers of the UNet engine and the order of weights in them.
#include <algorithm>

#include "ibrdf/light/illumination_unet_engine.h"

namespace ibrdf {

void UnetEngine::Size(UnetBuffers* buffers) const {
  if (buffers->owner == id_) return;
  // Zeros: channels beyond a map's own stay so.
  *buffers = UnetBuffers();
  buffers->owner = id_;
  for (size_t i = 0; i < plan_.tensors.size(); ++i) {
    const UnetTensor& t = plan_.tensors[i];
    const int texels = i == 0 ? 0 : (t.height + 2) * (t.width + 2);
    buffers->maps.emplace_back(static_cast<size_t>(texels) *
                               PadUnetChannels(t.channels));
  }
  for (const UnetStep& step : plan_.steps) {
    buffers->slopes.emplace_back(
        step.activate ? buffers->maps[step.output].size() : 0);
    buffers->normalized.emplace_back(
        step.normalize ? buffers->maps[step.output].size() : 0);
    buffers->inverse_deviation.emplace_back(
        step.normalize ? PadUnetChannels(plan_.tensors[step.output].channels)
                       : 0);
  }
  buffers->weights.resize(packed_size_);
  buffers->transposed.resize(transposed_size_);
  buffers->gradient.resize(gradient_size_);
}

UnetEngine::InputSlice UnetEngine::SliceOf(const UnetStep& step,
                                           size_t input) const {
  InputSlice slice{0, plan_.tensors[step.inputs[input]].channels};
  for (size_t i = 0; i < input; ++i) {
    slice.first_channel += plan_.tensors[step.inputs[i]].channels;
  }
  return slice;
}

void UnetEngine::PackWeights(const float* weights, UnetBuffer* packed) const {
  for (size_t s = 0; s < plan_.steps.size(); ++s) {
    const UnetStep& step = plan_.steps[s];
    if (step.kind != UnetStep::kConvolution) continue;
    const int out = plan_.tensors[step.output].channels;
    const int all = plan_.InputChannels(step);
    std::copy_n(weights + step.bias_offset, out,
                packed->data() + packing_[s].bias);
    for (size_t k = 0; k < step.inputs.size(); ++k) {
      const InputSlice slice = SliceOf(step, k);
      float* to = packed->data() + packing_[s].weights[k];
      for (int tap = 0; tap < step.size * step.size; ++tap) {
        const float* from = weights + step.weight_offset +
                            (tap * all + slice.first_channel) * out;
        for (int i = 0; i < slice.channels;
             ++i, from += out, to += PadUnetChannels(out)) {
          std::copy_n(from, out, to);
        }
      }
    }
  }
}

void UnetEngine::PackTransposed(const UnetBuffer& packed,
                                UnetBuffer* transposed) const {
  for (size_t s = 0; s < plan_.steps.size(); ++s) {
    const UnetStep& step = plan_.steps[s];
    const int out = plan_.tensors[step.output].channels;
    for (size_t k = 0; k < packing_[s].weights.size(); ++k) {
      const int in = plan_.tensors[step.inputs[k]].channels;
      const float* from = packed.data() + packing_[s].weights[k];
      float* to = transposed->data() + packing_[s].transposed[k];
      for (int tap = 0; tap < step.size * step.size; ++tap) {
        for (int o = 0; o < out; ++o, to += PadUnetChannels(in)) {
          for (int i = 0; i < in; ++i)
            to[i] = from[i * PadUnetChannels(out) + o];
        }
        from += in * PadUnetChannels(out);
      }
    }
  }
}

void UnetEngine::UnpackGradient(const UnetBuffer& gradient,
                                float* weight_gradient) const {
  for (size_t s = 0; s < plan_.steps.size(); ++s) {
    const UnetStep& step = plan_.steps[s];
    if (step.kind != UnetStep::kConvolution) continue;
    const int out = plan_.tensors[step.output].channels;
    const int all = plan_.InputChannels(step);
    for (size_t k = 0; k < step.inputs.size(); ++k) {
      const InputSlice slice = SliceOf(step, k);
      const int64_t tap_size =
          static_cast<int64_t>(PadUnetChannels(slice.channels)) *
          PadUnetChannels(out);
      for (int tap = 0; tap < step.size * step.size; ++tap) {
        const float* from =
            gradient.data() + packing_[s].gradient[k] + tap * tap_size;
        float* to = weight_gradient + step.weight_offset +
                    (tap * all + slice.first_channel) * out;
        for (int i = 0; i < slice.channels;
             ++i, from += PadUnetChannels(out), to += out) {
          std::copy_n(from, out, to);
        }
      }
    }
  }
}

}  // namespace ibrdf
