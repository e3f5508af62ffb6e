// What is written is read back.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstring>

#include "io/exr.h"
#include "io/merl.h"
#include "io/model_file.h"
#include "tests/properties/generators.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

// Any bits: negative zero, denormals, infinities, not numbers.
std::vector<float> AnyFloats(size_t count) {
  const auto bits = *rc::gen::container<std::vector<uint32_t>>(
      count, rc::gen::arbitrary<uint32_t>());
  std::vector<float> values(count);
  std::memcpy(values.data(), bits.data(), 4 * count);
  return values;
}

bool SameBits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), 4 * a.size()) == 0;
}

RC_GTEST_PROP(FileProperty, FloatExrKeepsEveryBit, ()) {
  const TempDir dir;
  Image image(*rc::gen::inRange(1, 40), *rc::gen::inRange(1, 40));
  image.rgb = AnyFloats(image.rgb.size());
  RC_ASSERT(WriteExr(image, dir.File("a.exr")).ok());
  const StatusOr<Image> back = ReadExr(dir.File("a.exr"));
  RC_ASSERT(back.ok());
  RC_ASSERT(back->width == image.width && back->height == image.height);
  RC_ASSERT(SameBits(image.rgb, back->rgb));
  RC_ASSERT(dir.CountFiles() == 1);
}

RC_GTEST_PROP(FileProperty, ModelsKeepEveryBit, ()) {
  const TempDir dir;
  const NeuralBrdfModel model = AnyModel();
  RC_ASSERT(WriteModel(model, dir.File("m.ibrdf")).ok());
  const StatusOr<NeuralBrdfModel> back = ReadModel(dir.File("m.ibrdf"));
  RC_ASSERT(back.ok());
  RC_ASSERT(SameBits(model.weights, back->weights));
  RC_ASSERT(SameBits(model.codes, back->codes));
  RC_ASSERT(SameBits(model.log_colours, back->log_colours));
  RC_ASSERT(model.names == back->names && model.note == back->note);
}

}  // namespace
}  // namespace ibrdf
