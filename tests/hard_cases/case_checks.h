// What must hold of every run, and what one case asks for besides.
#pragma once
#include <yaml-cpp/yaml.h>

#include <set>
#include <string>

namespace ibrdf {

struct CaseRun {
  int exit_status = 0;   // 128 + signal where a signal ended it
  std::string terminal;  // standard output and error
  std::string folder;    // of the results
};

// Every run: ends by itself, with no sanitizer's report. With 0 or 3, all
// files are whole, every number in them is finite (none that is missing for
// not being so, but where nothing can be said), and the cost at the end is
// not above that at the start. With 2, one line that starts with "error:", and
// no file at all.
//
// `holds` of the case:
//   exit: 2 or [0, 3]            required
//   says: [words]                on the terminal
//   values: {pointer: [a, b]}    numbers of result.json, by JSON pointer
//   equals: {pointer: text}
//   map: [a, b]                  range of illumination.exr
//   image: [a, b]                range of render.exr on the object
//   albedo: [a, b]               range of albedo.exr on the object; or none:
//                                there is no such file
//   renders: error               ibrdf_render's of the files of a painted
//                                result against its render.exr: the mean
//                                magnitude of log differences on the object;
//                                pixels of 10x10 are more than their centres,
//                                by 0.02
//   files: [names, sorted]       all that there is, and nothing else is checked
// `problem`: of the case, for `renders`. Reports by googletest.
void CheckRun(const YAML::Node& holds, const YAML::Node& problem,
              const CaseRun& run);

// That two runs ended alike, with the same bits in what they estimated.
// Fails on a key that is not known: a misspelt one would leave something
// untested.
void ExpectKnownKeys(const YAML::Node& map, const std::set<std::string>& known);

void CheckSameBits(const CaseRun& a, const CaseRun& b);

}  // namespace ibrdf
