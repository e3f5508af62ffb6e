// The files that a hard case needs, made from the recipes of its `inputs`.
#pragma once
#include <yaml-cpp/yaml.h>

#include <string>

#include "ibrdf/base/status.h"

namespace ibrdf {

// Makes the file `name` in `folder`. Recipes, by their first key:
//
//   text: |                      the bytes themselves
//   hex: 00 ff                   the same, by hexadecimal digits
//   scene: {...}                 .exr: what ibrdf_render makes of these keys,
//                                at preview quality
//   constant: [r, g, b]          .exr of size: [w, h]
//   light: {kind: sun, ...}      .exr map of size: [w, h]; see MakeLight
//   normals: sphere              .exr normal map of size: [w, h]; or facing,
//                                zero, away, long, grazing, perspective
//   depth: sphere                .exr depth in pixels of size: [w, h]; or flat
//   mask: disc                   .png of size: [w, h]; or all, none, pixel,
//                                corner; centre: and radii: [x, y] in pixels
//                                of the disc, else it touches all sides
//   brdf: {specular: s, ...}     .binary; see MakeBrdf
//   model: 2                     .ibrdf of so many random materials;
//                                curvature: of its splines; code_norm: of its
//                                codes; log_colour: of all, or [r, g, b]
//   sphere_mesh: 12              .obj, .ply, .stl or .glb of so many rings; see
//                                MakeSphereMesh
//
// An image with `codes: {...}` becomes a photograph (case_photographs.h), a
// .png, .jpg or .tif; one with `exr: {...}` another kind of OpenEXR
// (case_exr.h). Of any file `bytes` changes what was written: {cut: n} keeps so
// many, {before: hex} and {after: hex} add some, {at: n, put: hex} replaces
// some.
//
// Images and maps take `edit`, a list of changes in order:
//   {set: v}                     v: a number, nan, inf, -inf or denormal
//   {scale: v}  {add: v}  {clip: v}   clip: at this radiance
// each with `pixel: [x, y]`, or `every: n` (each n-th pixel), or `rows: [a,
// b)`, else all; and `channel: c`, else all three.
//
// A recipe that is not understood is an error: a case must test what it says.
Status MakeInput(const YAML::Node& recipe, const std::string& folder,
                 const std::string& name);

}  // namespace ibrdf
