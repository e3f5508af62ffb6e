// Cases that the sweeps over images share: a material, a map and a shape.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/io/problem.h"

namespace ibrdf {

struct SweepOptions {
  std::string data;  // folder of MERL .binary tables
  std::string maps;  // folder of .hdr or .exr maps
  std::string out;
  std::vector<std::string> materials;  // empty: all of `data`, sorted
  std::vector<std::string> map_names;  // empty: all of `maps`, sorted
  std::string geometry = "sphere";     // or a mesh file
  int size = 128;                      // of the cases' images
  double noise = 0.02;                 // log-normal, of the images
  int batch = 32;      // materials whose images are rendered together
  int only_index = 1;  // of only_count, from 1: every n-th case
  int only_count = 1;
  std::string command;  // as typed, for results.md
  uint64_t seed = 1;    // of the noise and of the solver
  int num_threads = 0;
  const std::atomic<bool>* stop = nullptr;
  // A line per event; may be empty.
  std::function<void(const std::string&)> report;

  bool stopped() const { return stop != nullptr && *stop; }
};

struct SweepCase {
  std::string name;  // MATERIAL_MAP, for a mesh MATERIAL_MAP_MESH
  std::string material, map;
  std::string brdf_path, map_path;  // absolute
  int size = 0;                     // of the square image, pixels
};

// The cases that options select, by material, then map. Fails on a material or
// map that is not there.
StatusOr<std::vector<SweepCase>> ListSweepCases(const SweepOptions& options);

// The case with an image of another size, in a folder of its own: NAME_SIZEpx.
SweepCase CaseOfSize(SweepCase c, int size);

// "sphere" or the mesh's name.
std::string GeometryName(const SweepOptions& options);

// The case's folder, absolute: OUT/cases/NAME.
std::string CaseFolder(const SweepOptions& options, const SweepCase& c);

// The forward problem of a case, at reference quality.
Problem RenderProblem(const SweepOptions& options, const SweepCase& c);

// "image: {...}" and "geometry: ..." of a problem file in the case's folder;
// `image`: what is in the braces.
std::string ImageYaml(
    const SweepOptions& options,
    const std::string& image = "file: input.exr, mask: mask.png");

// A string as JSON and YAML have it.
std::string Quoted(const std::string& text);

// The frame that all maps of sweeps are read in, whatever their files say, so
// that results of all versions can be compared.
inline constexpr MapFrame kSweepMapFrame = MapFrame::kIbrdf01;

// The case's map as the value of `known` or `illumination` in a problem file,
// and the key `frame` beside it.
std::string MapAndFrame(const SweepCase& c);

}  // namespace ibrdf
