#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ibrdf/io/polygon_mesh.h"
#include "ibrdf/io/text_numbers.h"

namespace ibrdf {
namespace {

constexpr size_t kStlHeader = 84;  // 80 bytes of anything, the count
constexpr size_t kStlFacet = 50;   // 12 floats, 2 bytes of anything

uint32_t StlWord(std::string_view bytes, size_t at) {
  uint32_t word = 0;
  for (size_t i = 4; i-- > 0;) {
    word = word << 8 | static_cast<uint8_t>(bytes[at + i]);
  }
  return word;
}

// Bytes that the count of a binary file asks for; 0 without a count.
uint64_t BinaryStlSize(std::string_view bytes) {
  if (bytes.size() < kStlHeader) return 0;
  return kStlHeader + uint64_t{kStlFacet} * StlWord(bytes, kStlHeader - 4);
}

void AddStlTriangle(PolygonMesh* mesh) {
  const int first = static_cast<int>(mesh->corners.size());
  mesh->sizes.push_back(3);
  mesh->corners.insert(mesh->corners.end(), {first, first + 1, first + 2});
}

StatusOr<PolygonMesh> ParseBinaryStl(const std::string& path,
                                     std::string_view bytes) {
  if (bytes.size() < kStlHeader) {
    return InvalidInput(
        path + ": header",
        "expected \"solid\", or 84 bytes of binary STL, found " +
            std::to_string(bytes.size()) + " bytes");
  }
  const uint32_t count = StlWord(bytes, kStlHeader - 4);
  if (BinaryStlSize(bytes) != bytes.size()) {
    return InvalidInput(path + ": header",
                        "expected a count that fits the file's " +
                            std::to_string(bytes.size()) + " bytes, found " +
                            std::to_string(count) + " triangles of 50 bytes");
  }
  PolygonMesh mesh;
  for (uint32_t i = 0; i < count; ++i) {
    for (size_t corner = 0; corner < 3; ++corner) {
      double xyz[3];
      for (size_t k = 0; k < 3; ++k) {  // after the facet's normal
        const uint32_t word = StlWord(
            bytes, kStlHeader + kStlFacet * i + 12 * (corner + 1) + 4 * k);
        float value = 0.0f;
        std::memcpy(&value, &word, sizeof(value));
        xyz[k] = value;
      }
      if (!AppendVertex(xyz, &mesh)) {
        return InvalidInput(path + ": triangle " + std::to_string(i),
                            "expected finite coordinates");
      }
    }
    AddStlTriangle(&mesh);
  }
  return mesh;
}

std::string InLowerCase(std::string_view word) {
  std::string out(word);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

// Reads solids of facets, line by line.
class TextStlReader {
 public:
  TextStlReader(const std::string& path, std::string_view text)
      : path_(path), text_(text) {}

  StatusOr<PolygonMesh> Read() {
    while (!text_.empty()) {
      const size_t end = std::min(text_.find('\n'), text_.size());
      std::string_view line = text_.substr(0, end);
      text_.remove_prefix(std::min(end + 1, text_.size()));
      ++line_;
      if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
      words_.clear();
      SplitWords(line, &words_);
      if (words_.empty()) continue;
      const Status status = ReadLine(InLowerCase(words_[0]));
      if (!status.ok()) return status;
    }
    if (in_solid_) {
      return InvalidInput(path_, "expected \"endsolid\" at the end: cut off");
    }
    return std::move(mesh_);
  }

 private:
  Status Fail(const std::string& what) const {
    return InvalidInput(path_ + ": line " + std::to_string(line_), what);
  }

  Status ReadLine(const std::string& keyword) {
    if (keyword == "vertex") return ReadVertex();
    if (keyword == "solid" || keyword == "endsolid") {
      const bool begins = keyword == "solid";
      if (in_solid_ == begins || vertices_ != 0) {
        return Fail("expected \"" + keyword + "\" outside of facets");
      }
      in_solid_ = begins;
      return OkStatus();
    }
    if (keyword == "endfacet") {
      if (vertices_ != 3) {
        return Fail("expected a facet of three vertices, found " +
                    std::to_string(vertices_));
      }
      AddStlTriangle(&mesh_);
      vertices_ = 0;
      return OkStatus();
    }
    if (keyword != "facet" && keyword != "outer" && keyword != "endloop") {
      return Fail("expected facet, outer loop, vertex or their ends");
    }
    return keyword == "endloop" || vertices_ == 0
               ? OkStatus()
               : Fail("expected \"endfacet\" before another facet");
  }

  Status ReadVertex() {
    double xyz[3];
    if (words_.size() != 4 || !in_solid_) {
      return Fail("expected a vertex of three numbers in a solid");
    }
    for (size_t i = 0; i < 3; ++i) {
      if (!ParseNumber(words_[i + 1], &xyz[i])) {
        return Fail("expected three finite numbers");
      }
    }
    if (!AppendVertex(xyz, &mesh_))
      return Fail("expected three finite numbers");
    ++vertices_;
    return OkStatus();
  }

  const std::string& path_;
  std::string_view text_;
  std::vector<std::string_view> words_;
  PolygonMesh mesh_;
  int64_t line_ = 0;
  int64_t vertices_ = 0;  // of the facet
  bool in_solid_ = false;
};

// Binary files may begin with "solid" too; their size tells them.
bool IsTextStl(std::string_view bytes) {
  if (BinaryStlSize(bytes) == bytes.size()) return false;
  const std::string_view text = WithoutByteOrderMark(bytes);
  const size_t start = std::min(text.find_first_not_of(" \t\r\n"), text.size());
  return InLowerCase(text.substr(start, 5)) == "solid" &&
         text.find('\0') == std::string_view::npos;
}

}  // namespace

StatusOr<PolygonMesh> ParseStl(const std::string& path,
                               const std::string& bytes) {
  StatusOr<PolygonMesh> mesh =
      IsTextStl(bytes) ? TextStlReader(path, WithoutByteOrderMark(bytes)).Read()
                       : ParseBinaryStl(path, bytes);
  if (mesh.ok() && mesh->sizes.empty()) {
    return InvalidInput(path + ": faces", "expected at least one face");
  }
  return mesh;
}

}  // namespace ibrdf
