#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string_view>
#include <vector>

#include "ibrdf/io/polygon_mesh.h"
#include "ibrdf/io/text_numbers.h"

namespace ibrdf {
namespace {

enum class Type {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kFloat,
  kDouble
};

struct Property {
  std::string name;
  Type type = Type::kFloat;
  bool is_list = false;
  Type count_type = Type::kUint8;
};

struct Element {
  std::string name;
  int64_t count = 0;
  std::vector<Property> properties;
};

enum class Format { kUnknown, kAscii, kLittleEndian, kBigEndian };

struct PlyHeader {
  Format format = Format::kUnknown;
  std::vector<Element> elements;
  size_t end = 0;  // first byte after the header
};

bool ParseType(const std::string& name, Type* type) {
  static constexpr struct {
    const char* name;
    Type type;
  } kNames[] = {{"char", Type::kInt8},     {"int8", Type::kInt8},
                {"uchar", Type::kUint8},   {"uint8", Type::kUint8},
                {"short", Type::kInt16},   {"int16", Type::kInt16},
                {"ushort", Type::kUint16}, {"uint16", Type::kUint16},
                {"int", Type::kInt32},     {"int32", Type::kInt32},
                {"uint", Type::kUint32},   {"uint32", Type::kUint32},
                {"float", Type::kFloat},   {"float32", Type::kFloat},
                {"double", Type::kDouble}, {"float64", Type::kDouble}};
  for (const auto& entry : kNames) {
    if (name == entry.name) {
      *type = entry.type;
      return true;
    }
  }
  return false;
}

size_t Bytes(Type type) {
  switch (type) {
    case Type::kInt8:
    case Type::kUint8:
      return 1;
    case Type::kInt16:
    case Type::kUint16:
      return 2;
    case Type::kInt32:
    case Type::kUint32:
    case Type::kFloat:
      return 4;
    case Type::kDouble:
      return 8;
  }
  return 0;
}

// Keywords after the first line of the header; false where malformed.
bool ParseHeaderLine(const std::string& line, PlyHeader* header) {
  std::istringstream words(line);
  std::string keyword, name;
  words >> keyword;
  if (keyword == "format") {
    words >> name;
    header->format = name == "ascii"                  ? Format::kAscii
                     : name == "binary_little_endian" ? Format::kLittleEndian
                     : name == "binary_big_endian"    ? Format::kBigEndian
                                                      : Format::kUnknown;
    return header->format != Format::kUnknown;
  }
  if (keyword == "element") {
    Element element;
    words >> element.name >> element.count;
    header->elements.push_back(element);
    return !words.fail() && element.count >= 0 && element.count <= INT32_MAX;
  }
  if (keyword == "property") {
    Property property;
    words >> name;
    property.is_list = name == "list";
    if (property.is_list) {
      words >> name;
      if (!ParseType(name, &property.count_type)) return false;
      words >> name;
    }
    if (!ParseType(name, &property.type) || header->elements.empty()) {
      return false;
    }
    words >> property.name;
    header->elements.back().properties.push_back(property);
    return !words.fail();
  }
  return keyword == "comment" || keyword == "obj_info" || keyword.empty();
}

StatusOr<PlyHeader> ParsePlyHeader(const std::string& path,
                                   const std::string& bytes) {
  PlyHeader header;
  header.end = bytes.size() - WithoutByteOrderMark(bytes).size();
  for (int line_number = 1; header.end < bytes.size(); ++line_number) {
    const size_t newline = bytes.find('\n', header.end);
    if (newline == std::string::npos) break;
    std::string line = bytes.substr(header.end, newline - header.end);
    header.end = newline + 1;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line_number == 1) {
      if (line != "ply") break;
    } else if (line == "end_header") {
      if (header.format == Format::kUnknown) break;
      return header;
    } else if (!ParseHeaderLine(line, &header)) {
      return InvalidInput(
          path + ": header: line " + std::to_string(line_number),
          "expected a format, element or property of PLY");
    }
  }
  return InvalidInput(path + ": header",
                      "expected \"ply\", a format and \"end_header\"");
}

// The numbers of the body, one after another.
class NumberReader {
 public:
  NumberReader(std::string_view bytes, Format format)
      : bytes_(bytes), format_(format) {}

  size_t Left() const { return bytes_.size(); }

