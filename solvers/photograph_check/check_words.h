// A check in words.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/solvers/photograph_check/photograph_check.h"

namespace ibrdf {

// What the check says of one thing.
struct CheckFinding {
  std::string subject;  // "image", "its pixels", ...
  std::string text;     // without line ends
};
std::vector<CheckFinding> CheckFindings(const PhotographCheck& check);

// What an estimate takes an object for: a single material is misled by paint.
enum class MaterialsSought { kOne, kPainted, kLabelled };

// What makes the inputs doubtful: sentences that name the files.
std::vector<std::string> CheckWarnings(
    const PhotographCheck& check, const std::string& image_file,
    const std::string& normals_file,
    MaterialsSought sought = MaterialsSought::kOne);

// "as given", or "as given or x and y flipped, not told apart", or "y flipped".
std::string NormalsVerdict(const PhotographCheck& check);

// "one material may be", "several materials", or why it cannot be told.
std::string ColourVerdict(const PhotographCheck& check);

}  // namespace ibrdf
