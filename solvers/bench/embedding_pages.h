// Pages that show an embedding as spheres.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/image/image.h"
#include "ibrdf/image/rgb8_image.h"
#include "ibrdf/solvers/bench/embedding_map.h"

namespace ibrdf {

struct NamedSphere {
  std::string name;  // printable ASCII
  Image image;       // square, the sphere from edge to edge
};

// Spheres at their places along the first two axes, moved apart where they
// would overlap, with a line back to their place; names where there is room.
Rgb8Image MapPage(const EmbeddingMap& map,
                  const std::vector<NamedSphere>& spheres, double exposure);

// One row; distance: of the two ends in code space.
Rgb8Image WalkPage(const std::vector<NamedSphere>& steps,
                   const std::string& from, const std::string& to,
                   double distance, double exposure);

struct NeighbourRow {
  NamedSphere material;
  Image measured;  // the same from its table; empty: none
  std::vector<NamedSphere> neighbours;
  std::vector<double> distances;
};
Rgb8Image NeighbourPage(const std::vector<NeighbourRow>& rows, double exposure);

}  // namespace ibrdf
