// glTF 2.0 documents in one file (.glb): checked access to their JSON and to
// the numbers of their buffer.
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "ibrdf/base/status.h"

namespace ibrdf {

// Rows of numbers inside a document's buffer.
class GltfNumbers {
 public:
  size_t count() const { return count_; }
  int components() const { return components_; }  // of a row: 1 to 4
  bool IsUnsigned() const;                        // whole numbers >= 0

  // row < count(), component < components(). Normalised where the file says so.
  double At(size_t row, int component) const;
  // The whole number of a row of one; IsUnsigned().
  uint32_t Index(size_t row) const;

 private:
  friend class GltfDocument;
  const char* first_ = nullptr;
  size_t count_ = 0, stride_ = 0;
  int components_ = 1, type_ = 0;
  bool normalized_ = false;
};

class GltfDocument {
 public:
  // `bytes` outlives the document. Refuses what is no GLB of glTF 2, is cut
  // off, or needs an extension by which its geometry could not be understood.
  static StatusOr<GltfDocument> Open(const std::string& path,
                                     std::string_view bytes);

  const nlohmann::json& json() const { return json_; }
  // Length of the list of that name; 0 where there is none.
  size_t Size(const char* list) const;
  // Entry of a list; index < Size(list).
  const nlohmann::json& At(const char* list, size_t index) const;
  // The accessor of that index, all of whose bytes are there.
  StatusOr<GltfNumbers> Numbers(size_t accessor) const;

  // An error in the document: "file.glb: where: what".
  Status Fail(const std::string& where, const std::string& what) const;

 private:
  Status CheckExtensions() const;
  // The bytes of a buffer view. `stride` is the distance of its rows, 0 where
  // the file does not say it.
  StatusOr<std::string_view> View(size_t view, size_t* stride) const;

  std::string path_;
  nlohmann::json json_;
  std::string_view buffer_;
};

// Reads a whole number below `end`; false where it is none.
bool GltfWhole(const nlohmann::json& number, uint64_t end, size_t* value);
// The same at a key; false where there is none.
bool GltfIndex(const nlohmann::json& object, const char* key, uint64_t end,
               size_t* value);

}  // namespace ibrdf
