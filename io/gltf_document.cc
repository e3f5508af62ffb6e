#include "ibrdf/io/gltf_document.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace ibrdf {
namespace {
using Json = nlohmann::json;

// What describes a mesh is short; the parsed form takes tens of times as much.
constexpr size_t kMaxGltfJsonBytes = size_t{16} << 20;
constexpr int kMaxGltfDepth = 64;

// Component types by their numbers in the format.
enum GltfType {
  kGltfByte = 5120,
  kGltfUnsignedByte = 5121,
  kGltfShort = 5122,
  kGltfUnsignedShort = 5123,
  kGltfUnsignedInt = 5125,
  kGltfFloat = 5126
};

size_t GltfTypeBytes(int type) {
  switch (type) {
    case kGltfByte:
    case kGltfUnsignedByte:
      return 1;
    case kGltfShort:
    case kGltfUnsignedShort:
      return 2;
    case kGltfUnsignedInt:
    case kGltfFloat:
      return 4;
    default:
      return 0;
  }
}

uint32_t GltfWord(const char* bytes, size_t size) {
  uint32_t word = 0;
  for (size_t i = size; i-- > 0;) {
    word = word << 8 | static_cast<uint8_t>(bytes[i]);
  }
  return word;
}

// Rows of matrices, whose columns may be padded, are not read.
int GltfComponents(const Json& accessor) {
  const auto type = accessor.find("type");
  if (type == accessor.end() || !type->is_string()) return 0;
  if (*type == "SCALAR") return 1;
  if (*type == "VEC2") return 2;
  if (*type == "VEC3") return 3;
  if (*type == "VEC4") return 4;
  return 0;
}

// These change how a surface looks, or how attributes are stored that are read
// anyway.
bool KeepsGeometry(const std::string& extension) {
  if (extension == "KHR_mesh_quantization") return true;
  for (const char* prefix : {"KHR_materials_", "EXT_materials_", "KHR_texture_",
                             "EXT_texture_", "KHR_lights_"}) {
    if (extension.rfind(prefix, 0) == 0) return true;
  }
  return false;
}

// No object where the text is not valid or nested too deep, whose levels are
// not stored.
Json ParseGltfJson(std::string_view text) {
  bool too_deep = false;
  const auto keep = [&](int depth, Json::parse_event_t, Json&) {
    too_deep = too_deep || depth > kMaxGltfDepth;
    return !too_deep;
  };
  Json json = Json::parse(text, keep, false);
  if (too_deep) return {};
  return json;
}

// The next chunk of a GLB, from *at on.
bool NextChunk(std::string_view bytes, size_t* at, uint32_t* type,
               std::string_view* chunk) {
  constexpr size_t kChunkHeader = 8;
  if (bytes.size() - *at < kChunkHeader) return false;
  const uint32_t size = GltfWord(bytes.data() + *at, 4);
  *type = GltfWord(bytes.data() + *at + 4, 4);
  *at += kChunkHeader;
  if (size > bytes.size() - *at) return false;
  *chunk = bytes.substr(*at, size);
  *at += size;
  return true;
}

}  // namespace

bool GltfNumbers::IsUnsigned() const {
  return !normalized_ &&
         (type_ == kGltfUnsignedByte || type_ == kGltfUnsignedShort ||
          type_ == kGltfUnsignedInt);
}

uint32_t GltfNumbers::Index(size_t row) const {
  return GltfWord(first_ + row * stride_, GltfTypeBytes(type_));
}

double GltfNumbers::At(size_t row, int component) const {
  const size_t size = GltfTypeBytes(type_);
  const char* at =
      first_ + row * stride_ + static_cast<size_t>(component) * size;
  const uint32_t word = GltfWord(at, size);
  // glTF 2.0, 3.6.2.2: normalised integers.
  switch (type_) {
    case kGltfFloat: {
      float value = 0.0f;
      std::memcpy(&value, &word, sizeof(value));
      return value;
    }
    case kGltfByte: {
      const double value = static_cast<int8_t>(word);
      return normalized_ ? std::max(value / 127.0, -1.0) : value;
    }
    case kGltfShort: {
      const double value = static_cast<int16_t>(word);
      return normalized_ ? std::max(value / 32767.0, -1.0) : value;
    }
    case kGltfUnsignedByte:
      return normalized_ ? word / 255.0 : word;
    case kGltfUnsignedShort:
      return normalized_ ? word / 65535.0 : word;
    default:
      return word;
  }
}

