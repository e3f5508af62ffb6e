// Trained models of the invertible BRDF on disk.
#pragma once
#include <array>
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/flow/neural_brdf_model.h"

namespace ibrdf {

// Format, version 3: the line "ibrdf-model 3\n"; a decimal byte count and "\n";
// that many bytes of JSON (shape, exponent, fit_lobes, names, note); the
// float32 arrays weights, codes, log_colours and lobe_fits, little endian; a
// 64-bit FNV-1a checksum of everything before it. Version 4 differs in its
// lobe_fits, which have a Lambertian lobe. Refused with a message that
// names file and field: another magic or version, sizes that do not fit, a
// wrong checksum, numbers that are not finite, codes outside the unit ball.
StatusOr<NeuralBrdfModel> ReadModel(const std::string& path);

// The same of a file's bytes; messages call it `path`.
StatusOr<NeuralBrdfModel> DecodeModel(const std::string& path,
                                      const std::string& bytes);

Status WriteModel(const NeuralBrdfModel& model, const std::string& path);

// Path of the model called `name`: "default" and "broad" are looked for in
// $IBRDF_MODEL_DIR, beside the installed library and in the source tree;
// anything else is a path.
StatusOr<std::string> FindModel(const std::string& name);

// Paths of the models that take the places of "default" and "broad" where
// `reflectance.model` is a folder.
std::array<std::string, 2> ModelsOfFolder(const std::string& folder);

}  // namespace ibrdf
