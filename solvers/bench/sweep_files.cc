#include "ibrdf/solvers/bench/sweep_files.h"

#include <algorithm>
#include <filesystem>

namespace ibrdf {
namespace {
namespace fs = std::filesystem;
}  // namespace

std::vector<std::string> MapExtensions() { return {".hdr", ".exr"}; }

std::string FindFile(const std::string& folder, const std::string& name,
                     const std::vector<std::string>& extensions) {
  for (const std::string& extension : extensions) {
    const fs::path path = fs::path(folder) / (name + extension);
    if (fs::is_regular_file(path)) return fs::absolute(path).string();
  }
  return "";
}

StatusOr<std::vector<std::string>> ListNames(
    const std::string& folder, const std::vector<std::string>& extensions) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string extension = entry.path().extension().string();
    if (std::find(extensions.begin(), extensions.end(), extension) !=
        extensions.end()) {
      names.push_back(entry.path().stem().string());
    }
  }
  if (error) return InvalidInput(folder, error.message());
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

Status CheckCaseName(const std::string& name) {
  if (name.find_first_of(",\"\r\n|/") == std::string::npos) return OkStatus();
  return InvalidInput("command line", name +
                                          ": expected names without "
                                          "comma, quote, bar or slash");
}

}  // namespace ibrdf
