// What fuzzing found, and the files that claim most: each parser gives an
// answer that keeps its promises (tests/fuzz/parsers.h).
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstring>
#include <filesystem>

#include "ibrdf/io/exr.h"
#include "ibrdf/io/mesh.h"
#include "ibrdf/io/png.h"
#include "ibrdf/io/problem_file.h"
#include "ibrdf/io/radiance_hdr.h"
#include "tests/fuzz/parsers.h"
#include "tests/support/png_crc.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

void Feed(const std::string& parser, const std::string& input) {
  FuzzParser(parser, reinterpret_cast<const uint8_t*>(input.data()),
             input.size());
}

// tests/fuzz/regressions/<parser>/<what was found>.
TEST(ParserRegression, FindingsStayMended) {
  const std::filesystem::path folder =
      std::string(IBRDF_SOURCE_DIR) + "/tests/fuzz/regressions";
  int inputs = 0;
  for (const auto& parser : std::filesystem::directory_iterator(folder)) {
    for (const auto& input : std::filesystem::directory_iterator(parser)) {
      SCOPED_TRACE(input.path());
      Feed(parser.path().filename(), ReadBytes(input.path()));
      ++inputs;
    }
  }
  EXPECT_GT(inputs, 0);
}

TEST(ParserRegression, EveryParserTakesNothingAndJunk) {
  for (const std::string& parser : FuzzedParsers()) {
    SCOPED_TRACE(parser);
    Feed(parser, "");
    Feed(parser, std::string(300, '\0'));
    Feed(parser, std::string(300, '\xff'));
  }
}

// Peak memory of this process, KiB.
int64_t PeakKib() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

// A header that claims 10^9 pixels and more is refused for its size, before
// memory is taken for it.
TEST(ParserRegression, HugeClaimsAreRefusedBeforeAllocation) {
  const TempDir dir;
  ASSERT_TRUE(WriteExr(Image(2, 2), dir.File("small.exr")).ok());
  std::string exr = ReadBytes(dir.File("small.exr"));
  // dataWindow: xMin, yMin, xMax, yMax as int32 after name, type and size.
  const size_t window = exr.find("dataWindow");
  ASSERT_NE(std::string::npos, window);
  const size_t at = window + sizeof("dataWindow") + sizeof("box2i") + 4;
  const int32_t last = 31622;  // 31623^2 > 10^9
  std::memcpy(&exr[at + 8], &last, sizeof(last));
  std::memcpy(&exr[at + 12], &last, sizeof(last));
  WriteBytes(dir.File("huge.exr"), exr);

  ASSERT_TRUE(WritePng(Rgb8Image(2, 2), dir.File("small.png")).ok());
  std::string png = ReadBytes(dir.File("small.png"));
  // IHDR: width and height at bytes 16 and 20, its CRC at 29.
  const std::string ihdr("\0\0\x7b\x87\0\0\x7b\x87", 8);
  png.replace(16, 8, ihdr);
  const uint32_t crc = PngCrc(png.data() + 12, 17);
  for (size_t i = 0; i < 4; ++i) {
    png[29 + i] = static_cast<char>(crc >> (24 - 8 * i));
  }
  WriteBytes(dir.File("huge.png"), png);

  WriteBytes(dir.File("huge.hdr"), "#?RADIANCE\n\n-Y 31623 +X 31623\n\1\1\1");
  WriteBytes(dir.File("huge.ply"),
             "ply\nformat binary_little_endian 1.0\n"
             "element vertex 1000000000\nproperty float x\n"
             "property float y\nproperty float z\nelement face 1\n"
             "property list uchar int vertex_indices\nend_header\n0123");
  WriteBytes(dir.File("huge.yaml"),
             "image: {width: 31623, height: 31623}\ngeometry: {sphere: {}}\n");

  const int64_t before = PeakKib();
  const auto expect_refused = [](const Status& status,
                                 const std::string& name) {
    EXPECT_EQ(StatusCode::kInvalidInput, status.code()) << name;
    EXPECT_NE(std::string::npos, status.message().find(name));
    const bool says = status.message().find("size") != std::string::npos ||
                      status.message().find("count") != std::string::npos ||
                      status.message().find("pixels") != std::string::npos;
    EXPECT_TRUE(says) << status.message();
  };
  expect_refused(ReadExr(dir.File("huge.exr")).status(), "huge.exr");
  // The second attribute hides behind the end of the first one's value.
  const std::string hidden = "attribute_longer_than_its_type";
  expect_refused(ReadExr(std::string(IBRDF_SOURCE_DIR) +
                         "/tests/fuzz/regressions/exr/" + hidden)
                     .status(),
                 hidden);
  expect_refused(ReadMask(dir.File("huge.png")).status(), "huge.png");
  expect_refused(ReadRadianceHdr(dir.File("huge.hdr")).status(), "huge.hdr");
  expect_refused(ReadMesh(dir.File("huge.ply")).status(), "huge.ply");
  expect_refused(ReadProblem(dir.File("huge.yaml"), {}).status(), "huge.yaml");
  // 10^9 pixels take gigabytes; the libraries' own tables are far below this.
  constexpr int64_t kSlackKib = 64 << 10;
  EXPECT_LT(PeakKib() - before, kSlackKib);
}

// File names and quoted contents cannot break a message into lines.
TEST(ParserRegression, MessagesAreOneLine) {
  const TempDir dir;
  WriteBytes(dir.File("a.yaml"), "\"ima\\nge\\e[2J\": 1\n");
  const Status status = ReadProblem(dir.File("a.yaml"), {}).status();
  EXPECT_EQ(StatusCode::kInvalidInput, status.code());
  for (const char c : status.message()) {
    EXPECT_GE(static_cast<unsigned char>(c), 0x20) << status.message();
  }
}

}  // namespace
}  // namespace ibrdf
