#include "ibrdf/solvers/problem/open_model.h"

#include <gtest/gtest.h>

#include "ibrdf/io/model_file.h"
#include "tests/support/temp_dir.h"
#include "tests/support/tiny_model.h"

namespace ibrdf {
namespace {

TEST(OpenModel, ReadsAModelAndItsPath) {
  const TempDir dir;
  const NeuralBrdfModel model = TinyModel(2);
  ASSERT_TRUE(WriteModel(model, dir.File("m.ibrdf")).ok());
  const StatusOr<OpenedModel> opened = OpenModel(dir.File("m.ibrdf"));
  ASSERT_TRUE(opened.ok()) << opened.status().message();
  EXPECT_EQ(dir.File("m.ibrdf"), opened->path);
  EXPECT_EQ(model.names, opened->model.names);
  EXPECT_EQ(model.codes, opened->model.codes);
}

TEST(OpenModel, RefusalsNameTheFile) {
  const TempDir dir;
  EXPECT_NE(std::string::npos,
            OpenModel(dir.File("none.ibrdf")).status().message().find("none"));
  NeuralBrdfModel model = TinyModel(1);
  model.names.clear();
  model.codes.clear();
  model.log_colours.clear();
  model.lobe_fits.clear();
  ASSERT_TRUE(WriteModel(model, dir.File("bare.ibrdf")).ok());
  const Status status = OpenModel(dir.File("bare.ibrdf")).status();
  EXPECT_EQ(StatusCode::kInvalidInput, status.code());
  EXPECT_NE(std::string::npos, status.message().find("bare.ibrdf: names"));
}

}  // namespace
}  // namespace ibrdf