bool GltfWhole(const Json& number, uint64_t end, size_t* value) {
  if (!number.is_number()) return false;
  const double whole = number.get<double>();
  if (!(whole >= 0.0 && whole < static_cast<double>(end)) ||
      whole != std::floor(whole)) {
    return false;
  }
  *value = static_cast<size_t>(whole);
  return true;
}

bool GltfIndex(const Json& object, const char* key, uint64_t end,
               size_t* value) {
  const auto at = object.find(key);
  return at != object.end() && GltfWhole(*at, end, value);
}

StatusOr<GltfDocument> GltfDocument::Open(const std::string& path,
                                          std::string_view bytes) {
  constexpr size_t kHeader = 12;
  constexpr uint32_t kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;
  GltfDocument document;
  document.path_ = path;
  if (bytes.size() < kHeader || bytes.substr(0, 4) != "glTF") {
    return document.Fail("header", "expected \"glTF\"");
  }
  const uint32_t version = GltfWord(bytes.data() + 4, 4);
  if (version != 2) {
    return document.Fail(
        "header", "expected version 2, found " + std::to_string(version));
  }
  const uint32_t length = GltfWord(bytes.data() + 8, 4);
  if (length < kHeader || length > bytes.size()) {
    return document.Fail("header", "expected a length of at most the file's " +
                                       std::to_string(bytes.size()) +
                                       " bytes, found " +
                                       std::to_string(length));
  }
  bytes = bytes.substr(0, length);
  size_t at = kHeader;
  uint32_t type = 0;
  std::string_view text;
  if (!NextChunk(bytes, &at, &type, &text) || type != kJsonChunk ||
      text.size() > kMaxGltfJsonBytes) {
    return document.Fail("header", "expected a first chunk JSON of at most " +
                                       std::to_string(kMaxGltfJsonBytes) +
                                       " bytes that ends inside of the file");
  }
  document.json_ = ParseGltfJson(text);
  if (!document.json_.is_object()) {
    return document.Fail("JSON", "expected a valid object of at most " +
                                     std::to_string(kMaxGltfDepth) + " levels");
  }
  while (at < bytes.size()) {
    std::string_view chunk;
    if (!NextChunk(bytes, &at, &type, &chunk)) {
      return document.Fail("header",
                           "expected chunks that end inside of the file");
    }
    if (type == kBinaryChunk && document.buffer_.empty()) {
      document.buffer_ = chunk;
    }
  }
  IBRDF_RETURN_IF_ERROR(document.CheckExtensions());
  return document;
}

Status GltfDocument::CheckExtensions() const {
  const auto required = json_.find("extensionsRequired");
  if (required == json_.end()) return OkStatus();
  if (!required->is_array()) {
    return Fail("extensionsRequired", "expected a list");
  }
  for (const Json& extension : *required) {
    const std::string name =
        extension.is_string() ? extension.get<std::string>() : "no text";
    if (!KeepsGeometry(name)) {
      return Fail("extensionsRequired",
                  name.substr(0, 64) +
                      " is not read; export without it (compression, say)");
    }
  }
  return OkStatus();
}

size_t GltfDocument::Size(const char* list) const {
  const auto at = json_.find(list);
  return at != json_.end() && at->is_array() ? at->size() : 0;
}

const Json& GltfDocument::At(const char* list, size_t index) const {
  return (*json_.find(list))[index];
}

Status GltfDocument::Fail(const std::string& where,
                          const std::string& what) const {
  return InvalidInput(path_ + ": " + where, what);
}

