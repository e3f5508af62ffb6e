#include "ibrdf/io/npy.h"

#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

namespace ibrdf {
namespace {

constexpr std::string_view kNpyMagic("\x93NUMPY", 6);
constexpr size_t kMaxHeaderBytes = 1 << 16;

struct NpyHeader {
  std::string type;  // "<f4"
  bool fortran_order = false;
  std::vector<int64_t> shape;
  size_t data = 0;  // first byte of the values
};

// The header's Python dictionary of strings, booleans and one tuple.
class Dictionary {
 public:
  explicit Dictionary(std::string_view text) : text_(text) {}

  // False where the text is no such dictionary.
  bool Read(NpyHeader* header) {
    if (!Take('{')) return false;
    int found = 0;
    while (!Take('}')) {
      std::string key;
      if (!String(&key) || !Take(':')) return false;
      if (key == "descr") {
        if (!String(&header->type)) return false;
      } else if (key == "fortran_order") {
        if (!Boolean(&header->fortran_order)) return false;
      } else if (key == "shape") {
        if (!Tuple(&header->shape)) return false;
      } else {
        return false;
      }
      ++found;
      if (!Take(',') && !Peek('}')) return false;
    }
    SkipSpace();
    return at_ == text_.size() && found == 3;
  }

 private:
  void SkipSpace() {
    while (at_ < text_.size() &&
           (text_[at_] == ' ' || text_[at_] == '\n' || text_[at_] == '\t')) {
      ++at_;
    }
  }
  bool Peek(char c) {
    SkipSpace();
    return at_ < text_.size() && text_[at_] == c;
  }
  bool Take(char c) {
    if (!Peek(c)) return false;
    ++at_;
    return true;
  }
  bool TakeWord(std::string_view word) {
    SkipSpace();
    if (text_.substr(at_, word.size()) != word) return false;
    at_ += word.size();
    return true;
  }
  bool String(std::string* value) {
    const char quote = Peek('"') ? '"' : '\'';
    if (!Take(quote)) return false;
    const size_t end = text_.find(quote, at_);
    if (end == std::string_view::npos) return false;
    *value = text_.substr(at_, end - at_);
    at_ = end + 1;
    return true;
  }
  bool Boolean(bool* value) {
    *value = TakeWord("True");
    return *value || TakeWord("False");
  }
  bool Number(int64_t* value) {
    SkipSpace();
    const size_t start = at_;
    constexpr size_t kMaxDigits = 15;
    *value = 0;
    while (at_ < text_.size() && text_[at_] >= '0' && text_[at_] <= '9' &&
           at_ - start < kMaxDigits) {
      *value = *value * 10 + (text_[at_++] - '0');
    }
    return at_ > start;
  }
  bool Tuple(std::vector<int64_t>* values) {
    if (!Take('(')) return false;
    constexpr size_t kMaxAxes = 32;
    values->clear();
    while (!Take(')')) {
      int64_t value = 0;
      if (values->size() == kMaxAxes || !Number(&value)) return false;
      values->push_back(value);
      if (!Take(',') && !Peek(')')) return false;
    }
    return true;
  }

