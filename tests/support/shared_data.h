// Where tests find the third-party data that is not part of this repository.
#pragma once
#include <cstdlib>
#include <filesystem>
#include <string>

namespace ibrdf {

// The folder `data` of IBRDF_SHARED_DIR, or of ../shared beside the source
// tree; empty where there is none.
inline std::string SharedDataDir() {
  const char* shared = std::getenv("IBRDF_SHARED_DIR");
  const std::string data =
      (shared != nullptr ? std::string(shared)
                         : std::string(IBRDF_SOURCE_DIR) + "/../shared") +
      "/data";
  return std::filesystem::is_directory(data) ? data : std::string();
}

}  // namespace ibrdf

// First line of a test that reads shared data; defines `data_dir`.
#define IBRDF_REQUIRE_SHARED_DATA(data_dir)                                \
  const std::string data_dir = ::ibrdf::SharedDataDir();                   \
  if (data_dir.empty()) {                                                  \
    GTEST_SKIP() << "NOT TESTED: no shared data; set IBRDF_SHARED_DIR to " \
                    "the folder that holds data/";                         \
  }
