#include "ibrdf/solvers/bench/held_out_models.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "ibrdf/io/model_file.h"
#include "tests/support/temp_dir.h"
#include "tests/support/tiny_model.h"

namespace ibrdf {
namespace {

// A model trained on m0 ... without `held`.
void WriteFold(const TempDir& dir, const std::string& name, int materials,
               int held) {
  NeuralBrdfModel model = TinyModel(materials);
  for (int c = 0; c < 3; ++c) {
    std::string& code = model.names[3 * held + c];
    code = "other" + code.substr(code.rfind('.'));
  }
  const std::string path = dir.File(name);
  std::filesystem::create_directories(
      std::filesystem::path(path).parent_path());
  ASSERT_TRUE(WriteModel(model, path).ok());
}

TEST(HeldOutModels, GivesTheModelThatHasNotSeenTheMaterial) {
  const TempDir dir;
  WriteFold(dir, "fold0/full.ibrdf", 3, 0);
  WriteFold(dir, "fold1/full.ibrdf", 3, 1);
  WriteFold(dir, "fold1/a_small.ibrdf", 2, 1);
  WriteFold(dir, "top.ibrdf", 3, 2);
  WriteBytes(dir.File("fold0/full.log"), "not a model");
  const HeldOutModels models =
      HeldOutModels::Open({"default", dir.path()}).value();
  EXPECT_EQ("fold0/full.ibrdf", models.For("m0")->label);
  EXPECT_EQ("fold1/full.ibrdf", models.For("m1")->label);
  EXPECT_EQ("top.ibrdf", models.For("m2")->label);
  EXPECT_EQ("_fold1-full.ibrdf", models.For("m1")->folder_suffix());
  EXPECT_NE(std::string::npos,
            ReflectanceYaml(*models.For("m1"), 2).find("fold1/full.ibrdf"));
  // No model knows it: the first of the largest.
  EXPECT_EQ("fold0/full.ibrdf", models.For("gold")->label);
  const Status seen = models.For("other").status();
  EXPECT_NE(std::string::npos, seen.message().find("other"));
}

TEST(HeldOutModels, AFolderOfTwoIsAPairThatHasSeenWhatEitherHas) {
  const TempDir dir;
  WriteFold(dir, "pair/default.ibrdf", 3, 0);
  WriteFold(dir, "pair/broad.ibrdf", 3, 1);
  WriteFold(dir, "alone/default.ibrdf", 2, 1);
  const HeldOutModels models =
      HeldOutModels::Open({"default", dir.path()}).value();
  EXPECT_EQ("pair", models.For("gold")->label);
  EXPECT_EQ(dir.File("pair"), models.For("gold")->path);
  EXPECT_EQ("_pair", models.For("gold")->folder_suffix());
  EXPECT_EQ("alone/default.ibrdf", models.For("m1")->label);
  EXPECT_FALSE(models.For("m0").ok());
  const auto yaml = [&](const std::string& material, bool alone) {
    return ReflectanceYaml(*models.For(material), 2, alone);
  };
  const std::string first = dir.File("pair/default.ibrdf");
  EXPECT_EQ(std::string::npos, yaml("gold", false).find(first));
  EXPECT_NE(std::string::npos, yaml("gold", true).find(first));
  EXPECT_EQ(yaml("m1", false), yaml("m1", true));
}

TEST(HeldOutModels, OneModelServesAll) {
  const TempDir dir;
  EXPECT_EQ("default", HeldOutModels::Open({}).value().For("m0")->label);
  EXPECT_EQ("{lobes: 3}\n",
            ReflectanceYaml(*HeldOutModels::Open({}).value().For("m0"), 3));
  EXPECT_EQ(
      "{model: \"default\", lobes: 3}\n",
      ReflectanceYaml(*HeldOutModels::Open({}).value().For("m0"), 3, true));
  WriteFold(dir, "one.ibrdf", 2, 0);
  const HeldOutModels one =
      HeldOutModels::Open({dir.File("one.ibrdf"), ""}).value();
  EXPECT_EQ("one.ibrdf", one.For("m1")->label);
  EXPECT_FALSE(HeldOutModels::Open({dir.File("two.ibrdf"), ""}).ok());
  EXPECT_FALSE(HeldOutModels::Open({dir.File("one.ibrdf"), dir.path()}).ok());
}

TEST(HeldOutModels, MalformedFoldersAreNamed) {
  const TempDir dir;
  EXPECT_NE(std::string::npos, HeldOutModels::Open({"default", dir.path()})
                                   .status()
                                   .message()
                                   .find(dir.path()));
  EXPECT_FALSE(HeldOutModels::Open({"default", dir.File("none")}).ok());
  WriteFold(dir, "good.ibrdf", 2, 0);
  WriteBytes(dir.File("torn.ibrdf"),
             ReadBytes(dir.File("good.ibrdf")).substr(0, 200));
  EXPECT_NE(std::string::npos, HeldOutModels::Open({"default", dir.path()})
                                   .status()
                                   .message()
                                   .find("torn.ibrdf"));
}

}  // namespace
}  // namespace ibrdf
