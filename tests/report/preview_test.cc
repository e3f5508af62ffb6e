#include "ibrdf/solvers/report/preview.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "ibrdf/solvers/drawing/tone_map.h"
#include "tests/support/non_finite.h"

namespace ibrdf {
namespace {

using Colour = std::array<int, 3>;
constexpr Colour kGrey = {176, 176, 176};

Image Constant(int width, int height, float value) {
  Image image(width, height);
  std::fill(image.rgb.begin(), image.rgb.end(), value);
  return image;
}

PreviewPanel Panel(const Image& image,
                   PreviewPanel::Kind kind = PreviewPanel::Kind::kRadiance) {
  PreviewPanel panel;
  panel.image = image;
  panel.kind = kind;
  return panel;
}

int Count(const Rgb8Image& image, const Colour& colour) {
  int count = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const uint8_t* p = image.At(x, y);
      count += p[0] == colour[0] && p[1] == colour[1] && p[2] == colour[2];
    }
  }
  return count;
}

TEST(ToneMap, SrgbHasItsTableValues) {
  EXPECT_EQ(EncodeSrgb(0.0), 0);
  EXPECT_EQ(EncodeSrgb(1.0), 255);
  EXPECT_EQ(EncodeSrgb(0.18), 118);    // middle grey
  EXPECT_EQ(EncodeSrgb(0.2140), 127);  // 50 % of the code
  EXPECT_EQ(EncodeSrgb(-3.0), 0);
  EXPECT_EQ(EncodeSrgb(1e30), 255);
  for (int code = 0; code < 256; ++code) {
    EXPECT_EQ(EncodeSrgb(DecodeSrgb(code / 255.0)), code);
  }
}

TEST(ToneMap, ExposureIsAPercentileInsideTheMask) {
  Image image(100, 2);
  Mask mask(100, 2, 0);
  for (int x = 0; x < 100; ++x) {
    image.At(x, 0)[1] = static_cast<float>(x + 1);
    image.At(x, 1)[0] = 1e6f;  // outside
    mask.inside[x] = 1;
  }
  // 1 to 100: the value that 90 are below is 91.
  EXPECT_DOUBLE_EQ(ExposureOf(image, mask, 90.0), 1.0 / 91.0);
  EXPECT_DOUBLE_EQ(ExposureOf(image, mask, 100.0), 1.0 / 100.0);
  EXPECT_DOUBLE_EQ(ExposureOf(image, Mask(), 100.0), 1e-6);
  EXPECT_DOUBLE_EQ(ExposureOf(Constant(4, 4, 0.0f), Mask(), 99.0), 1.0);
  EXPECT_DOUBLE_EQ(ExposureOf(Constant(4, 4, kNan), Mask(), 99.0), 1.0);
}

TEST(ToneMap, DivergingColoursEndInBlueWhiteAndRed) {
  uint8_t rgb[3];
  DivergingColour(0.0, rgb);
  EXPECT_EQ(rgb[0] + rgb[1] + rgb[2], 3 * 255);
  DivergingColour(-1.0, rgb);
  EXPECT_GT(rgb[2], rgb[0] + 100);
  DivergingColour(5.0, rgb);
  EXPECT_GT(rgb[0], rgb[2] + 100);
}

TEST(Preview, EnlargesByAWholeFactorWithoutBlending) {
  Image image(64, 32);
  image.At(0, 0)[0] = 1.0f;  // one red pixel, the rest black
  const Rgb8Image picture = ComposePanels({{Panel(image)}}, "");
  const int red = Count(picture, {255, 0, 0});
  const int factor = static_cast<int>(std::lround(std::sqrt(red)));
  EXPECT_GE(factor, 2);
  EXPECT_EQ(red, factor * factor);
  EXPECT_EQ(Count(picture, {0, 0, 0}), (64 * 32 - 1) * factor * factor);
}

TEST(Preview, MaskedAndNanPixelsAreGreyAndInfiniteOnesWhite) {
  Image image = Constant(8, 8, 0.0f);
  Mask mask(8, 8, 1);
  mask.inside[3] = 0;
  image.At(5, 5)[1] = kNan;
  image.At(6, 6)[0] = image.At(6, 6)[1] = image.At(6, 6)[2] = kInfinity;
  PreviewPanel panel = Panel(image);
  panel.mask = mask;
  const Rgb8Image picture = ComposePanels({{panel}}, "");
  const int pixel = 52 * 52;  // 420 / 8, whole
  // Smoothed text has a few pixels of any grey.
  EXPECT_NEAR(Count(picture, kGrey), 2 * pixel, 20);
  EXPECT_EQ(Count(picture, {255, 255, 255}), pixel);
}

TEST(Preview, ResidualIsRedWhereTheRenderIsTooBright) {
  Image residual = Constant(4, 1, 0.0f);
  for (int c = 0; c < 3; ++c) {
    residual.At(0, 0)[c] = 0.3f;
    residual.At(1, 0)[c] = -0.3f;
  }
  PreviewPanel panel = Panel(residual, PreviewPanel::Kind::kSignedResidual);
  panel.range = 0.1;
  const Rgb8Image picture = ComposePanels({{panel}}, "");
  uint8_t red[3], blue[3];
  DivergingColour(1.0, red);
  DivergingColour(-1.0, blue);
  const int reds = Count(picture, {red[0], red[1], red[2]});
  const int blues = Count(picture, {blue[0], blue[1], blue[2]});
  EXPECT_GT(reds, 300 * 300);
  EXPECT_GT(blues, 300 * 300);
}