  // False at the end of the bytes, or where ascii is not a number.
  bool Next(Type type, double* value) {
    return format_ == Format::kAscii ? NextWord(value)
                                     : NextBinary(type, value);
  }

 private:
  bool NextWord(double* value) {
    constexpr char kSpace[] = " \t\r\n";
    const size_t start = bytes_.find_first_not_of(kSpace);
    if (start == std::string_view::npos) return false;
    bytes_.remove_prefix(start);
    const std::string_view word =
        bytes_.substr(0, bytes_.find_first_of(kSpace));
    bytes_.remove_prefix(word.size());
    return ParseNumber(word, value);
  }

  bool NextBinary(Type type, double* value) {
    const size_t size = Bytes(type);
    if (bytes_.size() < size) return false;
    uint64_t bits = 0;
    for (size_t i = 0; i < size; ++i) {
      const size_t at = format_ == Format::kBigEndian ? i : size - 1 - i;
      bits = bits << 8 | static_cast<uint8_t>(bytes_[at]);
    }
    bytes_.remove_prefix(size);
    switch (type) {
      case Type::kInt8:
        *value = static_cast<int8_t>(bits);
        break;
      case Type::kInt16:
        *value = static_cast<int16_t>(bits);
        break;
      case Type::kInt32:
        *value = static_cast<int32_t>(bits);
        break;
      case Type::kFloat: {
        const uint32_t word = static_cast<uint32_t>(bits);
        float single = 0.0f;
        std::memcpy(&single, &word, sizeof(single));
        *value = single;
        break;
      }
      case Type::kDouble:
        std::memcpy(value, &bits, sizeof(*value));
        break;
      default:
        *value = static_cast<double>(bits);
    }
    return true;
  }

  std::string_view bytes_;
  Format format_;
};

// Bytes that `count` rows of the element take at least.
bool FitsInto(const Element& element, Format format, size_t left) {
  size_t row = 0;
  for (const Property& p : element.properties) {
    // Text: one character and a separator, which the last number may lack.
    row +=
        format == Format::kAscii ? 2 : Bytes(p.is_list ? p.count_type : p.type);
  }
  return row == 0 || static_cast<size_t>(element.count) <= (left + 1) / row;
}

// Slots of x y z nx ny nz s t; -1 for other properties.
int VertexSlot(const std::string& name) {
  static constexpr const char* kSlots[] = {"x",  "y",  "z", "nx",
                                           "ny", "nz", "s", "t"};
  for (int i = 0; i < 8; ++i) {
    if (name == kSlots[i]) return i;
  }
  if (name == "u" || name == "texture_u") return 6;
  if (name == "v" || name == "texture_v") return 7;
  return -1;
}

// Reads the rows of one element into the mesh.
class ElementReader {
 public:
  ElementReader(const std::string& path, const Element& element,
                NumberReader* numbers, PolygonMesh* mesh)
      : path_(path),
        element_(element),
        numbers_(numbers),
        mesh_(mesh),
        is_vertex_(element.name == "vertex"),
        is_strip_(element.name == "tristrips"),
        has_corners_(element.name == "face" || is_strip_) {}

  Status Read() {
    unsigned slots_found = 0;
    for (const Property& p : element_.properties) {
      const int slot = p.is_list ? -1 : VertexSlot(p.name);
      if (slot >= 0) slots_found |= 1u << slot;
    }
    if (is_vertex_ && (slots_found & 7u) != 7u) {
      return InvalidInput(path_ + ": vertex", "expected properties x, y and z");
    }
    has_normals_ = is_vertex_ && (slots_found & 56u) == 56u;
    has_texture_ = is_vertex_ && (slots_found & 192u) == 192u;
    if (element_.properties.empty()) return OkStatus();
    for (row_ = 0; row_ < element_.count; ++row_) {
      IBRDF_RETURN_IF_ERROR(ReadRow());
    }
    return OkStatus();
  }

 private:
  std::string Where() const {
    return path_ + ": " + element_.name + " " + std::to_string(row_);
  }

