#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "ibrdf/io/polygon_mesh.h"
#include "ibrdf/io/text_numbers.h"

namespace ibrdf {
namespace {

// Splits text into lines of words; a backslash at the end of a line joins the
// next one to it. Words point into the text.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : text_(text) {}

  // False at the end of the text.
  bool Next(std::vector<std::string_view>* words) {
    words->clear();
    if (position_ >= text_.size()) return false;
    bool joined = true;
    while (joined && position_ < text_.size()) {
      size_t end = text_.find('\n', position_);
      if (end == std::string_view::npos) end = text_.size();
      std::string_view line = text_.substr(position_, end - position_);
      position_ = end + 1;
      ++line_;
      if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
      joined = !line.empty() && line.back() == '\\';
      if (joined) line.remove_suffix(1);
      SplitWords(line.substr(0, line.find('#')), words);
    }
    return true;
  }

  std::string Where(const std::string& path) const {
    return path + ": line " + std::to_string(line_);
  }

 private:
  std::string_view text_;
  size_t position_ = 0;
  int64_t line_ = 0;
};

// The vector of a line "v x y z" or "vn x y z".
bool AppendVector(const std::vector<std::string_view>& words,
                  PolygonMesh* mesh) {
  double xyz[3];
  if (words.size() < 4) return false;
  for (size_t i = 0; i < 3; ++i) {
    if (!ParseNumber(words[i + 1], &xyz[i])) return false;
  }
  if (words[0] == "v") return AppendVertex(xyz, mesh);
  AppendNormal(xyz, mesh);
  return true;
}

// 1-based index from one that may count back from the last (-1).
bool Resolve(std::string_view text, int64_t so_far, int64_t total,
             int64_t* index) {
  if (!ParseNumber(text, index)) return false;
  if (*index < 0) *index += so_far + 1;
  return *index >= 1 && *index <= total;
}

// Keywords of OBJ are ASCII; lines of others would pass for unknown ones, and
// what they say be lost.
bool IsPlain(std::string_view word) {
  return std::all_of(word.begin(), word.end(),
                     [](char c) { return c > ' ' && c < '\x7f'; });
}

// A line's words, as far as a message takes them.
std::string Joined(const std::vector<std::string_view>& words) {
  constexpr size_t kMaxShown = 60;
  std::string line;
  for (const std::string_view word : words) {
    if (line.size() > kMaxShown) break;
    line += (line.empty() ? "" : " ") + std::string(word.substr(0, kMaxShown));
  }
  return line;
}

struct Counts {
  int64_t vertices = 0;
  int64_t normals = 0;

  void Add(std::string_view keyword) {
    vertices += keyword == "v";
    normals += keyword == "vn";
  }
};

// Vertex and normal of the corner "v", "v/t", "v//n" or "v/t/n"; normal 0 where
// there is none.
bool ParseCorner(std::string_view word, const Counts& so_far,
                 const Counts& total, int64_t* vertex, int64_t* normal) {
  *normal = 0;
  const size_t first = word.find('/');
  if (!Resolve(word.substr(0, first), so_far.vertices, total.vertices,
               vertex)) {
    return false;
  }
  if (first == std::string_view::npos) return true;
  const size_t second = word.find('/', first + 1);
  if (second == std::string_view::npos || second + 1 == word.size()) {
    return true;
  }
  return Resolve(word.substr(second + 1), so_far.normals, total.normals,
                 normal);
}

}  // namespace

StatusOr<PolygonMesh> ParseObj(const std::string& path,
                               const std::string& bytes) {
  // What is there, so that indices can be checked before they are passed on.
  Counts total;
  bool all_have_normals = true, has_faces = false;
  std::vector<std::string_view> words;
  const std::string_view text = WithoutByteOrderMark(bytes);
  LineReader survey(text);
  while (survey.Next(&words)) {
    if (words.empty()) continue;
    if (!IsPlain(words[0])) {
      return InvalidInput(survey.Where(path),
                          "expected a keyword of OBJ, found bytes that are no "
                          "text");
    }
    total.Add(words[0]);
    if (words[0] != "f") continue;
    has_faces = true;
    for (size_t i = 1; i < words.size(); ++i) {
      const size_t first = words[i].find('/');
      const size_t second = first == std::string_view::npos
                                ? first
                                : words[i].find('/', first + 1);
      all_have_normals = all_have_normals && second != std::string_view::npos &&
                         second + 1 < words[i].size();
    }
  }
  if (!has_faces) {
    return InvalidInput(path + ": faces", "expected at least one face");
  }

  PolygonMesh mesh;
  Counts so_far;
  LineReader reader(text);
  while (reader.Next(&words)) {
    if (words.empty()) continue;
    so_far.Add(words[0]);
    if (words[0] == "v" || (words[0] == "vn" && all_have_normals)) {
      if (!AppendVector(words, &mesh)) {
        return InvalidInput(
            reader.Where(path),
            "expected three finite numbers, found '" + Joined(words) + "'");
      }
    } else if (words[0] == "f") {
      if (words.size() < 4 || words.size() > size_t{kMaxPolygonCorners} + 1) {
        return InvalidInput(
            reader.Where(path),
            "expected a face of 3 to " + std::to_string(kMaxPolygonCorners) +
                " corners, found " + std::to_string(words.size() - 1));
      }
      mesh.sizes.push_back(static_cast<int>(words.size() - 1));
      for (size_t i = 1; i < words.size(); ++i) {
        int64_t vertex = 0, normal = 0;
        if (!ParseCorner(words[i], so_far, total, &vertex, &normal)) {
          return InvalidInput(reader.Where(path),
                              "expected indices of the file's " +
                                  std::to_string(total.vertices) +
                                  " vertices and " +
                                  std::to_string(total.normals) + " normals");
        }
        mesh.corners.push_back(static_cast<int>(vertex - 1));
        if (all_have_normals) {
          mesh.corner_normals.push_back(static_cast<int>(normal - 1));
        }
      }
    }
  }
  return mesh;
}

}  // namespace ibrdf
