#include "ibrdf/io/merl.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

constexpr size_t kHeaderBytes = 12;
constexpr size_t kFileBytes = kHeaderBytes + size_t{24} * kMerlBins;

MerlTable RandomTable(uint32_t seed) {
  std::mt19937 rng(seed);
  MerlTable table;
  table.raw.resize(size_t{3} * kMerlBins);
  for (double& v : table.raw) v = std::ldexp(rng(), -20) - 1.0;
  return table;
}

class MerlFile : public ::testing::Test {
 protected:
  void Replace(size_t offset, const void* data, size_t size) {
    std::string bytes = ReadBytes(path_);
    std::memcpy(&bytes[offset], data, size);
    WriteBytes(path_, bytes);
  }

  const TempDir dir_;
  const std::string path_ = dir_.File("a.binary");
};

TEST_F(MerlFile, RoundTripKeepsEveryBit) {
  const MerlTable table = RandomTable(1);
  ASSERT_TRUE(WriteMerl(table, path_).ok());
  const StatusOr<MerlTable> read = ReadMerl(path_);
  ASSERT_TRUE(read.ok()) << read.status().message();
  EXPECT_EQ(table.raw, read->raw);
  EXPECT_EQ(1, dir_.CountFiles());
}

TEST_F(MerlFile, ATableWithoutAValidBinIsRefused) {
  MerlTable table;
  table.raw.assign(size_t{3} * kMerlBins, -1.0);
  ASSERT_TRUE(WriteMerl(table, path_).ok());
  const Status status = ReadMerl(path_).status();
  EXPECT_EQ(StatusCode::kInvalidInput, status.code());
  EXPECT_NE(std::string::npos, status.message().find("valid bin"));
  table.raw[1000] = 0.5;
  ASSERT_TRUE(WriteMerl(table, path_).ok());
  EXPECT_TRUE(ReadMerl(path_).ok());
}

TEST_F(MerlFile, OtherFilesAreNamed) {
  const auto message = [&](const std::string& bytes) {
    WriteBytes(path_, bytes);
    const Status status = ReadMerl(path_).status();
    EXPECT_EQ(StatusCode::kInvalidInput, status.code());
    return status.message();
  };
  EXPECT_NE(std::string::npos,
            message("tensor_file" + std::string(60, '\0')).find("RGL"));
  EXPECT_NE(std::string::npos,
            message(std::string("\0\0\0\x5a\0\0\0\x5a\0\0\0\xb4", 12) +
                    std::string(24, '\0'))
                .find("big-endian"));
}

TEST_F(MerlFile, BytesAreThoseOfTheFormat) {
  MerlTable table;
  table.raw.assign(size_t{3} * kMerlBins, 0.0);
  // Green, theta_h 3, theta_d 5, phi_d 7.
  const size_t entry = size_t{1} * kMerlBins + (3 * 90 + 5) * 180 + 7;
  table.raw[entry] = 42.5;
  EXPECT_EQ(42.5, table.Raw(1, MerlTable::Bin(3, 5, 7)));
  ASSERT_TRUE(WriteMerl(table, path_).ok());
  const std::string bytes = ReadBytes(path_);
  ASSERT_EQ(kFileBytes, bytes.size());
  EXPECT_EQ(std::string("\x5a\0\0\0\x5a\0\0\0\xb4\0\0\0", 12),
            bytes.substr(0, 12));
  double value = 0.0;
  std::memcpy(&value, bytes.data() + kHeaderBytes + 8 * entry, 8);
  EXPECT_EQ(42.5, value);
}

TEST_F(MerlFile, TruncationsAndExcessAreRefused) {
  ASSERT_TRUE(WriteMerl(RandomTable(2), path_).ok());
  const std::string bytes = ReadBytes(path_);
  for (const size_t n :
       {size_t{0}, size_t{1}, size_t{11}, size_t{12}, size_t{13},
        kFileBytes / 3, kFileBytes - 8, kFileBytes - 1}) {
    WriteBytes(path_, bytes.substr(0, n));
    const Status status = ReadMerl(path_).status();
    EXPECT_EQ(StatusCode::kInvalidInput, status.code()) << n;
    EXPECT_EQ(0u, status.message().find(path_ + ": ")) << n;
  }
  WriteBytes(path_, bytes + "x");
  EXPECT_FALSE(ReadMerl(path_).ok());
}

TEST_F(MerlFile, OtherDimensionsAreRefused) {
  ASSERT_TRUE(WriteMerl(RandomTable(3), path_).ok());
  for (const int32_t bad : {0, -90, 89, 180, 0x7fffffff}) {
    Replace(4, &bad, 4);
    const Status status = ReadMerl(path_).status();
    EXPECT_EQ(StatusCode::kInvalidInput, status.code());
    EXPECT_NE(std::string::npos,
              status.message().find("dimensions: expected 90 90 180"));
  }
}

TEST_F(MerlFile, EntriesThatAreNotFiniteAreRefused) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                           -std::numeric_limits<double>::infinity()}) {
    ASSERT_TRUE(WriteMerl(RandomTable(4), path_).ok());
    Replace(kHeaderBytes + 8 * 123456, &bad, 8);
    const Status status = ReadMerl(path_).status();
    EXPECT_EQ(StatusCode::kInvalidInput, status.code());
    EXPECT_NE(std::string::npos, status.message().find("entry 123456"));
  }
}

TEST_F(MerlFile, WhatIsNotAFileAndWhatCannotBeWritten) {
  EXPECT_FALSE(ReadMerl(dir_.File("missing.binary")).ok());
  EXPECT_FALSE(ReadMerl(dir_.path()).ok());
  EXPECT_EQ(StatusCode::kInvalidInput,
            WriteMerl(RandomTable(5), dir_.File("none/a.binary")).code());
  EXPECT_EQ(StatusCode::kInternal, WriteMerl(MerlTable(), path_).code());
  EXPECT_EQ(0, dir_.CountFiles());
}

}  // namespace
}  // namespace ibrdf
