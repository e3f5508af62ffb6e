#include "ibrdf/solvers/report/html.h"

#include <gtest/gtest.h>

#include "ibrdf/image/rgb8_image.h"
#include "ibrdf/io/png.h"
#include "tests/support/base64.h"
#include "tests/support/markup.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

TEST(EscapeHtml, EscapesWhatMarkupReads) {
  EXPECT_EQ("a&lt;b&gt; &amp;amp; &quot;x&quot; &#39;y&#39;.exr",
            EscapeHtml("a<b> &amp; \"x\" 'y'.exr"));
  EXPECT_EQ("", EscapeHtml(""));
  EXPECT_EQ("line\n\ttab", EscapeHtml("line\n\ttab"));
}

TEST(EscapeHtml, KeepsUtf8AndReplacesTheRest) {
  const std::string fffd = "\xEF\xBF\xBD";
  const std::string good =
      "\xC3\xBC \xE2\x82\xAC \xF0\x9F\x99\x82";  // 2, 3 and 4 bytes
  EXPECT_EQ(good, EscapeHtml(good));
  EXPECT_EQ("a" + fffd + "b", EscapeHtml("a\xFF"
                                         "b"));    // no such byte
  EXPECT_EQ(fffd + "&lt;", EscapeHtml("\xC3<"));   // a lead alone hides nothing
  EXPECT_EQ(fffd + fffd, EscapeHtml("\xC0\xAF"));  // overlong
  EXPECT_EQ(fffd + fffd + fffd, EscapeHtml("\xED\xA0\x80"));  // a surrogate
  EXPECT_EQ(fffd + fffd, EscapeHtml("\xE2\x82"));             // cut short
  EXPECT_EQ(fffd + fffd + fffd, EscapeHtml(std::string("\0\x1B\x7F", 3)));
}

// RFC 4648, section 10.
TEST(Base64, KnownVectors) {
  EXPECT_EQ("", Base64(""));
  EXPECT_EQ("Zg==", Base64("f"));
  EXPECT_EQ("Zm8=", Base64("fo"));
  EXPECT_EQ("Zm9v", Base64("foo"));
  EXPECT_EQ("Zm9vYg==", Base64("foob"));
  EXPECT_EQ("Zm9vYmE=", Base64("fooba"));
  EXPECT_EQ("Zm9vYmFy", Base64("foobar"));
  EXPECT_EQ("+/8A", Base64(std::string("\xFB\xFF\0", 3)));
}

TEST(Base64, AllBytesComeBack) {
  std::string bytes;
  for (int i = 0; i < 257; ++i) bytes += static_cast<char>(i * 7);
  for (size_t n = 0; n <= bytes.size(); ++n) {
    const std::string text = Base64(bytes.substr(0, n));
    EXPECT_EQ(size_t{0}, text.size() % 4);
    EXPECT_EQ(bytes.substr(0, n), DecodeBase64(text));
  }
}

TEST(PngDataUri, HoldsTheFile) {
  Rgb8Image image(5, 3);
  for (size_t i = 0; i < image.rgb.size(); ++i) {
    image.rgb[i] = static_cast<uint8_t>(37 * i);
  }
  const TempDir dir;
  ASSERT_TRUE(WritePng(image, dir.File("a.png")).ok());
  const std::string file = ReadBytes(dir.File("a.png"));
  const StatusOr<std::string> encoded = EncodePng(image);
  ASSERT_TRUE(encoded.ok());
  EXPECT_EQ(file, *encoded);
  const std::string uri = PngDataUri(*encoded);
  const std::string prefix = "data:image/png;base64,";
  ASSERT_EQ(prefix, uri.substr(0, prefix.size()));
  EXPECT_EQ(file, DecodeBase64(uri.substr(prefix.size())));
  EXPECT_FALSE(EncodePng(Rgb8Image()).ok());
}

TEST(HtmlTable, CellsAreEscapedAndNumbersMarked) {
  const std::string table =
      HtmlTable({"<h>"}, {{"a & b"}, {"-0.5"}, {"+inf"}, {"3 %"}, {""}});
  EXPECT_EQ("", MarkupError(table));
  EXPECT_NE(std::string::npos, table.find("<th>&lt;h&gt;</th>"));
  EXPECT_NE(std::string::npos, table.find("<td>a &amp; b</td>"));
  EXPECT_NE(std::string::npos, table.find("<td class=\"number\">-0.5</td>"));
  EXPECT_NE(std::string::npos, table.find("<td>+inf</td>"));
  EXPECT_EQ(std::string::npos, HtmlTable({}, {{"a"}}).find("thead"));
}

// The tests' own reader must be able to fail.
TEST(MarkupError, FindsWhatIsWrong) {
  EXPECT_EQ("", MarkupError("<!DOCTYPE html><p a=\"1\">x &lt; <br /></p>"));
  for (const char* bad :
       {"<p>", "</p>", "<p></q>", "<p><q></p></q>", "a & b", "a > b", "<p a>",
        "<p a=1></p>", "<p a=\"1\" a=\"2\"></p>", "<p a=\"<\"></p>", "<p",
        "< p></p>", "&nbsp;", "<p a=\"1></p>"}) {
    EXPECT_NE("", MarkupError(bad)) << bad;
  }
}

}  // namespace
}  // namespace ibrdf
