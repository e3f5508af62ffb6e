#include "ibrdf/io/model_file.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "ibrdf/flow/brdf_flow.h"
#include "tests/support/corruption.h"
#include "tests/support/temp_dir.h"
#include "tests/support/tiny_model.h"

namespace ibrdf {
namespace {

// Length of the header's JSON, and where its text begins.
void FindHeader(const std::string& bytes, size_t* begin, size_t* length) {
  const size_t first = bytes.find('\n') + 1;
  *begin = bytes.find('\n', first) + 1;
  *length = std::stoul(bytes.substr(first));
}

// The checksum that the format asks for, FNV-1a of 64 bits.
void Seal(std::string* bytes) {
  uint64_t hash = 0xcbf29ce484222325ULL;
  for (size_t i = 0; i + 8 < bytes->size(); ++i) {
    hash ^= static_cast<unsigned char>((*bytes)[i]);
    hash *= 0x100000001b3ULL;
  }
  std::memcpy(&(*bytes)[bytes->size() - 8], &hash, 8);
}

class ModelFile : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(WriteModel(model_, path_).ok()); }

  // The file with its header's text changed and everything else made to fit.
  void Rewrite(const std::string& from, const std::string& to) {
    const std::string bytes = ReadBytes(path_);
    size_t begin = 0, length = 0;
    FindHeader(bytes, &begin, &length);
    std::string header = bytes.substr(begin, length);
    const size_t at = header.find(from);
    ASSERT_NE(std::string::npos, at) << header;
    header.replace(at, from.size(), to);
    std::string changed = bytes.substr(0, bytes.find('\n') + 1) +
                          std::to_string(header.size()) + "\n" + header +
                          bytes.substr(begin + length);
    Seal(&changed);
    WriteBytes(path_, changed);
  }
  void SetVersion(char version) {
    std::string bytes = ReadBytes(path_);
    bytes[12] = version;
    Seal(&bytes);
    WriteBytes(path_, bytes);
  }
  void ExpectRefused(const std::string& field) const {
    const Status status = ReadModel(path_).status();
    EXPECT_EQ(StatusCode::kInvalidInput, status.code());
    EXPECT_EQ(0u, status.message().find(path_)) << status.message();
    EXPECT_NE(std::string::npos, status.message().find(field))
        << status.message();
  }

  // The same codes with a small coupling stack.
  NeuralBrdfModel CouplingModel() const {
    NeuralBrdfModel model = model_;
    model.exponent = 3.0;
    model.shape = FlowShape();
    model.shape.architecture = FlowArchitecture::kCoupling;
    model.shape.coupling.layers = 3;
    model.shape.coupling.bins = 5;
    model.shape.coupling.code_size = 4;
    model.shape.coupling.widths = {9, 7};
    model.weights = InitialFlowWeights(model.shape, 11);
    return model;
  }

  const TempDir dir_;
  const std::string path_ = dir_.File("a.ibrdf");
  const NeuralBrdfModel model_ = TinyModel(2);
};

TEST_F(ModelFile, RoundTripKeepsEveryBit) {
  const StatusOr<NeuralBrdfModel> read = ReadModel(path_);
  ASSERT_TRUE(read.ok()) << read.status().message();
  EXPECT_EQ(model_.weights, read->weights);
  EXPECT_EQ(model_.codes, read->codes);
  EXPECT_EQ(model_.log_colours, read->log_colours);
  EXPECT_EQ(model_.names, read->names);
  EXPECT_EQ(model_.note, read->note);
  EXPECT_EQ(model_.exponent, read->exponent);
  EXPECT_EQ(FlowArchitecture::kTriangular, read->shape.architecture);
  const TriangularShape& written = model_.shape.triangular;
  const TriangularShape& shape = read->shape.triangular;
  EXPECT_EQ(written.bins, shape.bins);
  EXPECT_EQ(written.code_size, shape.code_size);
  EXPECT_EQ(written.widths, shape.widths);
  EXPECT_EQ(written.marginal_widths, shape.marginal_widths);
  EXPECT_EQ(1, dir_.CountFiles());
}

