// What is written is read back.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cstring>
#include <limits>

#include "ibrdf/io/exr.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/io/model_file.h"
#include "tests/properties/generators.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

template <typename Number>
bool SameBits(const std::vector<Number>& a, const std::vector<Number>& b) {
  return a.size() == b.size() &&
         (a.empty() ||
          std::memcmp(a.data(), b.data(), sizeof(Number) * a.size()) == 0);
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
  NeuralBrdfModel model = AnyModel();
  model.exponent = *Between(0.5, 4.0);
  model.fit_lobes = *rc::gen::inRange(0, 4);
  const size_t code_size = model.shape.code_size();
  for (int lobe = 0; lobe < model.fit_lobes * model.num_materials(); ++lobe) {
    // Codes inside the unit ball, as the reader wants them.
    for (size_t d = 0; d < code_size; ++d) {
      model.lobe_fits.push_back(static_cast<float>(*Between(-0.49, 0.49)));
    }
    for (int c = 0; c < 3; ++c) {
      model.lobe_fits.push_back(static_cast<float>(*Between(-30.0, 30.0)));
    }
  }
  model.fit_lambertian = model.fit_lobes > 0 && *rc::gen::arbitrary<bool>();
  for (int i = 0; model.fit_lambertian && i < 3 * model.num_materials(); ++i) {
    model.lobe_fits.push_back(static_cast<float>(*Between(-30.0, 30.0)));
  }
  RC_ASSERT(WriteModel(model, dir.File("m.ibrdf")).ok());
  const StatusOr<NeuralBrdfModel> back = ReadModel(dir.File("m.ibrdf"));
  RC_ASSERT(back.ok());
  RC_ASSERT(SameBits(model.weights, back->weights));
  RC_ASSERT(SameBits(model.codes, back->codes));
  RC_ASSERT(SameBits(model.log_colours, back->log_colours));
  RC_ASSERT(SameBits(model.lobe_fits, back->lobe_fits));
  RC_ASSERT(model.fit_lobes == back->fit_lobes);
  RC_ASSERT(model.fit_lambertian == back->fit_lambertian);
  RC_ASSERT(model.exponent == back->exponent);
  RC_ASSERT(model.names == back->names && model.note == back->note);
}

// 35 MB each, hence few; any finite value may stand in a bin.
TEST(FileProperty, MerlTablesKeepEveryBit) {
  const TempDir dir;
  CheckSome(4, [&dir] {
    MerlTable table;
    table.raw = AnyFiniteDoubles(size_t{3} * kMerlBins);
    RC_ASSERT(WriteMerl(table, dir.File("t.binary")).ok());
    const StatusOr<MerlTable> back = ReadMerl(dir.File("t.binary"));
    RC_ASSERT(back.ok());
    RC_ASSERT(SameBits(table.raw, back->raw));
    RC_ASSERT(dir.CountFiles() == 1);
  });
}

RC_GTEST_PROP(FileProperty, MerlBytesOfAnyDimensionsKeepEveryBit, ()) {
  const std::array<int32_t, 3> bins = {*rc::gen::inRange(1, 12),
                                       *rc::gen::inRange(1, 12),
                                       *rc::gen::inRange(1, 12)};
  std::vector<double> raw =
      AnyFiniteDoubles(size_t{3} * bins[0] * bins[1] * bins[2]);
  const auto bytes_of = [&bins](const std::vector<double>& values) {
    std::string bytes(12 + 8 * values.size(), '\0');
    std::memcpy(bytes.data(), bins.data(), 12);
    std::memcpy(bytes.data() + 12, values.data(), 8 * values.size());
    return bytes;
  };
  const StatusOr<std::vector<double>> back =
      DecodeMerl("t.binary", bytes_of(raw), bins);
  RC_ASSERT(back.ok());
  RC_ASSERT(SameBits(raw, *back));
  // One bad entry anywhere is found.
  raw[*rc::gen::oneOf(rc::gen::just(raw.size() - 1),
                      rc::gen::inRange(size_t{0}, raw.size()))] =
      *rc::gen::element(std::numeric_limits<double>::infinity(),
                        -std::numeric_limits<double>::infinity(),
                        std::numeric_limits<double>::quiet_NaN());
  RC_ASSERT(!DecodeMerl("t.binary", bytes_of(raw), bins).ok());
}

}  // namespace
}  // namespace ibrdf
