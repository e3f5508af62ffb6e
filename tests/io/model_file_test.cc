#include "io/model_file.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "ibrdf/flow/coupling_flow.h"
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
    std::string changed = "ibrdf-model 1\n" + std::to_string(header.size()) +
                          "\n" + header + bytes.substr(begin + length);
    Seal(&changed);
    WriteBytes(path_, changed);
  }
  void ExpectRefused(const std::string& field) const {
    const Status status = ReadModel(path_).status();
    EXPECT_EQ(StatusCode::kInvalidInput, status.code());
    EXPECT_EQ(0u, status.message().find(path_)) << status.message();
    EXPECT_NE(std::string::npos, status.message().find(field))
        << status.message();
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
  EXPECT_EQ(model_.shape.layers, read->shape.layers);
  EXPECT_EQ(model_.shape.bins, read->shape.bins);
  EXPECT_EQ(model_.shape.code_size, read->shape.code_size);
  EXPECT_EQ(model_.shape.widths, read->shape.widths);
  EXPECT_EQ(1, dir_.CountFiles());
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
  ForEachTruncation(ReadBytes(path_), path_, 200, [&] { ExpectRefused(""); });
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
  ForEachCorruption(bytes, path_, 400, 600, 5, [&] {
    std::string sealed = ReadBytes(path_);
    Seal(&sealed);
    WriteBytes(path_, sealed);
    const StatusOr<NeuralBrdfModel> read = ReadModel(path_);
    if (!read.ok()) {
      EXPECT_EQ(StatusCode::kInvalidInput, read.status().code());
    } else {
      EXPECT_EQ(read->shape.NumWeights(), read->weights.size());
    }
  });
}

TEST_F(ModelFile, OtherVersionsAndFilesAreNamed) {
  std::string bytes = ReadBytes(path_);
  bytes[12] = '2';
  Seal(&bytes);
  WriteBytes(path_, bytes);
  ExpectRefused("version");
  WriteBytes(path_, "PNG or something");
  ExpectRefused("not a model file");
  WriteBytes(path_, "");
  ExpectRefused("");
  WriteBytes(path_, "ibrdf-model 1\n99999999999999999999\n{}12345678");
  ExpectRefused("");
}

TEST_F(ModelFile, SizesThatDoNotFitAreRefused) {
  Rewrite("\"layers\":3", "\"layers\":4");
  ExpectRefused("numbers after the header");
}
TEST_F(ModelFile, HugeCountsAreRefusedWithoutBeingAllocated) {
  Rewrite("[8,4]", "[1000000000,4]");
  ExpectRefused("widths");
}
TEST_F(ModelFile, HugeLayersAreRefused) {
  Rewrite("\"layers\":3", "\"layers\":2000000000");
  ExpectRefused("layers");
}
TEST_F(ModelFile, LargestLegalShapeIsTooLargeForTheFile) {
  Rewrite("[8,4]", "[1024,1024,1024,1024,1024,1024,1024,1024]");
  ExpectRefused("numbers after the header");
}
TEST_F(ModelFile, NegativeAndWrongTypesAreRefused) {
  Rewrite("\"code_size\":4", "\"code_size\":-4");
  ExpectRefused("code size");
}
TEST_F(ModelFile, FieldOfAnotherTypeIsRefused) {
  Rewrite("\"bins\":4", "\"bins\":\"4\"");
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
  EXPECT_EQ(16, model->shape.code_size);
  EXPECT_EQ(300, model->num_codes());
  // The density of a trained material integrates to 1: the mean over a grid of
  // the cube's cells, within what 40^3 cells leave of its peaks.
  const CouplingFlow flow(model->shape, model->weights);
  constexpr int kSide = 40, kCount = kSide * kSide * kSide;
  std::vector<float> x(3 * kCount), value(kCount);
  for (int i = 0; i < kCount; ++i) {
    x[i] = (i / (kSide * kSide) + 0.5f) / kSide;
    x[kCount + i] = (i / kSide % kSide + 0.5f) / kSide;
    x[2 * kCount + i] = (i % kSide + 0.5f) / kSide;
  }
  for (const int m : {0, 150, 299}) {
    flow.LogDensity(x.data(), kCount,
                    model->codes.data() + m * model->shape.code_size, 1,
                    value.data(), nullptr);
    double sum = 0.0;
    for (const float v : value) sum += std::exp(double{v});
    EXPECT_NEAR(1.0, sum / kCount, 0.02) << model->names[m];
  }
}

}  // namespace
}  // namespace ibrdf
