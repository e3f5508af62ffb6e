#include "ibrdf/io/atomic_file.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <new>
#include <string>

#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

TEST(AtomicFile, RoundTripLeavesOneFile) {
  const TempDir dir;
  const std::string path = dir.File("a.bin");
  std::string bytes(100000, '\0');
  for (size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 7);
  ASSERT_TRUE(WriteFileAtomically(path, "old").ok());
  ASSERT_TRUE(WriteFileAtomically(path, bytes).ok());
  EXPECT_EQ(bytes, ReadFile(path, bytes.size()).value());
  EXPECT_EQ(1, dir.CountFiles());
}

TEST(AtomicFile, EmptyFile) {
  const TempDir dir;
  ASSERT_TRUE(WriteFileAtomically(dir.File("a"), "").ok());
  EXPECT_EQ("", ReadFile(dir.File("a"), 0).value());
}

TEST(AtomicFile, FailedWriteKeepsTheOldFile) {
  const TempDir dir;
  const std::string path = dir.File("a.txt");
  ASSERT_TRUE(WriteFileAtomically(path, "old").ok());
  const Status status = WriteAtomically(path, [](const std::string& temporary) {
    WriteBytes(temporary, "half of the new");
    return InvalidInput(temporary, "disk full");
  });
  EXPECT_FALSE(status.ok());
  EXPECT_EQ("old", ReadBytes(path));
  EXPECT_EQ(1, dir.CountFiles());
}

TEST(AtomicFile, ThrowingWriterLeavesNothing) {
  const TempDir dir;
  const auto write = [](const std::string& temporary) -> Status {
    WriteBytes(temporary, "half");
    throw std::bad_alloc();
  };
  EXPECT_THROW(static_cast<void>(WriteAtomically(dir.File("a"), write)),
               std::bad_alloc);
  EXPECT_EQ(0, dir.CountFiles());
}

TEST(AtomicFile, TemporaryNameIsBesideAndKeepsTheExtension) {
  const TempDir dir;
  const std::string path = dir.File("a.exr");
  std::string used;
  ASSERT_TRUE(WriteAtomically(path, [&](const std::string& temporary) {
                used = temporary;
                WriteBytes(temporary, "x");
                return OkStatus();
              }).ok());
  EXPECT_EQ(0u, used.find(dir.path() + "/"));
  EXPECT_EQ(".exr", used.substr(used.size() - 4));
  EXPECT_NE(path, used);
}

TEST(AtomicFile, WhatAKilledWriterLeftGoesWithTheNextWrite) {
  const TempDir dir;
  const std::string path = dir.File("a.exr");
  WriteBytes(dir.File(".tmp-elsewhere-1-a.exr"), "of another machine");
  const pid_t killed = ::fork();
  if (killed == 0) {
    const Status never =
        WriteAtomically(path, [](const std::string& temporary) {
          WriteBytes(temporary, "half");
          ::kill(::getpid(), SIGKILL);
          return OkStatus();
        });
    ::_exit(never.ok() ? 0 : 1);
  }
  int status = 0;
  ::waitpid(killed, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  ASSERT_EQ(2, dir.CountFiles());
  ASSERT_TRUE(WriteFileAtomically(dir.File("b-a.exr"), "other").ok());
  EXPECT_EQ(3, dir.CountFiles());
  // What another process is writing at the time stays.
  ASSERT_TRUE(WriteAtomically(path, [&](const std::string& temporary) {
                WriteBytes(temporary, "whole");
                const pid_t quicker = ::fork();
                if (quicker == 0) {
                  ::_exit(WriteFileAtomically(path, "quicker").ok() ? 0 : 1);
                }
                int code = -1;
                ::waitpid(quicker, &code, 0);
                EXPECT_EQ(0, code);
                return OkStatus();
              }).ok());
  EXPECT_EQ("whole", ReadBytes(path));
  EXPECT_EQ(3, dir.CountFiles());
}

TEST(AtomicFile, UnwritableTargetsLeaveNothing) {
  const TempDir dir;
  const Status missing = WriteFileAtomically(dir.File("none/a"), "x");
  EXPECT_EQ(StatusCode::kInvalidInput, missing.code());
  EXPECT_EQ(0u, missing.message().find(dir.File("none/a") + ": "));
  // The target is a folder that is not empty.
  std::filesystem::create_directories(dir.File("folder/inside"));
  EXPECT_FALSE(WriteFileAtomically(dir.File("folder"), "x").ok());
  EXPECT_EQ(1, dir.CountFiles());
}

TEST(AtomicFile, ReadRefusesWhatIsNotAFileOrTooLong) {
  const TempDir dir;
  EXPECT_FALSE(ReadFile(dir.File("missing"), 10).ok());
  EXPECT_FALSE(ReadFile(dir.path(), 1 << 20).ok());
  WriteBytes(dir.File("long"), "12345");
  EXPECT_FALSE(ReadFile(dir.File("long"), 4).ok());
  EXPECT_TRUE(ReadFile(dir.File("long"), 5).ok());
}

}  // namespace
}  // namespace ibrdf