  Status ReadRow() {
    double slots[8] = {};
    for (const Property& p : element_.properties) {
      double value = 0.0;
      if (!numbers_->Next(p.is_list ? p.count_type : p.type, &value)) {
        return InvalidInput(Where(), "expected a number for " + p.name);
      }
      if (p.is_list) {
        IBRDF_RETURN_IF_ERROR(ReadList(p, value));
      } else if (const int slot = is_vertex_ ? VertexSlot(p.name) : -1;
                 slot >= 0) {
        slots[slot] = value;
      }
    }
    if (!is_vertex_) return OkStatus();
    if (!AppendVertex(slots, mesh_)) {
      return InvalidInput(Where(), "expected finite coordinates");
    }
    if (has_normals_) AppendNormal(slots + 3, mesh_);
    if (has_texture_) AppendTexture(slots + 6, mesh_);
    return OkStatus();
  }

  Status ReadList(const Property& p, double count) {
    const bool corners = has_corners_ && (p.name == "vertex_indices" ||
                                          p.name == "vertex_index");
    const int least = corners && !is_strip_ ? 3 : 0;
    const int most = corners && !is_strip_ ? kMaxPolygonCorners : INT32_MAX;
    if (!(count >= least && count <= most)) {
      return InvalidInput(Where() + ": " + p.name,
                          "expected a list of " +
                              (least > 0 ? "3 to " + std::to_string(most)
                                         : std::string("0 or more")) +
                              " numbers");
    }
    if (corners && !is_strip_) mesh_->sizes.push_back(static_cast<int>(count));
    strip_.clear();
    for (int i = 0; i < static_cast<int>(count); ++i) {
      double item = 0.0;
      if (!numbers_->Next(p.type, &item)) {
        return InvalidInput(Where(), "expected a number for " + p.name);
      }
      if (corners) IBRDF_RETURN_IF_ERROR(AddCorner(item));
    }
    return corners && is_strip_ ? EndStrip() : OkStatus();
  }

  Status AddCorner(double item) {
    if (is_strip_ && item == -1.0) return EndStrip();  // another begins
    if (!(item >= 0.0 && item <= INT32_MAX && item == std::floor(item))) {
      return InvalidInput(Where(), "expected indices of vertices");
    }
    (is_strip_ ? strip_ : mesh_->corners).push_back(static_cast<int>(item));
    return OkStatus();
  }

  Status EndStrip() {
    const bool fits = AppendStrip(strip_, mesh_);
    strip_.clear();
    return fits ? OkStatus()
                : InvalidInput(Where(), "expected strips of at most " +
                                            std::to_string(kMaxStripTriangles) +
                                            " triangles in all");
  }

  const std::string& path_;
  const Element& element_;
  NumberReader* numbers_;
  PolygonMesh* mesh_;
  const bool is_vertex_, is_strip_, has_corners_;
  bool has_normals_ = false, has_texture_ = false;
  int64_t row_ = 0;
  std::vector<int> strip_;
};

}  // namespace

StatusOr<PolygonMesh> ParsePly(const std::string& path,
                               const std::string& bytes) {
  const StatusOr<PlyHeader> header = ParsePlyHeader(path, bytes);
  if (!header.ok()) return header.status();
  PolygonMesh mesh;
  NumberReader numbers(std::string_view(bytes).substr(header->end),
                       header->format);
  for (const Element& element : header->elements) {
    if (element.name == "vertex" && !mesh.vertices.empty()) {
      return InvalidInput(path + ": header", "expected one element vertex");
    }
    if (!FitsInto(element, header->format, numbers.Left())) {
      return InvalidInput(path + ": header: " + element.name,
                          "expected a count that fits into the file, found " +
                              std::to_string(element.count));
    }
    IBRDF_RETURN_IF_ERROR(ElementReader(path, element, &numbers, &mesh).Read());
  }
  if (mesh.sizes.empty()) {
    return InvalidInput(path + ": faces", "expected at least one face");
  }
  const size_t vertices = mesh.vertices.size();
  size_t at = 0;
  for (size_t f = 0; f < mesh.sizes.size(); ++f) {
    for (int i = 0; i < mesh.sizes[f]; ++i) {
      if (static_cast<size_t>(mesh.corners[at++]) >= vertices) {
        return InvalidInput(path + ": face " + std::to_string(f),
                            "expected indices of the file's " +
                                std::to_string(vertices) + " vertices");
      }
    }
  }
  if (mesh.normals.size() == vertices) mesh.corner_normals = mesh.corners;
  UseVertexTexture(&mesh);
  return mesh;
}

}  // namespace ibrdf
