// Each parser on arbitrary bytes, and what must hold of its answer.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ibrdf/solvers/training/checkpoint.h"

namespace ibrdf {

// The bins of the tables that the parser of `merl` takes here.
inline constexpr std::array<int32_t, 3> kFuzzedMerlBins = {3, 2, 4};

// The name of the checkpoint that the parser of `checkpoint` expects.
inline constexpr char kFuzzedTraining[] = "training";
// Whole states are of its sizes.
TrainingState FuzzedTrainingState();
// The columns that the parser of `results` expects.
const std::vector<std::string>& FuzzedColumns();

// Names of the parsers. Files that users bring: exr, hdr, png, merl, obj, ply,
// stl, glb, problem, model; photographs photo_png, photo_jpeg, photo_tiff,
// photo_exr, npy, pfm, and what is inside of them, exif, icc; maps, depth and
// normals of any format: map, depth, normals. Cameras of other programs:
// transforms, colmap_text, colmap_binary. What is written of problems:
// config, flags. What programs leave for themselves: checkpoint (a training's),
// results (a sweep's table), trace (in result.json).
const std::vector<std::string>& FuzzedParsers();

// Feeds `input` to the parser of that name as a file's bytes; dies (CHECK)
// where its answer breaks the parser's promises: values of a size that fits,
// finite where promised, indices in range, or else an error of one line that
// names the file. How an input becomes a file:
//   png, photo_png
//            after the first byte; where that is odd, every chunk gets the
//            checksum that fits it
//   photo_exr
//            after the first byte; where that is odd, as normals
//   photo_png, photo_jpeg, photo_exr, npy
//            with the first bytes that the format has
//   model, checkpoint
//            after the first byte; where that is odd, with the checksum that
//            fits it at the end
//   map, depth, normals
//            after the first byte, which chooses among frames, cameras, scales
//            and encodings
//   glb      after the first byte; where that is odd, the JSON up to a byte
//            0xff and the buffer, in a container that fits them
//   colmap_text
//            cameras.txt up to a byte 0xff, then images.txt
//   colmap_binary
//            two bytes, the size of cameras.bin, which then comes before
//            images.bin
//   problem  the text up to a byte 0xff, then overrides, split there
//   flags    the flags of problem_from_flags.h in order, then overrides, split
//            there
//   others   the bytes as they are
void FuzzParser(const std::string& parser, const uint8_t* input, size_t size);

}  // namespace ibrdf
