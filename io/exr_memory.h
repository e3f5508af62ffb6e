// OpenEXR files in memory, and what is checked before OpenEXR allocates.
#pragma once
#include <ImfHeader.h>
#include <ImfIO.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/io/image_limits.h"

namespace ibrdf {

inline constexpr size_t kExrHeaderStart = 8;  // after magic number and version

// The file is held in memory, so every read is checked against its length.
class ExrMemoryInput final : public Imf::IStream {
 public:
  // `bytes` outlives the stream.
  ExrMemoryInput(const std::string& path, const std::string& bytes)
      : Imf::IStream(path.c_str()), bytes_(bytes) {}

  bool read(char c[], int n) override;
  uint64_t tellg() override { return position_; }
  void seekg(uint64_t position) override { position_ = position; }

 private:
  const std::string& bytes_;
  uint64_t position_ = 0;
};

// The version number and flags of a file of kExrHeaderStart bytes or more.
int ExrVersion(const std::string& bytes);
bool IsMultiPartExr(const std::string& bytes);

// OpenEXR allocates what an attribute claims before it reads it: every claim
// must fit into the file. A header that is cut off is left to OpenEXR.
Status CheckExrAttributes(const std::string& path, const std::string& bytes);

// The header is of an image (not deep) within the limits; so are its tiles.
Status CheckExrHeader(const std::string& path, const Imf::Header& header,
                      const ImageLimits& limits);

}  // namespace ibrdf
