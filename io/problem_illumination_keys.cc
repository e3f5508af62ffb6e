// The keys of the section `illumination`.
#include <string>

#include "ibrdf/io/problem.h"
#include "ibrdf/io/problem_schema_rows.h"
#include "ibrdf/io/problem_section_keys.h"

namespace ibrdf {
namespace problem_keys {
namespace {

// The far light and the unknowns of a solve grow with these.
constexpr int kMaxMapSide = 8192;
constexpr int kMaxUnetChannels = 128;

constexpr unsigned kKnownLight =
    kUsedByReflectance | kUsedByRender | kUsedByTextures;

// The words of MapFrame, in its order.
Words MapFrames() {
  return {
      {"camera",
       "The middle is what the camera looks at (-z), and right in the map is "
       "right in the picture."},
      {"openexr",
       "OpenEXR's `envmap`: the middle is +z, and the outer texels' centres "
       "are the borders; or a cube as a column."},
      {"mitsuba", "Mitsuba 3, and USD's dome light: the middle is +z."},
      {"blender", "Blender's Environment Texture: the left quarter is -z."},
      {"polyhaven_y_up",
       "Maps of Poly Haven in three.js; the same as `blender`."},
      {"debevec_probe", "The angular map of Debevec's probes, square."},
      {"cube_cross", "A cube: a cross (3:4 or 4:3) or OpenEXR's column (1:6)."},
      {"ibrdf_0_1",
       "This project's until version 0.1: `camera` mirrored left to right."}};
}

Keys MapSizeKeys() {
  return {
      Row("illumination",
          "The environment map: its size and prior where it is unknown, else "
          "`known`.")
          .Notes(
              {"One side alone sets the other: the map is twice as wide as "
               "high.",
               "Without a size, a solve resamples a known map to 128x64, or to "
               "256x128 if it has as many texels and no shadows are simulated.",
               "A render takes the map of a file as it is.",
               "`prior: process` takes at most " +
                   std::to_string(kMaxProcessSide) + " texels a side.",
               "A solve needs sides that can be halved often. Powers of two "
               "always can."}),
      Row("illumination.width", "Width of the map, an even number.")
          .Integer(8, kMaxMapSide, "128")
          .Unit("texels"),
      Row("illumination.height", "Height of the map.")
          .Integer(4, kMaxMapSide, "64")
          .Unit("texels")};
}

Keys LightPriorKeys() {
  return {
      Row("illumination.prior", "What is taken as natural light.")
          .Choice("auto",
                  {{"auto",
                    "`process`. It is `unet` where "
                    "`illumination.unet_channels` is set, with "
                    "`solver.estimator: maximum`, and for maps of more than " +
                        std::to_string(kMaxProcessSide) + " texels a side."},
                   {"process",
                    "The map is the MAP estimate of a Gaussian process."},
                   {"unet",
                    "The map is a network's output, begun at that MAP "
                    "estimate, which stays where the network fits less well."},
                   {"none",
                    "Texels are independent of each other. It is there for "
                    "comparison."}})
          .UsedBy(kUnknownLight),
      Row("illumination.unet_channels",
          "Feature maps of every layer of the network but its skip branches. "
          "Its weights grow with their square, as does most of its time.")
          .Integer(1, kMaxUnetChannels, "32")
          .Needs("illumination.prior: unet")
          .UsedBy(kUnknownLight)};
}

Keys KnownLightKeys() {
  return {Row("illumination.known",
              "The known illumination: an environment map, or `sky`.")
              .PathOrMap(kMapFiles)
              .Without("needed")
              .UsedBy(kKnownLight),
          Row("illumination.frame",
              "Which direction a texel of the known map stands for "
              "([frames](frames.md)).")
              .Choice("auto", AutoOrMapFrames())
              .Needs("illumination.known")
              .UsedBy(kKnownLight),
          Row("illumination.output_frame",
              "The frame of the maps that are written.")
              .Choice("camera", MapFrames()),
          Row("illumination.ambient",
              "Stray light beside the known map's. `auto`: found with the "
              "reflectance where pixels without light are not black. 0: none.")
              .AutoOrTriple(kNotNegative)
              .Unit("that of the image")
              .Needs("illumination.known")
              .UsedBy(kUsedByReflectance)};
}

}  // namespace

Words AutoOrMapFrames() {
  Words words = MapFrames();
  words.insert(words.begin(),
               {"auto",
                "What an OpenEXR file says (`ibrdf:frame`, which results "
                "carry, else `envmap`). Else `camera`."});
  return words;
}

Keys IlluminationKeys() {
  return Join({MapSizeKeys(), LightPriorKeys(), KnownLightKeys()});
}

Keys SkyKeys() {
  const std::string sky = "illumination.known.sky";
  Keys keys = {
      Row(sky,
          "An artificial map of sun, sky, clouds, buildings and ground. `{sky: "
          "{}}` takes all its defaults."),
      Row(sky + ".sun_theta_degrees",
          "Angle between the sun and the zenith (+y).")
          .Number({0.0, 90.0, true, true}, "40")
          .Unit("degrees"),
      Row(sky + ".sun_phi_degrees",
          "Azimuth of the sun, from behind the camera (+z) towards the right "
          "(+x).")
          .Number({-360.0, 360.0, true, true}, "60")
          .Unit("degrees"),
      Row(sky + ".sun_radius_degrees",
          "Where the sun's radiance has fallen to 1/e of its peak.")
          .Number({0.1, 30.0, true, true}, "1.5")
          .Unit("degrees"),
      Row(sky + ".sun_irradiance",
          "Irradiance by the sun on a surface that faces it.")
          .Number(kNotNegative, "3")
          .Unit("W/m²"),
      Row(sky + ".zenith_radiance", "Radiance of the clear sky overhead.")
          .Number(kPositive, "0.35")
          .Unit("W/(m² sr)"),
      Row(sky + ".haze", "A whiter horizon, and a wider glow around the sun.")
          .Number(kUnitInterval, "0.4"),
      Row(sky + ".clouds", "Strength of the clouds.")
          .Number(kUnitInterval, "0.6"),
      Row(sky + ".skyline", "Height of the buildings and of their windows.")
          .Number(kUnitInterval, "0.7"),
      Row(sky + ".ground_albedo", "Albedo of the ground.")
          .Number(kUnitInterval, "0.2")};
  for (ProblemKey& key : keys) key.used_by = kKnownLight;
  return keys;
}

}  // namespace problem_keys
}  // namespace ibrdf
