#include "ibrdf/light/illumination_unet_plan.h"

#include <glog/logging.h>

namespace ibrdf {
namespace {

class Builder {
 public:
  explicit Builder(const IlluminationUnetOptions& options)
      : options_(options) {}

  UnetPlan Build() {
    plan_.scales = CountScales();
    plan_.tensors.push_back(
        {options_.noise_channels, options_.height, options_.width});
    const int features = plan_.scales > 0 ? AddScale(0, 0) : 0;
    AddConvolution("output", {features}, 3, 1, 1, false);
    return plan_;
  }

 private:
  int CountScales() const {
    int width = options_.width, height = options_.height, scales = 0;
    while (scales < options_.scales && width % 4 == 0 && height % 2 == 0 &&
           height >= 4) {
      width /= 2;
      height /= 2;
      ++scales;
    }
    return scales;
  }

  // One scale of the encoder-decoder and all that lies below it; returns its
  // output, a tensor of the input's size.
  int AddScale(int scale, int input) {
    const std::string name = "scale" + std::to_string(scale) + ".";
    const int channels = options_.channels;
    int deep = AddConvolution(name + "down1", {input}, channels, 4, 2, true);
    deep = AddConvolution(name + "down2", {deep}, channels, 3, 1, true);
    if (scale + 1 < plan_.scales) deep = AddScale(scale + 1, deep);
    std::vector<int> branches = {AddUpsampling(deep)};
    if (options_.skip_channels > 0) {
      branches.push_back(AddConvolution(name + "skip", {input},
                                        options_.skip_channels, 1, 1, true));
    }
    const int merged =
        AddConvolution(name + "merge3", branches, channels, 3, 1, true);
    return AddConvolution(name + "merge1", {merged}, channels, 1, 1, true);
  }

  int AddConvolution(const std::string& name, const std::vector<int>& inputs,
                     int channels, int size, int stride, bool activate) {
    const UnetTensor& first = plan_.tensors[inputs[0]];
    UnetStep step{
        UnetStep::kConvolution, inputs,
        AddTensor(channels, first.height / stride, first.width / stride)};
    step.size = size;
    step.stride = stride;
    step.activate = activate;
    step.normalize = activate && options_.normalize;
    const int fan_in = size * size * plan_.InputChannels(step);
    const bool is_output = !activate;
    step.weight_offset =
        AddBlock(name + ".weight", fan_in * channels, false, is_output, fan_in);
    step.bias_offset =
        AddBlock(name + ".bias", channels, true, is_output, fan_in);
    plan_.steps.push_back(step);
    return step.output;
  }

  int AddUpsampling(int input) {
    const UnetTensor low = plan_.tensors[input];
    const int output = AddTensor(low.channels, 2 * low.height, 2 * low.width);
    plan_.steps.push_back({UnetStep::kUpsampling, {input}, output});
    return output;
  }

  int AddTensor(int channels, int height, int width) {
    plan_.tensors.push_back({channels, height, width});
    return static_cast<int>(plan_.tensors.size()) - 1;
  }

  int AddBlock(const std::string& name, int size, bool is_bias, bool is_output,
               int fan_in) {
    const int offset = plan_.num_weights;
    plan_.blocks.push_back({name, offset, size, is_bias, is_output, fan_in});
    plan_.num_weights += size;
    return offset;
  }

  const IlluminationUnetOptions options_;
  UnetPlan plan_;
};

}  // namespace

int UnetPlan::InputChannels(const UnetStep& step) const {
  int channels = 0;
  for (const int input : step.inputs) channels += tensors[input].channels;
  return channels;
}

UnetPlan MakeUnetPlan(const IlluminationUnetOptions& options) {
  CHECK(options.width >= 2 && options.width % 2 == 0) << options.width;
  CHECK_GE(options.height, 1);
  CHECK_GE(options.scales, 0);
  CHECK_GE(options.channels, 1);
  CHECK_GE(options.skip_channels, 0);
  CHECK_GE(options.noise_channels, 1);
  return Builder(options).Build();
}

}  // namespace ibrdf
