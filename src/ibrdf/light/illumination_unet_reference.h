// The illumination UNet written plainly, for any scalar: the check on the fast
// float implementation and, in double, on its derivatives.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "ibrdf/light/illumination_unet_plan.h"

namespace ibrdf {

// Feature maps [channel][row][column] of one pass, by tensor of the plan, and
// the activations' slopes and normalised sums, by step.
template <typename T>
struct UnetReferencePass {
  std::vector<std::vector<T>> tensors;
  std::vector<std::vector<T>> slopes;
  std::vector<std::vector<T>> normalized;
  std::vector<std::vector<T>> inverse_deviation;  // by step and channel

  const std::vector<T>& log_radiance() const { return tensors.back(); }
};

template <typename T>
class UnetReference {
 public:
  // noise: [noise channel][row][column].
  UnetReference(UnetPlan plan, std::vector<T> noise)
      : plan_(std::move(plan)), noise_(std::move(noise)) {}

  UnetReferencePass<T> Forward(const std::vector<T>& weights) const {
    UnetReferencePass<T> pass = EmptyPass();
    pass.tensors[0] = noise_;
    for (size_t s = 0; s < plan_.steps.size(); ++s) {
      const UnetStep& step = plan_.steps[s];
      std::vector<T>& out = pass.tensors[step.output];
      ForEachTerm(step, [&](size_t o, int tensor, size_t i, int w, T factor) {
        out[o] +=
            factor * pass.tensors[tensor][i] * (w < 0 ? T(1) : weights[w]);
      });
      if (step.normalize) Normalize(static_cast<int>(s), &pass);
      AddBias(step, weights, &out);
      if (!step.activate) continue;
      for (size_t o = 0; o < out.size(); ++o) {
        Activate(&out[o], &pass.slopes[s][o]);
      }
    }
    return pass;
  }

  // Derivative of log-radiance along `tangent` [num_weights] at `pass`.
  std::vector<T> Jvp(const std::vector<T>& weights,
                     const std::vector<T>& tangent,
                     const UnetReferencePass<T>& pass) const {
    UnetReferencePass<T> d = EmptyPass();
    for (size_t s = 0; s < plan_.steps.size(); ++s) {
      const UnetStep& step = plan_.steps[s];
      std::vector<T>& out = d.tensors[step.output];
      ForEachTerm(step, [&](size_t o, int tensor, size_t i, int w, T factor) {
        if (w < 0) {
          out[o] += factor * d.tensors[tensor][i];
        } else {
          out[o] += weights[w] * d.tensors[tensor][i] +
                    tangent[w] * pass.tensors[tensor][i];
        }
      });
      if (step.normalize) ApplyNormJacobian(static_cast<int>(s), pass, &out);
      AddBias(step, tangent, &out);
      for (size_t o = 0; o < out.size(); ++o) out[o] *= pass.slopes[s][o];
    }
    return d.tensors.back();
  }

  // Gradient by the weights of <adjoint, log-radiance> at `pass`;
  // adjoint: [3][row][column].
  std::vector<T> Vjp(const std::vector<T>& weights,
                     const std::vector<T>& adjoint,
                     const UnetReferencePass<T>& pass) const {
    UnetReferencePass<T> a = EmptyPass();
    a.tensors.back() = adjoint;
    std::vector<T> gradient(plan_.num_weights, T(0));
    for (size_t s = plan_.steps.size(); s-- > 0;) {
      const UnetStep& step = plan_.steps[s];
      std::vector<T>& out = a.tensors[step.output];
      for (size_t o = 0; o < out.size(); ++o) out[o] *= pass.slopes[s][o];
      if (step.kind == UnetStep::kConvolution) {
        const size_t texels = Texels(step.output);
        for (size_t o = 0; o < out.size(); ++o) {
          gradient[step.bias_offset + o / texels] += out[o];
        }
      }
      if (step.normalize) ApplyNormJacobian(static_cast<int>(s), pass, &out);
      ForEachTerm(step, [&](size_t o, int tensor, size_t i, int w, T factor) {
        if (w < 0) {
          a.tensors[tensor][i] += factor * out[o];
        } else {
          a.tensors[tensor][i] += weights[w] * out[o];
          gradient[w] += pass.tensors[tensor][i] * out[o];
        }
      });
    }
    return gradient;
  }

 private:
  size_t Texels(int tensor) const {
    return static_cast<size_t>(plan_.tensors[tensor].height) *
           plan_.tensors[tensor].width;
  }

  UnetReferencePass<T> EmptyPass() const {
    UnetReferencePass<T> pass;
    for (const UnetTensor& t : plan_.tensors) {
      pass.tensors.emplace_back(
          static_cast<size_t>(t.channels) * t.height * t.width, T(0));
    }
    for (const UnetStep& step : plan_.steps) {
      const size_t size = pass.tensors[step.output].size();
      pass.slopes.emplace_back(size, T(1));
      pass.normalized.emplace_back(step.normalize ? size : 0);
      pass.inverse_deviation.emplace_back(
          step.normalize ? plan_.tensors[step.output].channels : 0);
    }
    return pass;
  }

  static void Activate(T* x, T* slope) {
    const T l = T(kUnetLeak), c = T(kUnetCurvature);
    const T limit = T(kUnetSaturation);
    const T inside = std::min(std::max(*x, -limit), limit);
    const T root = std::sqrt(inside * inside + c * c);
    *slope = inside == *x
                 ? (T(1) + l) / T(2) + (T(1) - l) / T(2) * inside / root
                 : T(0);
    *x = (T(1) + l) / T(2) * inside + (T(1) - l) / T(2) * (root - c);
  }

