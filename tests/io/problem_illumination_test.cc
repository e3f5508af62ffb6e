// Illumination in problem files.
#include <gtest/gtest.h>

#include <string>

#include "tests/io/problem_file_fixture.h"

namespace ibrdf {
namespace {

TEST_F(ProblemFile, AmbientTermIsAutoOneNumberOrThree) {
  const auto ambient = [&](const std::string& value) {
    const StatusOr<Problem> read =
        Read(kLeast + std::string("illumination: {known: a.exr, ambient: ") +
             value + "}");
    EXPECT_TRUE(read.ok()) << read.status().message();
    return read->illumination.ambient;
  };
  EXPECT_FALSE(ambient("auto").has_value());
  EXPECT_TRUE((*ambient("0") == 0.0).all());
  EXPECT_TRUE((*ambient("[0.5, 0, 2]") == Eigen::Array3d(0.5, 0, 2)).all());
  for (const std::string bad :
       {"-1", "none", "[1, 2]", "[1, 2, -3]", "[1, 2, nan]", "inf", "{}", "[]",
        "[auto, 1, 1]"}) {
    const std::string error =
        ErrorOf(kLeast + std::string("illumination: {known: a.exr, ambient: ") +
                bad + "}");
    EXPECT_NE(std::string::npos, error.find("illumination.ambient")) << error;
  }
  // No light is known that it could be beside.
  EXPECT_NE(std::string::npos,
            ErrorOf(kLeast + std::string("illumination: {ambient: 0.1}"))
                .find("illumination.known"));
}

TEST_F(ProblemFile, FramesOfMapsHaveTheLibrarysWords) {
  const std::string least = kLeast;
  const Problem none = *Read(least);
  EXPECT_FALSE(none.illumination.frame.has_value());
  EXPECT_FALSE(none.truth.frame.has_value());
  EXPECT_EQ(MapFrame::kCamera, none.illumination.output_frame);
  for (const MapFrame frame : kMapFrames) {
    const std::string word = MapFrameName(frame);
    const StatusOr<Problem> read =
        Read(least + "illumination: {known: a.exr, frame: " + word +
             ", output_frame: " + word + "}\ntruth: {illumination: b.exr, " +
             "frame: " + word + "}");
    ASSERT_TRUE(read.ok()) << read.status().message();
    EXPECT_EQ(frame, read->illumination.frame);
    EXPECT_EQ(frame, read->illumination.output_frame);
    EXPECT_EQ(frame, read->truth.frame);
  }
  EXPECT_FALSE(Read(least + "illumination: {known: a.exr, frame: auto}")
                   ->illumination.frame.has_value());
}

TEST_F(ProblemFile, ThePriorOfTheLightIsChosen) {
  const auto prior = [&](const std::string& rest) {
    return Read(std::string(kLeast) + rest).value().illumination.prior;
  };
  EXPECT_EQ(IlluminationPrior::kProcess, prior(""));
  EXPECT_EQ(IlluminationPrior::kProcess, prior("illumination: {width: 256}"));
  EXPECT_EQ(IlluminationPrior::kProcess,
            prior("illumination: {prior: process}\n"
                  "solver: {estimator: maximum}"));
  EXPECT_EQ(IlluminationPrior::kUNet, prior("illumination: {width: 258}"));
  EXPECT_EQ(IlluminationPrior::kUNet,
            prior("illumination: {prior: auto, unet_channels: 8}"));
  EXPECT_EQ(IlluminationPrior::kUNet, prior("solver: {estimator: maximum}"));
  EXPECT_EQ(IlluminationPrior::kNone,
            prior("illumination: {prior: none}\nsolver: {estimator: maximum}"));
}

TEST_F(ProblemFile, MapsOfTheProcessAreSmall) {
  const auto check = [&](const std::string& illumination) {
    return CheckSolvable(*Read(kLeast, {"illumination=" + illumination}));
  };
  EXPECT_TRUE(check("{width: 256, prior: process}").ok());
  EXPECT_TRUE(check("{width: 512}").ok());
  const Status s = check("{width: 512, prior: process}");
  EXPECT_EQ(StatusCode::kInvalidInput, s.code());
  EXPECT_NE(std::string::npos, s.message().find("illumination.width"));
  EXPECT_NE(std::string::npos, check("{width: 64, height: 512, prior: process}")
                                   .message()
                                   .find("illumination.height"));
}

}  // namespace
}  // namespace ibrdf
