#include "ibrdf/io/exr_layers.h"

#include <ImfChannelList.h>
#include <ImfPartType.h>

#include <algorithm>
#include <map>
#include <set>

namespace ibrdf {
namespace {

using ChannelNames = std::array<const char*, 3>;

constexpr ChannelNames kRgbNames[] = {{"R", "G", "B"},
                                      {"r", "g", "b"},
                                      {"red", "green", "blue"},
                                      {"Red", "Green", "Blue"}};
constexpr ChannelNames kXyzNames[] = {
    {"X", "Y", "Z"}, {"x", "y", "z"}, {"NX", "NY", "NZ"}, {"Nx", "Ny", "Nz"}};
constexpr const char* kAlphaNames[] = {"A", "a", "alpha", "Alpha"};

// In the order of preference, in lower case.
constexpr const char* kColourLayers[] = {"combined", "beauty", "rgba",  "rgb",
                                         "color",    "colour", "image", "main",
                                         "c",        "ci"};
constexpr const char* kDepthNames[] = {"Z", "z", "depth", "Depth", "V", "Y"};
constexpr const char* kDepthLayers[] = {"depth", "z"};
constexpr const char* kNormalLayers[] = {"normal", "normals", "n", "nn"};

std::string Lower(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

// What follows the last dot.
std::string LastName(const std::string& name) {
  const size_t dot = name.rfind('.');
  return dot == std::string::npos ? name : name.substr(dot + 1);
}

std::string Prefixed(const std::string& layer, const std::string& name) {
  return layer.empty() ? name : layer + "." + name;
}

// Fills in kind and channels; false where the layer has none for `content`.
bool FindChannels(const std::set<std::string>& names, PhotoContent content,
                  ExrPicture* picture) {
  const auto take = [&](const ChannelNames& triple, ExrChannels kind) {
    for (size_t c = 0; c < 3; ++c) {
      if (names.count(triple[c]) == 0) return false;
      picture->channels[c] = Prefixed(picture->layer, triple[c]);
    }
    picture->kind = kind;
    return true;
  };
  if (content == PhotoContent::kDepth) {
    // X beside Z is a position or a normal.
    const bool vector = names.count("X") > 0 || names.count("x") > 0;
    for (const char* name : kDepthNames) {
      if (!vector && take({name, name, name}, ExrChannels::kGrey)) return true;
    }
    return take(kRgbNames[0], ExrChannels::kRgb);
  }
  const bool normals = content == PhotoContent::kNormals;
  if (normals) {
    for (const ChannelNames& triple : kXyzNames) {
      if (take(triple, ExrChannels::kXyz)) return true;
    }
  }
  for (const ChannelNames& triple : kRgbNames) {
    if (take(triple, ExrChannels::kRgb)) return true;
  }
  if (normals) return false;
  if (take({"Y", "RY", "BY"}, ExrChannels::kLuminanceChroma)) return true;
  const bool is_vector = names.count("X") > 0 && names.count("Z") > 0;
  return !is_vector && take({"Y", "Y", "Y"}, ExrChannels::kGrey);
}

std::string FullName(const std::string& part, const std::string& layer) {
  if (part.empty() || layer.empty()) return part + layer;
  // Blender's parts are called as their layers.
  if (layer == part || layer.compare(0, part.size() + 1, part + ".") == 0) {
    return layer;
  }
  return part + "." + layer;
}

void ListPart(const Imf::Header& header, int part, bool many,
              PhotoContent content, std::vector<ExrPicture>* pictures) {
  std::map<std::string, std::set<std::string>> layers;
  const Imf::ChannelList& channels = header.channels();
  for (auto it = channels.begin(); it != channels.end(); ++it) {
    const std::string name = it.name();
    const size_t dot = name.rfind('.');
    const std::string layer =
        dot == std::string::npos ? "" : name.substr(0, dot);
    layers[layer].insert(LastName(name));
  }
  for (const auto& [layer, names] : layers) {
    ExrPicture picture;
    picture.part = part;
    if (many && header.hasName()) picture.part_name = header.name();
    picture.layer = layer;
    picture.name = FullName(picture.part_name, layer);
    if (header.hasView()) picture.view = header.view();
    if (!FindChannels(names, content, &picture)) continue;
    for (const char* alpha : kAlphaNames) {
      if (picture.alpha.empty() && names.count(alpha) > 0) {
        picture.alpha = Prefixed(layer, alpha);
      }
    }
    pictures->push_back(picture);
  }
}

// Lower is preferred; kUnknown: of a name that says nothing.
constexpr int kUnknownName = 1000;

int NameRank(const ExrPicture& picture, PhotoContent content) {
  const bool normals = content == PhotoContent::kNormals;
  const bool depth = content == PhotoContent::kDepth;
  if (picture.name.empty()) {
    // R G B without a name beside a layer of normals or depth are colours.
    return (normals || depth) && picture.kind == ExrChannels::kRgb
               ? kUnknownName - 1
               : 0;
  }
  const std::string last = Lower(LastName(picture.name));
  const bool composite = Lower(picture.name).compare(0, 10, "composite.") == 0;
  int rank = 1;
  const auto find = [&](const auto& names) {
    for (const char* name : names) {
      if (last == name) return true;
      ++rank;
    }
    return false;
  };
  const bool found = depth     ? find(kDepthLayers)
                     : normals ? find(kNormalLayers)
                               : find(kColourLayers);
  if (!found) return kUnknownName;
  return composite ? rank + kUnknownName / 2 : rank;
}

// Matches of a name that was asked for: exact ones, else those in any case
// that have it at their end, after a dot.
std::vector<ExrPicture> MatchName(const std::vector<ExrPicture>& pictures,
                                  const std::string& asked) {
  std::vector<ExrPicture> exact, loose;
  const std::string low = Lower(asked);
  for (const ExrPicture& p : pictures) {
    if (p.name == asked || (!p.layer.empty() && p.layer == asked)) {
      exact.push_back(p);
    }
    const std::string name = "." + Lower(p.name), tail = "." + low;
    const bool ends =
        name.size() >= tail.size() &&
        name.compare(name.size() - tail.size(), tail.size(), tail) == 0;
    if (ends || Lower(p.part_name) == low) loose.push_back(p);
  }
  return exact.empty() ? loose : exact;
}

std::string ListNames(const std::vector<ExrPicture>& pictures) {
  std::string names;
  for (const ExrPicture& p : pictures) {
    if (names.size() > 500) return names + " ...";
    if (!names.empty()) names += ", ";
    names += p.name.empty() ? "(no name)" : p.name;
  }
  return names;
}

bool DifferByView(const std::vector<ExrPicture>& pictures) {
  std::set<std::string> views;
  for (const ExrPicture& p : pictures) {
    if (p.view.empty() || p.layer != pictures[0].layer) return false;
    views.insert(p.view);
  }
  return views.size() == pictures.size();
}

// Those of the lowest rank.
std::vector<ExrPicture> Preferred(const std::vector<ExrPicture>& pictures,
                                  PhotoContent content) {
  std::vector<ExrPicture> best;
  std::pair<bool, int> lowest = {true, kUnknownName + 1};
  for (const ExrPicture& p : pictures) {
    if (Lower(LastName(p.layer)).compare(0, 6, "crypto") == 0) continue;
    const int name = NameRank(p, content);
    // A picture without a name comes first, grey or not.
    const bool grey = p.kind == ExrChannels::kGrey;
    const bool other = grey != (content == PhotoContent::kDepth);
    const std::pair<bool, int> rank = {name > 0 && other, name};
    if (rank < lowest) best.clear();
    lowest = std::min(lowest, rank);
    if (rank == lowest) best.push_back(p);
  }
  return best;
}

}  // namespace

std::vector<ExrPicture> ListExrPictures(const std::vector<Imf::Header>& headers,
                                        PhotoContent content) {
  std::vector<ExrPicture> pictures;
  for (size_t part = 0; part < headers.size(); ++part) {
    const Imf::Header& header = headers[part];
    if (header.hasType() && !Imf::isImage(header.type())) continue;
    ListPart(header, static_cast<int>(part), headers.size() > 1, content,
             &pictures);
  }
  return pictures;
}

StatusOr<ExrPicture> ChooseExrPicture(const std::string& path,
                                      const std::vector<ExrPicture>& pictures,
                                      const PhotoOptions& options) {
  if (!options.layer.empty()) {
    const std::vector<ExrPicture> named = MatchName(pictures, options.layer);
    if (named.size() == 1 || (!named.empty() && DifferByView(named))) {
      return named[0];
    }
    return InvalidInput(path + ": layer " + options.layer,
                        "expected the name of one of: " +
                            ListNames(named.empty() ? pictures : named));
  }
  const std::vector<ExrPicture> best = Preferred(pictures, options.content);
  if (best.size() == 1 || (!best.empty() && DifferByView(best))) {
    return best[0];
  }
  if (best.empty()) {
    return InvalidInput(path + ": layers",
                        "expected one of colours, found Cryptomatte alone: " +
                            ListNames(pictures));
  }
  return InvalidInput(
      path + ": layers",
      "several may be meant, name one by `layer`: " + ListNames(pictures));
}

}  // namespace ibrdf
