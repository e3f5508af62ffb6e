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
    return path + ": " + Line();
  }
  std::string Line() const { return "line " + std::to_string(line_); }

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
  int64_t texture = 0;

  void Add(std::string_view keyword) {
    vertices += keyword == "v";
    normals += keyword == "vn";
    texture += keyword == "vt";
  }
};

// The text between the first and the second slash of a corner, if any.
std::string_view TextureWord(std::string_view corner) {
  const size_t first = corner.find('/');
  if (first == std::string_view::npos) return {};
  return corner.substr(first + 1, corner.find('/', first + 1) - first - 1);
}

// Reads the texture coordinates of a file; the first fault ends it.
class ObjTexture {
 public:
  // total: of the file. some, all: corners that have texture coordinates.
  ObjTexture(const Counts& total, bool some, bool all, PolygonMesh* mesh)
      : total_(total), mesh_(mesh), used_(some && all) {
    if (some && !all) {
      Fail("expected texture coordinates (vt) on all faces or on none");
    }
  }

  // "vt u v" or "vt u".
  void AddCoordinates(const std::vector<std::string_view>& words,
                      const LineReader& at) {
    if (!used_) return;
    double uv[2] = {0.0, 0.0};
    bool ok = words.size() > 1 && ParseNumber(words[1], &uv[0]);
    if (ok && words.size() > 2) ok = ParseNumber(words[2], &uv[1]);
    if (!ok || !AppendTexture(uv, mesh_)) {
      Fail("expected vt and finite numbers at " + at.Line());
    }
  }

  void AddCorner(std::string_view word, const Counts& so_far,
                 const LineReader& at) {
    if (!used_) return;
    int64_t index = 0;
    if (!Resolve(TextureWord(word), so_far.texture, total_.texture, &index)) {
      Fail("expected indices of the file's " + std::to_string(total_.texture) +
           " texture coordinates (vt) at " + at.Line());
      return;
    }
    mesh_->corner_texture.push_back(static_cast<int>(index - 1));
  }

 private:
  void Fail(const std::string& what) {
    used_ = false;
    mesh_->texture.clear();
    mesh_->corner_texture.clear();
    mesh_->texture_fault = what;
  }

  const Counts& total_;
  PolygonMesh* mesh_;
  bool used_;
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

// What is there, so that indices can be checked before they are passed on.
struct ObjSurvey {
  Counts total;
  bool has_faces = false;
  bool all_have_normals = true;  // the corners of faces
  bool some_have_texture = false, all_have_texture = true;

  void AddCorner(std::string_view word) {
    const size_t first = word.find('/');
    const size_t second =
        first == std::string_view::npos ? first : word.find('/', first + 1);
    all_have_normals = all_have_normals && second != std::string_view::npos &&
                       second + 1 < word.size();
    const bool has_texture = !TextureWord(word).empty();
    some_have_texture = some_have_texture || has_texture;
    all_have_texture = all_have_texture && has_texture;
  }
};

Status SurveyObj(const std::string& path, std::string_view text,
                 ObjSurvey* survey) {
  std::vector<std::string_view> words;
  LineReader reader(text);
  while (reader.Next(&words)) {
    if (words.empty()) continue;
    if (!IsPlain(words[0])) {
      return InvalidInput(reader.Where(path),
                          "expected a keyword of OBJ, found bytes that are no "
                          "text");
    }
    survey->total.Add(words[0]);
    if (words[0] != "f") continue;
    survey->has_faces = true;
    for (size_t i = 1; i < words.size(); ++i) survey->AddCorner(words[i]);
  }
  if (!survey->has_faces) {
    return InvalidInput(path + ": faces", "expected at least one face");
  }
  return OkStatus();
}

}  // namespace

StatusOr<PolygonMesh> ParseObj(const std::string& path,
                               const std::string& bytes) {
  const std::string_view text = WithoutByteOrderMark(bytes);
  ObjSurvey survey;
  IBRDF_RETURN_IF_ERROR(SurveyObj(path, text, &survey));
  const Counts& total = survey.total;
  PolygonMesh mesh;
  ObjTexture texture(total, survey.some_have_texture, survey.all_have_texture,
                     &mesh);
  std::vector<std::string_view> words;
  Counts so_far;
  LineReader reader(text);
  while (reader.Next(&words)) {
    if (words.empty()) continue;
    so_far.Add(words[0]);
    if (words[0] == "v" || (words[0] == "vn" && survey.all_have_normals)) {
      if (!AppendVector(words, &mesh)) {
        return InvalidInput(
            reader.Where(path),
            "expected three finite numbers, found '" + Joined(words) + "'");
      }
    } else if (words[0] == "vt") {
      texture.AddCoordinates(words, reader);
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
        if (survey.all_have_normals) {
          mesh.corner_normals.push_back(static_cast<int>(normal - 1));
        }
        texture.AddCorner(words[i], so_far, reader);
      }
    }
  }
  return mesh;
}

}  // namespace ibrdf