  const std::string_view text_;
  size_t at_ = 0;
};

uint32_t LittleEndian(std::string_view bytes, size_t at, size_t count) {
  uint32_t value = 0;
  for (size_t i = count; i-- > 0;) {
    value = value << 8 | static_cast<uint8_t>(bytes[at + i]);
  }
  return value;
}

StatusOr<NpyHeader> ReadNpyHeader(const std::string& path,
                                  std::string_view bytes) {
  const size_t version_end = kNpyMagic.size() + 2;
  if (bytes.substr(0, kNpyMagic.size()) != kNpyMagic ||
      bytes.size() < version_end + 4) {
    return InvalidInput(path, "expected a whole .npy header");
  }
  const int version = bytes[kNpyMagic.size()];
  if (version < 1 || version > 3) {
    return InvalidInput(path + ": version",
                        "expected 1, 2 or 3, found " + std::to_string(version));
  }
  const size_t length_bytes = version == 1 ? 2 : 4;
  const size_t length = LittleEndian(bytes, version_end, length_bytes);
  NpyHeader header;
  header.data = version_end + length_bytes + length;
  if (length > kMaxHeaderBytes || header.data > bytes.size()) {
    return InvalidInput(path, "expected a whole .npy header");
  }
  if (!Dictionary(bytes.substr(version_end + length_bytes, length))
           .Read(&header)) {
    return InvalidInput(path + ": header",
                        "expected descr (one number type), fortran_order and "
                        "shape");
  }
  return header;
}

std::string ShapeText(const std::vector<int64_t>& shape) {
  std::string text = "[";
  for (const int64_t n : shape) {
    text += (text.size() > 1 ? ", " : "") + std::to_string(n);
  }
  return text + "]";
}

// Appends count values of type T as floats.
template <typename T>
void ReadValues(const char* data, size_t count, std::vector<float>* values) {
  values->reserve(count);
  for (size_t i = 0; i < count; ++i) {
    T value;
    std::memcpy(&value, data + i * sizeof(T), sizeof(T));
    values->push_back(static_cast<float>(value));
  }
}

struct ArrayType {
  const char* name;
  size_t bytes;
  int bits;  // of codes; 0: floats
  void (*read)(const char*, size_t, std::vector<float>*);
};

constexpr ArrayType kTypes[] = {{"|u1", 1, 8, ReadValues<uint8_t>},
                                {"<u1", 1, 8, ReadValues<uint8_t>},
                                {"<u2", 2, 16, ReadValues<uint16_t>},
                                {"<f4", 4, 0, ReadValues<float>},
                                {"<f8", 8, 0, ReadValues<double>}};

StatusOr<ArrayType> FindType(const std::string& path, const std::string& name) {
  for (const ArrayType& type : kTypes) {
    if (name == type.name) return type;
  }
  return InvalidInput(
      path + ": descr",
      "expected |u1, <u2, <f4 or <f8, found " + name.substr(0, 20));
}

Status CheckShape(const std::string& path, const NpyHeader& header,
                  const ImageLimits& limits) {
  const std::vector<int64_t>& shape = header.shape;
  if (shape.size() != 2 && !(shape.size() == 3 && shape[2] == 3)) {
    return InvalidInput(path + ": shape",
                        "expected [height, width, 3] or [height, width], "
                        "found " +
                            ShapeText(shape));
  }
  if (header.fortran_order) {
    return InvalidInput(path + ": fortran_order",
                        "expected False (numpy.ascontiguousarray)");
  }
  return CheckImageSize(path, shape[1], shape[0], limits);
}

}  // namespace

StatusOr<Photo> DecodeNpy(const std::string& path, const std::string& bytes,
                          const ImageLimits& limits) {
  const StatusOr<NpyHeader> header = ReadNpyHeader(path, bytes);
  if (!header.ok()) return header.status();
  const StatusOr<ArrayType> type = FindType(path, header->type);
  if (!type.ok()) return type.status();
  IBRDF_RETURN_IF_ERROR(CheckShape(path, *header, limits));
  const bool grey = header->shape.size() == 2;
  const size_t pixels =
      static_cast<size_t>(header->shape[0] * header->shape[1]);
  const size_t count = pixels * (grey ? 1 : 3);
  if (bytes.size() - header->data != count * type->bytes) {
    return InvalidInput(path, "expected " +
                                  std::to_string(count * type->bytes) +
                                  " bytes of values, found " +
                                  std::to_string(bytes.size() - header->data));
  }

  Photo photo;
  photo.format = PhotoFormat::kNpy;
  photo.bits = photo.significant_bits = type->bits;
  photo.grey = grey;
  photo.image.width = static_cast<int>(header->shape[1]);
  photo.image.height = static_cast<int>(header->shape[0]);
  std::vector<float> values;
  type->read(bytes.data() + header->data, count, &values);
  if (!grey) {
    photo.image.rgb = std::move(values);
    return photo;
  }
  photo.image.rgb.reserve(3 * count);
  for (const float value : values) {
    photo.image.rgb.insert(photo.image.rgb.end(), 3, value);
  }
  return photo;
}

}  // namespace ibrdf