// A bar from 0 has no blue, and red where the values are largest.
TEST(Preview, DeviationsBeginAtZero) {
  Image deviation(2, 1);
  std::fill_n(deviation.At(1, 0), 3, 0.4f);
  PreviewPanel panel = Panel(deviation, PreviewPanel::Kind::kDeviation);
  const auto blue = [](const Rgb8Image& picture) {
    int count = 0;
    for (size_t i = 0; i < picture.rgb.size(); i += 3) {
      count += picture.rgb[i + 2] > picture.rgb[i] + 40;
    }
    return count;
  };
  EXPECT_EQ(0, blue(ComposePanels({{panel}}, "")));
  const PanelPicture drawn = DrawPanel(panel, 16);
  EXPECT_NEAR(0.4, drawn.range, 1e-6);
  EXPECT_EQ(255, drawn.pixels.At(0, 0)[2]);
  EXPECT_LT(drawn.pixels.At(1, 0)[2], drawn.pixels.At(1, 0)[0]);
  panel.kind = PreviewPanel::Kind::kSignedResidual;
  EXPECT_GT(blue(ComposePanels({{panel}}, "")), 0);
}

TEST(Preview, LargeImagesAreReducedToFitTheWidth) {
  const Rgb8Image one = ComposePanels({{Panel(Constant(3000, 100, 1.0f))}}, "");
  EXPECT_LE(one.width, 1440);
  const std::vector<PreviewPanel> row(5, Panel(Constant(450, 1000, 0.5f)));
  const Rgb8Image five = ComposePanels({row, row}, "title", {"note"});
  EXPECT_LE(five.width, 1440);
  // The mean of equal pixels is the pixel: no ringing, no darkening.
  EXPECT_GT(Count(five, {EncodeSrgb(0.5), EncodeSrgb(0.5), EncodeSrgb(0.5)}),
            10 * 150 * 400);
}

// Labels wider than their pictures stand beside each other all the same.
TEST(Preview, LabelsDoNotOverlap) {
  PreviewPanel panel = Panel(Constant(4, 400, 1.0f));
  panel.label = "Incomprehensibilities";
  const Rgb8Image picture = ComposePanels({{panel, panel, panel, panel}}, "");
  // Groups of columns with ink in the rows of the labels.
  int groups = 0, since_ink = 1000;
  for (int x = 0; x < picture.width; ++x) {
    bool ink = false;
    for (int y = 20; y < 46; ++y) ink |= picture.At(x, y)[0] < 120;
    groups += ink && since_ink > 20;
    since_ink = ink ? 0 : since_ink + 1;
  }
  EXPECT_EQ(4, groups);
}

TEST(Preview, AFewPixelsDoNotSetTheResidualsScale) {
  Image residual = Constant(100, 100, 0.1f);
  Mask mask(100, 100, 1);
  for (int k = 0; k < 150; ++k) {
    residual.rgb[3 * k] = residual.rgb[3 * k + 1] = residual.rgb[3 * k + 2] =
        20.0f;
  }
  for (int y = 50; y < 100; ++y) {
    for (int x = 0; x < 50; ++x) {  // took no part
      mask.inside[100 * y + x] = 0;
      residual.At(x, y)[0] = 1e6f;
    }
  }
  PreviewPanel panel = Panel(residual, PreviewPanel::Kind::kSignedResidual);
  panel.mask = mask;
  // 150 of 7500 are 2 %.
  EXPECT_NEAR(20.0, DrawPanel(panel, 100).range, 1e-5);
  panel.image.rgb[0] = panel.image.rgb[1] = panel.image.rgb[2] = 0.1f;
  EXPECT_NEAR(0.1, DrawPanel(panel, 100).range, 1e-5);
}

TEST(Preview, SamplesMakeAPixelTogether) {
  Image image(8, 8);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      for (int c = 0; c < 3; ++c) image.At(x, y)[c] = (x + y) % 2 ? 1.0f : 0.0f;
    }
  }
  PreviewPanel panel = Panel(image);
  panel.samples = 2;
  const Rgb8Image picture = DrawPanel(panel, 100).pixels;
  EXPECT_EQ(4, picture.width);
  EXPECT_EQ(
      16, Count(picture, {EncodeSrgb(0.5), EncodeSrgb(0.5), EncodeSrgb(0.5)}));
}

TEST(Preview, TextIsDrawnInItsPlace) {
  const std::vector<std::vector<PreviewPanel>> rows = {
      {Panel(Constant(16, 16, 1.0f))}};
  const Rgb8Image plain = ComposePanels(rows, "");
  const Rgb8Image titled = ComposePanels(rows, "A title", {"a note"});
  EXPECT_GT(titled.height, plain.height + 50);
  const auto darkest = [](const Rgb8Image& image, int begin, int end) {
    int value = 255;
    for (int y = begin; y < end; ++y) {
      for (int x = 0; x < image.width; ++x) {
        value = std::min<int>(value, image.At(x, y)[0]);
      }
    }
    return value;
  };
  EXPECT_EQ(darkest(plain, 0, 30), 250);
  EXPECT_LT(darkest(titled, 0, 60), 60);
  EXPECT_LT(darkest(titled, titled.height - 60, titled.height), 80);
}

}  // namespace
}  // namespace ibrdf
