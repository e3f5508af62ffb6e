// Scenes of the studies: which shape stands under which map.
#pragma once
#include <atomic>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/image/image.h"
#include "ibrdf/solvers/bench/results_table.h"
#include "ibrdf/solvers/entropy_study/study_scene.h"

namespace ibrdf {

struct StudyOptions {
  std::string data;  // folder of the meshes
  std::string maps;  // folder of .hdr or .exr maps
  std::string out;   // folder of results
  std::vector<std::string> shapes = {"sphere", "torus", "spot_low_resolution",
                                     "bunny"};
  std::vector<std::string> map_names;  // empty: all of `maps`
  int rounds = 1;  // how often each map is taken, with the next shape
  int num_texels = 200;
  bool one_material = false;  // SceneOptions; `entropy` alone
  bool oracle = false;        // of `best-view`: with a row of OracleViews
  int only_index = 1;         // of only_count, from 1: every n-th scene
  int only_count = 1;
  unsigned seed = 1;  // of the first scene; each has its own
  int num_threads = 0;
  const std::atomic<bool>* stop = nullptr;
  // A line per event; may be empty.
  std::function<void(const std::string&)> report;

  bool stopped() const { return stop != nullptr && *stop; }
};

// Maps by the share of radiance that their brightest hundredth of the sphere
// has: a third of them each.
enum class MapKind { kSoft, kMedium, kHard };
const char* MapKindName(MapKind kind);

// The share of the mean radiance, over directions and channels, that comes from
// the brightest hundredth of the sphere. [0.01, 1]. The map is not black.
double BrightestShare(const Image& map);

struct StudyCase {
  std::string name;  // SHAPE_MAP
  std::string shape, map;
  MapKind kind = MapKind::kSoft;
  std::string map_path;  // absolute
  unsigned seed = 0;
};

// The scenes that options select. Maps are sorted by BrightestShare and take
// the shapes in turn, so that each shape has maps of each kind. Fails on a map
// that is not there, is black or cannot be read.
StatusOr<std::vector<StudyCase>> ListStudyCases(const StudyOptions& options);

// Reads the mesh and the map, and makes the scene.
StatusOr<StudyScene> MakeStudyScene(const StudyOptions& options,
                                    const StudyCase& c);

// Appends a row, unless results.csv holds it: its first three columns name it.
using AppendStudyRow = std::function<Status(const ResultsRow&)>;

// Calls `run` for every scene that options select, but for those whose last row
// out/results.csv holds: rows begin with scene, seed and a name, of which
// `last` is the last. kInterrupted once stopped.
Status RunStudy(const StudyOptions& options,
                const std::vector<std::string>& columns,
                const std::string& last,
                const std::function<Status(const StudyCase&, const StudyScene&,
                                           const AppendStudyRow&)>& run);

// The row's columns that tell of the scene: scene, seed, shape, map, light.
void SetStudyCase(const StudyCase& c, NamedRow* row);

// The values of a column by name, the third column, in the order of rows.
using ColumnByName = std::vector<std::pair<std::string, std::vector<double>>>;
ColumnByName ValuesByName(const std::vector<std::string>& columns,
                          const std::vector<ResultsRow>& rows,
                          const std::string& column);

}  // namespace ibrdf