StatusOr<std::string_view> GltfDocument::View(size_t view,
                                              size_t* stride) const {
  const std::string where = "bufferViews[" + std::to_string(view) + "]";
  const Json& json = At("bufferViews", view);
  size_t buffer = 0, offset = 0, length = 0;
  if (!json.is_object() ||
      !GltfIndex(json, "buffer", Size("buffers"), &buffer)) {
    return Fail(where + ".buffer", "expected one of the file's " +
                                       std::to_string(Size("buffers")));
  }
  const Json& holder = At("buffers", buffer);
  if (buffer != 0 || !holder.is_object() || holder.contains("uri")) {
    return Fail("buffers[" + std::to_string(buffer) + "]",
                "expected the buffer inside of the .glb, not a uri");
  }
  const uint64_t end = buffer_.size() + uint64_t{1};
  if ((json.contains("byteOffset") &&
       !GltfIndex(json, "byteOffset", end, &offset)) ||
      !GltfIndex(json, "byteLength", end - offset, &length)) {
    return Fail(where, "expected byteOffset and byteLength inside of the " +
                           std::to_string(buffer_.size()) +
                           " bytes of the buffer");
  }
  constexpr uint64_t kMaxStride = 252;  // glTF 2.0, 5.11.4
  if (json.contains("byteStride") &&
      !GltfIndex(json, "byteStride", kMaxStride + 1, stride)) {
    return Fail(where + ".byteStride", "expected at most 252");
  }
  return buffer_.substr(offset, length);
}

StatusOr<GltfNumbers> GltfDocument::Numbers(size_t accessor) const {
  const std::string where = "accessors[" + std::to_string(accessor) + "]";
  if (accessor >= Size("accessors") || !At("accessors", accessor).is_object()) {
    return Fail(where, "expected one of the file's " +
                           std::to_string(Size("accessors")));
  }
  const Json& json = At("accessors", accessor);
  if (json.contains("sparse")) {
    return Fail(where + ".sparse",
                "expected plain numbers; sparse ones are "
                "not read");
  }
  size_t view = 0, offset = 0, type = 0;
  if (!GltfIndex(json, "bufferView", Size("bufferViews"), &view)) {
    return Fail(where + ".bufferView", "expected one of the file's " +
                                           std::to_string(Size("bufferViews")));
  }
  GltfNumbers numbers;
  const StatusOr<std::string_view> bytes = View(view, &numbers.stride_);
  if (!bytes.ok()) return bytes.status();
  numbers.components_ = GltfComponents(json);
  if (!GltfIndex(json, "componentType", 1 << 16, &type) ||
      numbers.components_ == 0 || GltfTypeBytes(static_cast<int>(type)) == 0) {
    return Fail(where,
                "expected a known componentType and type SCALAR or "
                "VEC2 to VEC4");
  }
  numbers.type_ = static_cast<int>(type);
  const auto normalized = json.find("normalized");
  numbers.normalized_ = normalized != json.end() && *normalized == true;
  const size_t row =
      GltfTypeBytes(numbers.type_) * static_cast<size_t>(numbers.components_);
  if (numbers.stride_ == 0) numbers.stride_ = row;
  if (json.contains("byteOffset") &&
      !GltfIndex(json, "byteOffset", bytes->size() + uint64_t{1}, &offset)) {
    return Fail(where + ".byteOffset", "expected one inside of bufferViews[" +
                                           std::to_string(view) + "]");
  }
  const size_t left = bytes->size() - offset;
  // The last row needs no padding.
  const uint64_t most =
      left < row ? 0 : (left - row) / numbers.stride_ + uint64_t{1};
  if (numbers.stride_ < row ||
      !GltfIndex(json, "count", most + 1, &numbers.count_)) {
    return Fail(where + ".count",
                "expected at most the " + std::to_string(most) +
                    " that bufferViews[" + std::to_string(view) + "] holds");
  }
  numbers.first_ = bytes->data() + offset;
  return numbers;
}

}  // namespace ibrdf
