// The pictures that an OpenEXR file holds: its parts and layers.
#pragma once
#include <ImfHeader.h>

#include <array>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/io/photo.h"

namespace ibrdf {

enum class ExrChannels { kRgb, kLuminanceChroma, kGrey, kXyz };

// Three channels of one layer of one part.
struct ExrPicture {
  int part = 0;
  std::string part_name;  // empty in a file of one part
  std::string layer;      // "ViewLayer.Combined"; empty where there is none
  std::string name;       // part and layer, as the user may ask for it
  std::string view;       // of stereo parts
  ExrChannels kind = ExrChannels::kRgb;
  // R G B, or Y RY BY, or Y three times, or X Y Z, with the layer's name.
  std::array<std::string, 3> channels;
  std::string alpha;  // empty where there is none
};

// All of a kind that `content` can be; deep parts hold none.
std::vector<ExrPicture> ListExrPictures(const std::vector<Imf::Header>& headers,
                                        PhotoContent content);

// The one that `layer` names, else the beauty part or the normals. The rule:
// 1. A layer that was asked for has that name, or that name after a dot, in any
//    case; one alone.
// 2. A picture without part and layer name is it.
// 3. Else the name after the last dot decides, in any case. Colours: Combined,
//    beauty, rgba, rgb, color, colour, image, main, C, Ci in this order, those
//    below "Composite." after the others. Normals: normal, normals, N, Nn.
//    As normals, R G B without a name come after these.
// 4. Else the only one. Grey ones give way to colours, and Cryptomatte's layers
//    are never taken unasked.
// 5. Of parts that differ by their view alone, the first.
// Otherwise the error lists the names.
StatusOr<ExrPicture> ChooseExrPicture(const std::string& path,
                                      const std::vector<ExrPicture>& pictures,
                                      const PhotoOptions& options);

}  // namespace ibrdf
