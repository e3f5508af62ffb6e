// Problem files: YAML -> Problem.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/io/problem_schema.h"

namespace ibrdf {

// Reads `path`, then applies `overrides` ("key.path=value", as --set; see
// ApplyOverride in io/config_tree.h), then checks every key, type and range.
// Relative paths, those of overrides too, are relative to the file's folder.
// Messages name the file and the full key. A key under a former name is taken
// with a warning in the log.
StatusOr<Problem> ReadProblem(const std::string& path,
                              const std::vector<std::string>& overrides);

// The same for a file's text, which messages call `path`, under a schema.
StatusOr<Problem> ParseProblem(
    const std::string& path, const std::string& text,
    const std::vector<std::string>& overrides,
    const ProblemSchema& schema = ProblemFileSchema());

// A file that a problem names, and the key that names it.
struct NamedFile {
  std::string key;  // "image.file"; of the problem file itself "problem"
  std::string path;
};
std::vector<NamedFile> NamedFiles(const Problem& problem);

// What an estimate needs: an image file, and known exactly what `problem` says
// is known.
Status CheckSolvable(const Problem& problem);

// What a map of uncertainty needs: views with their images, a surface, and
// known illumination.
Status CheckTextures(const Problem& problem);

// What a render needs: known reflectance and illumination, and the size of the
// image.
Status CheckRenderable(const Problem& problem);

}  // namespace ibrdf
