// Each parser on arbitrary bytes, and what must hold of its answer.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace ibrdf {

// Names of the parsers: exr, hdr, png, merl, obj, ply, problem, model.
const std::vector<std::string>& FuzzedParsers();

// Feeds `input` to the parser of that name through a file; dies (CHECK) where
// its answer breaks the parser's promises: values of a size that fits, finite
// where promised, indices in range, or else an error of one line that names the
// file. How an input becomes a file:
//   merl     an odd first byte: a valid table with patches, each of 4 bytes
//            position and 8 bytes value; an even one: the rest as it is
//   model    an odd first byte: the rest with the checksum that fits it
//   problem  the text up to a byte 0xff, then overrides, split there
//   others   the bytes as they are
void FuzzParser(const std::string& parser, const uint8_t* input, size_t size);

}  // namespace ibrdf