TEST_F(ModelFile, LobeFitsRoundTrip) {
  NeuralBrdfModel model = model_;
  model.fit_lobes = 2;
  const int lobe_size = model.shape.code_size() + 3;
  for (int i = 0; i < model.num_materials() * 2 * lobe_size; ++i) {
    model.lobe_fits.push_back(0.1f * static_cast<float>(i) - 3.0f);
  }
  ASSERT_TRUE(WriteModel(model, path_).ok());
  const StatusOr<NeuralBrdfModel> read = ReadModel(path_);
  ASSERT_TRUE(read.ok()) << read.status().message();
  EXPECT_EQ(2, read->fit_lobes);
  EXPECT_EQ(model.lobe_fits, read->lobe_fits);
  Rewrite("\"fit_lobes\":2", "\"fit_lobes\":1");
  ExpectRefused("expected");
  ASSERT_TRUE(WriteModel(model, path_).ok());
  Rewrite("\"fit_lobes\":2", "\"fit_lobes\":9");
  ExpectRefused("fit_lobes");
}

TEST_F(ModelFile, FitsWithALambertianLobeAreOfVersionFour) {
  NeuralBrdfModel model = model_;
  model.fit_lobes = 2;
  model.fit_lambertian = true;
  for (int i = 0; i < model.num_materials() * model.fit_size(); ++i) {
    model.lobe_fits.push_back(0.1f * static_cast<float>(i) - 3.0f);
  }
  ASSERT_TRUE(WriteModel(model, path_).ok());
  const StatusOr<NeuralBrdfModel> read = ReadModel(path_);
  ASSERT_TRUE(read.ok()) << read.status().message();
  EXPECT_TRUE(read->fit_lambertian);
  EXPECT_EQ(model.lobe_fits, read->lobe_fits);
  // A lobe beside none is refused, and so are its numbers under version 3.
  Rewrite("\"fit_lobes\":2", "\"fit_lobes\":0");
  ExpectRefused("fit_lobes");
  ASSERT_TRUE(WriteModel(model, path_).ok());
  SetVersion('3');
  ExpectRefused("expected");
  // A model without the lobe is of version 3, as before.
  ASSERT_TRUE(WriteModel(model_, path_).ok());
  EXPECT_FALSE(ReadModel(path_)->fit_lambertian);
  SetVersion('4');
  ExpectRefused("fit_lobes");
}

TEST_F(ModelFile, CouplingStackRoundTrips) {
  const NeuralBrdfModel model = CouplingModel();
  ASSERT_TRUE(WriteModel(model, path_).ok());
  const StatusOr<NeuralBrdfModel> read = ReadModel(path_);
  ASSERT_TRUE(read.ok()) << read.status().message();
  EXPECT_EQ(FlowArchitecture::kCoupling, read->shape.architecture);
  EXPECT_EQ(model.shape.coupling.layers, read->shape.coupling.layers);
  EXPECT_EQ(model.shape.coupling.bins, read->shape.coupling.bins);
  EXPECT_EQ(model.shape.coupling.code_size, read->shape.coupling.code_size);
  EXPECT_EQ(model.shape.coupling.widths, read->shape.coupling.widths);
  EXPECT_EQ(model.weights, read->weights);
  EXPECT_EQ(model.codes, read->codes);
  EXPECT_EQ(model.exponent, read->exponent);
}

TEST_F(ModelFile, ModelWithoutCodesRoundTrips) {
  NeuralBrdfModel bare = model_;
  bare.names.clear();
  bare.codes.clear();
  bare.log_colours.clear();
  ASSERT_TRUE(WriteModel(bare, path_).ok());
  const StatusOr<NeuralBrdfModel> read = ReadModel(path_);
  ASSERT_TRUE(read.ok()) << read.status().message();
  EXPECT_EQ(0, read->num_codes());
}

