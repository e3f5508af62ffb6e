#include "tests/hard_cases/case_exr.h"

#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>

#include <utility>
#include <vector>

namespace ibrdf {
namespace {

// Names of layers or parts with the factor of each.
using Factors = std::vector<std::pair<std::string, float>>;

Factors FactorsOf(const YAML::Node& node) {
  Factors factors;
  for (const auto& entry : node) {
    factors.emplace_back(entry.first.as<std::string>(),
                         entry.second.as<float>());
  }
  if (factors.empty()) factors.emplace_back("", 1.0f);
  return factors;
}

Imf::Header HeaderOf(const YAML::Node& exr, const Image& image) {
  std::vector<int> at = {0, 0}, display = {image.width, image.height};
  if (exr["data_at"]) at = exr["data_at"].as<std::vector<int>>();
  if (exr["display"]) display = exr["display"].as<std::vector<int>>();
  const Imath::Box2i data({at[0], at[1]},
                          {at[0] + image.width - 1, at[1] + image.height - 1});
  Imf::Header header(Imath::Box2i({0, 0}, {display[0] - 1, display[1] - 1}),
                     data);
  if (exr["aspect"]) header.pixelAspectRatio() = exr["aspect"].as<float>();
  if (exr["chromaticities"]) {
    const auto c = exr["chromaticities"].as<std::vector<float>>();
    Imf::addChromaticities(header, {{c.at(0), c.at(1)},
                                    {c.at(2), c.at(3)},
                                    {c.at(4), c.at(5)},
                                    {c.at(6), c.at(7)}});
  }
  return header;
}

}  // namespace

Status MakeExr(const YAML::Node& exr, const Image& image,
               const std::string& path) {
  const Factors layers = FactorsOf(exr["layers"]);
  const Factors parts = FactorsOf(exr["parts"]);
  std::vector<std::string> names = {"R", "G", "B"};
  if (exr["channels"]) names = exr["channels"].as<std::vector<std::string>>();
  std::vector<Imf::Header> headers;
  for (const auto& [part, factor] : parts) {
    Imf::Header header = HeaderOf(exr, image);
    if (!part.empty()) header.setName(part);
    header.setType(Imf::SCANLINEIMAGE);
    for (const auto& [layer, unused] : layers) {
      for (const std::string& name : names) {
        header.channels().insert((layer.empty() ? "" : layer + ".") + name,
                                 Imf::Channel(Imf::FLOAT));
      }
    }
    headers.push_back(header);
  }
  try {
    Imf::MultiPartOutputFile file(path.c_str(), headers.data(),
                                  static_cast<int>(headers.size()));
    for (size_t p = 0; p < parts.size(); ++p) {
      std::vector<Image> pixels(layers.size(), image);
      Imf::FrameBuffer frame;
      for (size_t k = 0; k < layers.size(); ++k) {
        for (float& v : pixels[k].rgb) v *= layers[k].second * parts[p].second;
        const std::string& layer = layers[k].first;
        for (size_t c = 0; c < names.size(); ++c) {
          frame.insert(
              (layer.empty() ? "" : layer + ".") + names[c],
              Imf::Slice::Make(
                  Imf::FLOAT, pixels[k].rgb.data() + c % 3,
                  headers[p].dataWindow(), 3 * sizeof(float),
                  3 * sizeof(float) * static_cast<size_t>(image.width)));
        }
      }
      Imf::OutputPart out(file, static_cast<int>(p));
      out.setFrameBuffer(frame);
      out.writePixels(image.height);
    }
  } catch (const std::exception& e) {
    return InvalidInput("recipe: exr", e.what());
  }
  return OkStatus();
}

}  // namespace ibrdf
