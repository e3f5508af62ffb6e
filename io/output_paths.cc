#include "ibrdf/io/output_paths.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace ibrdf {
namespace {

// The file that the problem names and that `path` is; null: none.
const NamedFile* NamedAs(const std::vector<NamedFile>& named,
                         const std::filesystem::path& path) {
  const auto found =
      std::find_if(named.begin(), named.end(), [&](const NamedFile& file) {
        std::error_code ignored;
        return std::filesystem::equivalent(path, file.path, ignored);
      });
  return found == named.end() ? nullptr : &*found;
}

}  // namespace

Status PrepareFolder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return InvalidInput(folder, error.message());
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    return InvalidInput(folder, "expected a folder that can be written to");
  }
  return OkStatus();
}

Status CheckNothingReplaced(const Problem& problem,
                            const std::vector<std::string>& paths,
                            const std::vector<NamedFile>& more) {
  std::vector<NamedFile> named = NamedFiles(problem);
  named.insert(named.end(), more.begin(), more.end());
  for (const std::string& path : paths) {
    if (const NamedFile* const file = NamedAs(named, path)) {
      return InvalidInput(problem.path + ": " + file->key,
                          "expected a file that no result replaces, found '" +
                              file->path + "', which " + path + " is");
    }
  }
  return OkStatus();
}

std::string ViewFolder(const std::string& folder, const std::string& name) {
  return (std::filesystem::path(folder) / "views" / name).string();
}

void RemoveEarlier(const Problem& problem, const std::string& folder,
                   const std::vector<std::string>& names) {
  const std::vector<NamedFile> named = NamedFiles(problem);
  for (const std::string& name : names) {
    const std::filesystem::path path = std::filesystem::path(folder) / name;
    std::error_code ignored;
    if (NamedAs(named, path) == nullptr) {
      std::filesystem::remove(path, ignored);
    }
  }
}

}  // namespace ibrdf
