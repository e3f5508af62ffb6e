// The keys of each section of a problem file, in the order of the reference.
// problem_schema.cc joins them.
#pragma once
#include "ibrdf/io/problem_schema_rows.h"

namespace ibrdf {
namespace problem_keys {

Keys ImageKeys();
Keys CameraKeys();
Keys ViewKeys();
Keys GeometryKeys();
Keys ReflectanceKeys();
Keys IlluminationKeys();
Keys SkyKeys();  // illumination.known.sky
Keys LikelihoodKeys();
Keys EffectsKeys();
Keys SolverKeys();
Keys TruthKeys();
Keys TextureKeys();  // texture and uncertainty
Keys RenderKeys();   // noise and quality

// The words of a key that names the frame of a map's file: auto, then those of
// MapFrame.
Words AutoOrMapFrames();

}  // namespace problem_keys
}  // namespace ibrdf