TEST_F(ModelFile, EveryTruncationIsRefused) {
  ForEachTruncation(ReadBytes(path_), 200, [&](const std::string& cut) {
    EXPECT_EQ(StatusCode::kInvalidInput,
              DecodeModel(path_, cut).status().code());
  });
}

TEST_F(ModelFile, BytesAfterTheEndAreRefused) {
  WriteBytes(path_, ReadBytes(path_) + "x");
  ExpectRefused("checksum");
}

TEST_F(ModelFile, AnyChangedByteIsRefused) {
  const std::string bytes = ReadBytes(path_);
  for (size_t at = 0; at < bytes.size(); at += at < 200 ? 1 : 37) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    WriteBytes(path_, damaged);
    ExpectRefused("");
  }
}

TEST_F(ModelFile, DamageUnderAValidChecksumNeverCrashes) {
  const std::string bytes = ReadBytes(path_);
  ForEachCorruption(bytes, 400, 600, 5, [&](const std::string& damaged) {
    std::string sealed = damaged;
    Seal(&sealed);
    const StatusOr<NeuralBrdfModel> read = DecodeModel(path_, sealed);
    if (!read.ok()) {
      EXPECT_EQ(StatusCode::kInvalidInput, read.status().code());
    } else {
      EXPECT_EQ(read->shape.NumWeights(), read->weights.size());
    }
  });
}

TEST_F(ModelFile, OtherVersionsAndFilesAreNamed) {
  const std::string bytes = ReadBytes(path_);
  for (const char version : {'1', '5'}) {
    WriteBytes(path_, bytes);
    SetVersion(version);
    ExpectRefused(std::string("version: expected 3 or 4, found ") + version);
  }
  WriteBytes(path_, "PNG or something");
  ExpectRefused("not a model file");
  WriteBytes(path_, "");
  ExpectRefused("");
  WriteBytes(path_, "ibrdf-model 3\n99999999999999999999\n{}12345678");
  ExpectRefused("");
}

TEST_F(ModelFile, UnknownFlowIsNamed) {
  Rewrite("\"triangular\"", "\"spiral\"");
  ExpectRefused("flow: expected triangular or coupling, found spiral");
}
TEST_F(ModelFile, FlowOfAnotherTypeIsRefused) {
  Rewrite("\"triangular\"", "7");
  ExpectRefused("header");
}
TEST_F(ModelFile, MissingFlowIsNamed) {
  Rewrite("\"flow\"", "\"flaw\"");
  ExpectRefused("flow");
}
TEST_F(ModelFile, FieldsOfTheOtherFlowAreRefused) {
  Rewrite("\"triangular\"", "\"coupling\"");
  ExpectRefused("layers");
}
TEST_F(ModelFile, TooFewBinsAreRefused) {
  Rewrite("\"bins\":[6,4,4]", "\"bins\":[6,4]");
  ExpectRefused("bins: expected 3 numbers, found 2");
}
TEST_F(ModelFile, TooManyBinsAreRefused) {
  Rewrite("\"bins\":[6,4,4]", "\"bins\":[6,4,4,4]");
  ExpectRefused("bins: expected 3 numbers, found 4");
}
TEST_F(ModelFile, OneBinIsRefused) {
  Rewrite("\"bins\":[6,4,4]", "\"bins\":[6,1,4]");
  ExpectRefused("bins");
}
TEST_F(ModelFile, SizesThatDoNotFitAreRefused) {
  Rewrite("\"bins\":[6,4,4]", "\"bins\":[6,5,4]");
  ExpectRefused("numbers after the header");
}
TEST_F(ModelFile, SizesOfAStackThatDoNotFitAreRefused) {
  ASSERT_TRUE(WriteModel(CouplingModel(), path_).ok());
  Rewrite("\"layers\":3", "\"layers\":4");
  ExpectRefused("numbers after the header");
}
TEST_F(ModelFile, HugeCountsAreRefusedWithoutBeingAllocated) {
  Rewrite("\"widths\":[8,8]", "\"widths\":[1000000000,8]");
  ExpectRefused("widths");
}
TEST_F(ModelFile, HugeMarginalCountsAreRefusedWithoutBeingAllocated) {
  Rewrite("\"marginal_widths\":[6]", "\"marginal_widths\":[1000000000]");
  ExpectRefused("widths");
}
TEST_F(ModelFile, HugeLayersAreRefused) {
  ASSERT_TRUE(WriteModel(CouplingModel(), path_).ok());
  Rewrite("\"layers\":3", "\"layers\":2000000000");
  ExpectRefused("layers");
}
TEST_F(ModelFile, LargestLegalShapeIsTooLargeForTheFile) {
  Rewrite("\"widths\":[8,8]",
          "\"widths\":[1024,1024,1024,1024,1024,1024,1024,1024]");
  ExpectRefused("numbers after the header");
}
TEST_F(ModelFile, NegativeAndWrongTypesAreRefused) {
  Rewrite("\"code_size\":4", "\"code_size\":-4");
  ExpectRefused("code size");
}
TEST_F(ModelFile, FieldOfAnotherTypeIsRefused) {
  Rewrite("\"bins\":[6,4,4]", "\"bins\":[6,\"4\",4]");
  ExpectRefused("header");
}
TEST_F(ModelFile, MissingFieldIsNamed) {
  Rewrite("\"exponent\"", "\"exponents\"");
  ExpectRefused("exponent");
}

