#include "ibrdf/solvers/bench/sweep_inputs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "ibrdf/brdf/sample_merl.h"
#include "ibrdf/io/image_file.h"
#include "ibrdf/io/png.h"
#include "ibrdf/solvers/forward/render_scene.h"
#include "tests/bench/sweep_testing.h"

namespace ibrdf {
namespace {

class SweepInputsTest : public testing::SweepTest {
 protected:
  SweepInputsTest() {
    Apply(&options_);
    CHECK(WriteMerl(SampleMerl(testing::Glossy(0.02, 0.8, 3.0)),
                    dir_.File("data/metal.binary"))
              .ok());
    CHECK(WriteExr(testing::RandomMap(16, 32, 5), dir_.File("maps/wide.exr"))
              .ok());
  }
  std::string File(const std::string& name, const std::string& file) const {
    return options_.out + "/cases/" + name + "/" + file;
  }
  size_t Present() const {
    const std::vector<SweepCase> cases = ListSweepCases(options_).value();
    size_t count = 0;
    for (const SweepCase& c : cases) {
      count += HasInput(options_, c);
    }
    return count;
  }

  SweepOptions options_;
};

TEST_F(SweepInputsTest, AreTheSingleRenderersImagesWithItsNoise) {
  // Two materials, maps of two sizes, in batches of one and of all.
  options_.seed = 7;
  for (const int batch : {1, 16}) {
    options_.batch = batch;
    options_.out = dir_.File("out" + std::to_string(batch));
    ASSERT_TRUE(RunRenderInputs(options_).ok());
    const std::vector<SweepCase> cases = ListSweepCases(options_).value();
    for (const SweepCase& c : cases) {
      RenderSceneOptions render;
      render.seed = options_.seed;
      const RenderedScene scene =
          RenderScene(RenderProblem(options_, c), render).value();
      const Image image = ReadImage(File(c.name, "input.exr")).value();
      ASSERT_EQ(scene.image.rgb.size(), image.rgb.size());
      for (size_t i = 0; i < image.rgb.size(); ++i) {
        // The same rule in another order; noise of 2 % would show.
        ASSERT_NEAR(scene.image.rgb[i], image.rgb[i],
                    1e-4 * scene.image.rgb[i]);
      }
      const Mask mask = ReadMask(File(c.name, "mask.png")).value();
      for (size_t i = 0; i < mask.inside.size(); ++i) {
        ASSERT_EQ(scene.mask.inside[i] != 0, mask.inside[i] != 0);
      }
    }
  }
}

TEST_F(SweepInputsTest, GoOnWhereTheyWereCutOff) {
  ASSERT_TRUE(RunRenderInputs(options_).ok());
  EXPECT_EQ(8u, Present());
  const auto age = [&](const std::string& name) {
    return std::filesystem::last_write_time(File(name, "input.exr"));
  };
  const auto kept = age("paint_a");
  const std::string whole = ReadBytes(File("paint_b", "input.exr"));
  // A kill before input.json, one within it, and a lost image.
  std::filesystem::remove(File("paint_b", "input.json"));
  WriteBytes(File("paint_b", "input.exr"), "half");
  WriteBytes(File("paint_c", "input.json"), "{");
  std::filesystem::remove(File("metal_a", "input.exr"));
  EXPECT_EQ(5u, Present());
  ASSERT_TRUE(RunRenderInputs(options_).ok());
  EXPECT_EQ(8u, Present());
  EXPECT_EQ(kept, age("paint_a"));
  EXPECT_EQ(whole, ReadBytes(File("paint_b", "input.exr")));
  // Other settings are another image.
  options_.noise = 0.0;
  EXPECT_EQ(0u, Present());
  options_.materials = {"metal"};
  options_.only_index = 2;
  options_.only_count = 4;
  ASSERT_TRUE(RunRenderInputs(options_).ok());
  EXPECT_EQ(1u, Present());
}

TEST_F(SweepInputsTest, StopBetweenSteps) {
  std::atomic<bool> stop{true};
  options_.stop = &stop;
  EXPECT_EQ(StatusCode::kInterrupted, RunRenderInputs(options_).code());
  EXPECT_EQ(0u, Present());
}

TEST_F(SweepInputsTest, BadFilesAreNamed) {
  options_.materials = {"metal"};
  Image map = testing::SmoothMap(8, 16);
  map.rgb[5] = -100.0f;
  ASSERT_TRUE(WriteExr(map, dir_.File("maps/b.exr")).ok());
  EXPECT_NE(std::string::npos,
            RunRenderInputs(options_).message().find("b.exr"));
  EXPECT_EQ(0u, Present());
  options_.geometry = dir_.File("nowhere.obj");
  EXPECT_NE(std::string::npos,
            RunRenderInputs(options_).message().find("nowhere.obj"));
}

}  // namespace
}  // namespace ibrdf
