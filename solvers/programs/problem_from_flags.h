// A problem file made from the command line.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/io/problem.h"

namespace ibrdf {

// What stands on the command line in place of a problem file. Paths are
// relative to the current folder; empty: not given.
struct ProblemFlags {
  std::vector<std::string> photos;  // image.file; several: images
  std::string mask;         // image.mask
  std::string response;     // image.response
  std::string normals;      // geometry.normals
  std::string mesh;         // geometry.mesh
  std::string known_light;  // illumination.known, and problem: reflectance
  std::vector<std::string> overrides;  // --set; their paths as those above
  std::string out = "out";             // the folder that the file is for
  std::string command;                 // the command line, for a comment

  // Whether a flag besides --set and --out is given.
  bool Any() const;
};

struct FlagProblem {
  Problem problem;
  std::string text;  // of <out>/problem.yaml, which gives the same problem
  // What the flags left open and was taken for granted: sentences.
  std::vector<std::string> notes;
};

// Makes the text of a problem file, checks it as ReadProblem does, and moves
// its paths to where the file will be: a relative path stays relative where the
// folder is given so too. Errors name the command line and the key.
StatusOr<FlagProblem> ProblemFromFlags(const ProblemFlags& flags);

// Writes <out>/problem.yaml. Refuses to replace one that no flags made.
Status WriteFlagProblem(const FlagProblem& made, const std::string& out);

// Arguments as a shell takes them, on one line.
std::string ShellCommand(const std::vector<std::string>& arguments);

}  // namespace ibrdf