TEST_F(ModelFile, NumbersOutsideTheirRangeAreNamed) {
  const auto expect = [&](const std::string& field,
                          const std::function<void(NeuralBrdfModel*)>& change) {
    NeuralBrdfModel bad = model_;
    change(&bad);
    ASSERT_TRUE(WriteModel(bad, path_).ok());
    ExpectRefused(field);
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  expect("weights", [&](NeuralBrdfModel* m) { m->weights[17] = nan; });
  expect("weights", [&](NeuralBrdfModel* m) { m->weights.back() = INFINITY; });
  expect("codes", [&](NeuralBrdfModel* m) { m->codes[3] = nan; });
  expect("codes: m0.green", [](NeuralBrdfModel* m) { m->codes[5] = 1.01f; });
  expect("log_colours", [&](NeuralBrdfModel* m) { m->log_colours[0] = nan; });
  expect("exponent", [](NeuralBrdfModel* m) { m->exponent = 0.0; });
  expect("lobe_fits", [&](NeuralBrdfModel* m) {
    m->fit_lobes = 1;
    m->lobe_fits.assign(
        static_cast<size_t>(m->num_materials()) * (m->shape.code_size() + 3),
        nan);
  });
}

TEST_F(ModelFile, CodesOnTheUnitSphereAreAccepted) {
  NeuralBrdfModel edge = model_;
  std::fill(edge.codes.begin(), edge.codes.end(), 0.5f);
  ASSERT_TRUE(WriteModel(edge, path_).ok());
  EXPECT_TRUE(ReadModel(path_).ok());
}

TEST_F(ModelFile, NamesOfAnyBytesDoNotThrow) {
  NeuralBrdfModel model = model_;
  model.names[0] = "m\xff\xfe.red";  // not UTF-8, as a file's name may be
  ASSERT_TRUE(WriteModel(model, path_).ok());
  const StatusOr<NeuralBrdfModel> read = ReadModel(path_);
  ASSERT_TRUE(read.ok()) << read.status().message();
  EXPECT_EQ(model.names[1], read->names[1]);
}

TEST_F(ModelFile, MissingFileIsNamed) {
  const Status status = ReadModel(dir_.File("none.ibrdf")).status();
  EXPECT_EQ(StatusCode::kInvalidInput, status.code());
  EXPECT_NE(std::string::npos, status.message().find("none.ibrdf"));
}

TEST(FindModel, OtherNamesArePaths) {
  EXPECT_EQ("some/where.ibrdf", FindModel("some/where.ibrdf").value());
}

TEST(FindModel, BroadHasALambertianLobe) {
  const NeuralBrdfModel model = ReadModel(FindModel("broad").value()).value();
  EXPECT_TRUE(model.fit_lambertian);
  const auto trained_on = [&](const std::string& name) {
    return std::find(model.names.begin(), model.names.end(), name) !=
           model.names.end();
  };
  EXPECT_TRUE(trained_on("nickel.red"));
  EXPECT_TRUE(trained_on("paper_white.red"));
  EXPECT_TRUE(trained_on("cook-torrance-00.red"));
  EXPECT_TRUE(trained_on("principled-03.red"));
}

TEST(FindModel, DefaultOfTheSourceTreeLoadsAndMakesSense) {
  ::setenv("IBRDF_MODEL_DIR",
           (std::string(IBRDF_SOURCE_DIR) + "/models").c_str(), 1);
  const StatusOr<std::string> path = FindModel("default");
  ASSERT_TRUE(path.ok()) << path.status().message();
  ::setenv("IBRDF_MODEL_DIR", "/nowhere", 1);
  EXPECT_TRUE(FindModel("default").ok());  // without the variable's help too
  ::unsetenv("IBRDF_MODEL_DIR");
  EXPECT_EQ(std::string(IBRDF_SOURCE_DIR) + "/models/default.ibrdf", *path);
  const StatusOr<NeuralBrdfModel> model = ReadModel(*path);
  ASSERT_TRUE(model.ok()) << model.status().message();
  EXPECT_EQ(16, model->shape.code_size());
  const int codes = model->num_codes();
  EXPECT_GT(codes, 0);
  EXPECT_EQ(0, codes % 3);
  // The density of a trained material integrates to 1, by the midpoint rule.
  // Peaks are as narrow as the narrowest bin, 1e-3, and as sharp below the
  // horizon, which no measurement binds: hence the fine steps in x_h, and a
  // tolerance of twice the error that was seen.
  constexpr double kTolerance = 0.02;
  const std::unique_ptr<BrdfFlow> flow =
      BrdfFlow::Create(model->shape, model->weights);
  constexpr int kThetaD = 160, kPhiD = 24, kPoints = 3000;
  FlowColumns x(kThetaD * kPhiD, kPoints);
  for (int c = 0; c < x.columns; ++c) {
    x.SetColumn(c, (c / kPhiD + 0.5) / kThetaD, (c % kPhiD + 0.5) / kPhiD);
    for (int i = 0; i < kPoints; ++i) {
      x.x_h[static_cast<size_t>(i) * x.columns + c] =
          (static_cast<float>(i) + 0.5f) / kPoints;
    }
  }
  std::vector<float> value(x.num_points());
  for (const int m : {0, codes / 2}) {
    flow->LogDensityOnColumns(
        x, model->codes.data() + m * model->shape.code_size(), 1, value.data(),
        nullptr);
    double sum = 0.0;
    for (const float v : value) sum += std::exp(double{v});
    EXPECT_NEAR(1.0, sum / static_cast<double>(x.num_points()), kTolerance)
        << model->names[m];
  }
}

// 2^32 + 4 is 4 in 32 bits.
TEST_F(ModelFile, SizesThatNoIntHoldsAreRefused) {
  Rewrite("\"code_size\":4", "\"code_size\":4294967300");
  ExpectRefused("code size");
  ASSERT_TRUE(WriteModel(model_, path_).ok());
  Rewrite("\"fit_lobes\":", "\"fit_lobes\":429496729");
  ExpectRefused("fit_lobes");
  ASSERT_TRUE(WriteModel(model_, path_).ok());
  Rewrite("\"bins\":[6,4,4]", "\"bins\":[4294967302,4,4]");
  ExpectRefused("bins");
}

}  // namespace
}  // namespace ibrdf