  void Normalize(int s, UnetReferencePass<T>* pass) const {
    std::vector<T>& x = pass->tensors[plan_.steps[s].output];
    const size_t n = Texels(plan_.steps[s].output);
    for (size_t c = 0; c < x.size() / n; ++c) {
      T mean = T(0), variance = T(0);
      for (size_t i = c * n; i < (c + 1) * n; ++i) mean += x[i] / T(n);
      for (size_t i = c * n; i < (c + 1) * n; ++i) {
        variance += (x[i] - mean) * (x[i] - mean) / T(n);
      }
      const T inverse = T(1) / std::sqrt(variance + T(kUnetNormEpsilon));
      pass->inverse_deviation[s][c] = inverse;
      for (size_t i = c * n; i < (c + 1) * n; ++i) {
        x[i] = (x[i] - mean) * inverse;
        pass->normalized[s][i] = x[i];
      }
    }
  }

  // The Jacobian of Normalize, which is symmetric: with y the normalised
  // channel, d -> (d - mean(d) - y mean(y d)) / deviation.
  void ApplyNormJacobian(int s, const UnetReferencePass<T>& pass,
                         std::vector<T>* d) const {
    const std::vector<T>& y = pass.normalized[s];
    const size_t n = Texels(plan_.steps[s].output);
    for (size_t c = 0; c < d->size() / n; ++c) {
      T mean = T(0), along = T(0);
      for (size_t i = c * n; i < (c + 1) * n; ++i) {
        mean += (*d)[i] / T(n);
        along += (*d)[i] * y[i] / T(n);
      }
      for (size_t i = c * n; i < (c + 1) * n; ++i) {
        (*d)[i] =
            ((*d)[i] - mean - y[i] * along) * pass.inverse_deviation[s][c];
      }
    }
  }

  void AddBias(const UnetStep& step, const std::vector<T>& weights,
               std::vector<T>* out) const {
    if (step.kind != UnetStep::kConvolution) return;
    const size_t texels = Texels(step.output);
    for (size_t o = 0; o < out->size(); ++o) {
      (*out)[o] += weights[step.bias_offset + o / texels];
    }
  }

  // Calls visit(output index, input tensor, input index, weight or -1, factor)
  // for every term of a step's sum; factor is 1 for convolutions, and the
  // weight -1 for upsampling.
  template <typename Visit>
  void ForEachTerm(const UnetStep& step, const Visit& visit) const {
    const UnetTensor& out = plan_.tensors[step.output];
    for (int row = 0; row < out.height; ++row) {
      for (int column = 0; column < out.width; ++column) {
        if (step.kind == UnetStep::kConvolution) {
          VisitConvolution(step, row, column, visit);
        } else {
          VisitUpsampling(step, row, column, visit);
        }
      }
    }
  }

  template <typename Visit>
  void VisitConvolution(const UnetStep& step, int row, int column,
                        const Visit& visit) const {
    const UnetTensor& out = plan_.tensors[step.output];
    for (int ky = 0; ky < step.size; ++ky) {
      for (int kx = 0; kx < step.size; ++kx) {
        int weight = step.weight_offset + (ky * step.size + kx) *
                                              plan_.InputChannels(step) *
                                              out.channels;
        for (const int input : step.inputs) {
          const UnetTensor& in = plan_.tensors[input];
          const UnetTexelIndex texel = UnetTexel(
              step.stride * row + ky - step.before(),
              step.stride * column + kx - step.before(), in.height, in.width);
          for (int c = 0; c < in.channels; ++c) {
            for (int o = 0; o < out.channels; ++o, ++weight) {
              visit(Index(step.output, o, row, column), input,
                    Index(input, c, texel.row, texel.column), weight, T(1));
            }
          }
        }
      }
    }
  }

  // Texel centres of the fine map lie a quarter of a coarse texel beside the
  // coarse centres: weights 3/4 and 1/4 along each axis.
  template <typename Visit>
  void VisitUpsampling(const UnetStep& step, int row, int column,
                       const Visit& visit) const {
    const int input = step.inputs[0];
    const UnetTensor& in = plan_.tensors[input];
    for (int far_row = 0; far_row < 2; ++far_row) {
      for (int far_column = 0; far_column < 2; ++far_column) {
        const int r = row / 2 + (far_row ? 2 * (row % 2) - 1 : 0);
        const int c = column / 2 + (far_column ? 2 * (column % 2) - 1 : 0);
        const UnetTexelIndex texel = UnetTexel(r, c, in.height, in.width);
        const T factor = T(far_row ? 0.25 : 0.75) * T(far_column ? 0.25 : 0.75);
        for (int k = 0; k < in.channels; ++k) {
          visit(Index(step.output, k, row, column), input,
                Index(input, k, texel.row, texel.column), -1, factor);
        }
      }
    }
  }

  size_t Index(int tensor, int channel, int row, int column) const {
    const UnetTensor& t = plan_.tensors[tensor];
    return (static_cast<size_t>(channel) * t.height + row) * t.width + column;
  }

  const UnetPlan plan_;
  const std::vector<T> noise_;
};

}  // namespace ibrdf
