// What the tables of keys are written with: rows, ranges and who uses a key.
#pragma once
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "ibrdf/io/problem_key.h"

namespace ibrdf {
namespace problem_keys {

using Words = std::vector<ProblemWord>;
using Keys = std::vector<ProblemKey>;

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr Range kPositive{0.0, kInfinity, false, true};
inline constexpr Range kNotNegative{0.0, kInfinity, true, true};
inline constexpr Range kUnitInterval{0.0, 1.0, true, true};
inline constexpr Range kAnyNumber{};

// Extensions of the files of environment maps.
inline constexpr char kMapFiles[] = ".exr, .hdr, .pfm, .tif, .npy";

inline constexpr unsigned kPhotographs = kUsedBySolve | kUsedByTextures;
inline constexpr unsigned kUnknownLight = kUsedByJoint | kUsedByIllumination;
inline constexpr unsigned kSolveOrRender = kUsedBySolve | kUsedByRender;

// Puts a key together. Type first, then what else there is to say.
class Row {
 public:
  Row(const std::string& path, const std::string& meaning);
  operator ProblemKey() const { return key_; }  // NOLINT

  // The type of the value (ValueType), with what that type needs.
  Row& Number(const Range& range, const std::string& default_value);
  Row& AutoOrNumber(const Range& range);
  Row& Integer(int64_t least, int64_t most, const std::string& default_value);
  Row& Triple(const Range& range, const std::string& default_value);
  Row& OneOrTriple(const Range& range, const std::string& default_value);
  Row& AutoOrTriple(const Range& range,
                    const std::string& default_value = "auto");
  Row& NumberList(const Range& range);
  Row& PathList(const std::string& files);
  Row& Choice(const std::string& default_value, Words words);
  Row& ChoiceOrMap(const std::string& default_value, Words words);
  Row& Pair(const Range& range);
  Row& NumberOrPath(const Range& range, const std::string& default_value);
  Row& TripleOrPath(const Range& range, const std::string& default_value);
  Row& OneOrPair(const Range& range);
  Row& Matrix();
  Row& WordOrList(const std::string& default_value, Words words, Words listed);
  Row& Path(const std::string& files, const std::string& default_value = "",
            Words words = {});
  Row& Text();
  Row& PathOrMap(const std::string& files);
  Row& OptionalMap();
  Row& ListOrMap();

  Row& Unit(const std::string& unit);
  Row& Without(const std::string& text);
  Row& UsedBy(unsigned uses);
  Row& Needs(const std::string& what);
  Row& Formerly(const std::string& name);
  Row& Notes(std::vector<std::string> notes);
  Row& Example(const std::string& value);

 private:
  Row& Type(ValueType type, const std::string& default_value);

  ProblemKey key_;
};

// The keys of all parts, in their order.
Keys Join(const std::vector<Keys>& parts);

}  // namespace problem_keys
}  // namespace ibrdf
