#include "ibrdf/solvers/programs/problem_from_flags.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "ibrdf/io/problem_file.h"
#include "ibrdf/io/problem_json.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {
namespace fs = std::filesystem;

ProblemFlags Flags() {
  ProblemFlags flags;
  flags.photos = {"photo.exr"};
  flags.normals = "n.npy";
  flags.mask = "m.png";
  flags.command = "ibrdf_solve photo.exr";
  return flags;
}

std::string ErrorOf(const ProblemFlags& flags) {
  const StatusOr<FlagProblem> made = ProblemFromFlags(flags);
  return made.ok() ? "" : made.status().message();
}

TEST(ProblemFromFlags, IsTheProblemOfTheSameFile) {
  ProblemFlags flags = Flags();
  flags.known_light = "map.hdr";
  flags.response = "linear";
  flags.overrides = {"solver.seconds=30", "geometry.frame=opencv"};
  const StatusOr<FlagProblem> made = ProblemFromFlags(flags);
  ASSERT_TRUE(made.ok()) << made.status().message();
  const StatusOr<Problem> file = ParseProblem(
      "out/problem.yaml",
      "problem: reflectance\n"
      "image: {file: ../photo.exr, mask: ../m.png, response: linear}\n"
      "geometry: {normals: ../n.npy, frame: opencv}\n"
      "illumination: {known: ../map.hdr}\nsolver: {seconds: 30}\n",
      {});
  ASSERT_TRUE(file.ok()) << file.status().message();
  EXPECT_EQ(ProblemToJson(*file), ProblemToJson(made->problem));
  EXPECT_TRUE(made->notes.empty());
}

TEST(ProblemFromFlags, SeveralPhotographsAreOfOneView) {
  ProblemFlags flags = Flags();
  flags.photos = {"lamp one.exr", "b.exr"};
  const StatusOr<FlagProblem> made = ProblemFromFlags(flags);
  ASSERT_TRUE(made.ok()) << made.status().message();
  const StatusOr<Problem> file =
      ParseProblem("out/problem.yaml",
                   "images: [../lamp one.exr, ../b.exr]\n"
                   "image: {mask: ../m.png}\n"
                   "geometry: {normals: ../n.npy}\n",
                   {});
  ASSERT_TRUE(file.ok()) << file.status().message();
  EXPECT_EQ(ProblemToJson(*file), ProblemToJson(made->problem));
  flags.photos = {"a.exr", "\xff.exr"};
  EXPECT_EQ("command line: the photograph: expected a name in UTF-8",
            ErrorOf(flags));
}

TEST(ProblemFromFlags, TheTextGivesTheSameProblemAgain) {
  ProblemFlags flags = Flags();
  flags.photos = {"my photos/it's #1 \"best\".exr"};
  flags.normals = "/data/caf\xc3\xa9/{n: 1}.npy";
  flags.mask = "- [mask]: *x.png";
  flags.out = "results/a b";
  const StatusOr<FlagProblem> made = ProblemFromFlags(flags);
  ASSERT_TRUE(made.ok()) << made.status().message();
  EXPECT_EQ(flags.photos.front(), made->problem.image.file);
  EXPECT_EQ(flags.normals, made->problem.geometry.file);
  EXPECT_EQ(flags.mask, made->problem.image.mask);
  const StatusOr<Problem> again =
      ParseProblem("results/a b/problem.yaml", made->text, {});
  ASSERT_TRUE(again.ok()) << again.status().message();
  EXPECT_EQ(ProblemToJson(made->problem), ProblemToJson(*again));
}

TEST(ProblemFromFlags, RelativePathsFollowTheFolder) {
  ProblemFlags flags = Flags();
  flags.out = "a/b";
  StatusOr<FlagProblem> made = ProblemFromFlags(flags);
  ASSERT_TRUE(made.ok());
  EXPECT_NE(std::string::npos, made->text.find("\"../../photo.exr\""));
  flags.out = "/elsewhere";
  made = ProblemFromFlags(flags);
  ASSERT_TRUE(made.ok());
  EXPECT_EQ(fs::absolute("photo.exr").string(), made->problem.image.file);
}

TEST(ProblemFromFlags, PathsOfOverridesAreAsThoseOfFlags) {
  ProblemFlags flags = Flags();
  flags.overrides = {"reflectance.model=m.ibrdf", "image.mask=other.png"};
  StatusOr<FlagProblem> made = ProblemFromFlags(flags);
  ASSERT_TRUE(made.ok()) << made.status().message();
  EXPECT_EQ("m.ibrdf", made->problem.reflectance.model);
  EXPECT_EQ("other.png", made->problem.image.mask);
  flags.overrides = {"reflectance.model=default"};
  made = ProblemFromFlags(flags);
  ASSERT_TRUE(made.ok());
  EXPECT_EQ(std::string::npos, made->text.find("../default"));
}

TEST(ProblemFromFlags, PathsOfListsFollowTheFolderToo) {
  ProblemFlags flags = Flags();
  flags.photos = {"a.png"};
  flags.overrides = {"image.brackets=[b.png, /c.png]",
                     "image.bracket_exposures=[0.1, 10]"};
  const StatusOr<FlagProblem> made = ProblemFromFlags(flags);
  ASSERT_TRUE(made.ok()) << made.status().message();
  EXPECT_EQ((std::vector<std::string>{"b.png", "/c.png"}),
            made->problem.image.brackets);
  EXPECT_NE(std::string::npos, made->text.find("[\"../b.png\", \"/c.png\"]"));
}

TEST(ProblemFromFlags, NoShapeIsASphereAndSaysSo) {
  ProblemFlags flags = Flags();
  flags.normals.clear();
  const StatusOr<FlagProblem> made = ProblemFromFlags(flags);
  ASSERT_TRUE(made.ok()) << made.status().message();
  EXPECT_EQ(GeometryKind::kSphere, made->problem.geometry.kind);
  ASSERT_EQ(1u, made->notes.size());
  EXPECT_NE(std::string::npos, made->notes[0].find("sphere"));
}

TEST(ProblemFromFlags, ErrorsNameTheCommandLineAndTheKey) {
  ProblemFlags flags = Flags();
  flags.response = "linear, white: 3}";
  EXPECT_NE(std::string::npos,
            ErrorOf(flags).find("command line: image.response: expected"));
  flags = Flags();
  flags.mesh = "m.obj";
  EXPECT_NE(std::string::npos,
            ErrorOf(flags).find("expected one of sphere, mesh, normals"));
  flags = Flags();
  flags.overrides = {"solver.second=3"};
  EXPECT_NE(std::string::npos, ErrorOf(flags).find("solver.second"));
  flags = Flags();
  flags.overrides = {"solver"};
  EXPECT_NE(std::string::npos, ErrorOf(flags).find("key.path=value"));
  flags = Flags();
  flags.photos = {"\xff.exr"};
  EXPECT_NE(std::string::npos, ErrorOf(flags).find("UTF-8"));
  EXPECT_NE(std::string::npos, ErrorOf({}).find("expected a photograph"));
}

TEST(ProblemFromFlags, AnOptionIsTextAndNoYaml) {
  ProblemFlags flags = Flags();
  flags.mask = "~";
  const StatusOr<FlagProblem> made = ProblemFromFlags(flags);
  ASSERT_TRUE(made.ok()) << made.status().message();
  EXPECT_EQ("~", made->problem.image.mask);
}

TEST(ProblemFromFlags, TheCommandIsOneCommentLine) {
  ProblemFlags flags = Flags();
  flags.command =
      ShellCommand({"ibrdf_solve", "it's a\nphoto.exr", "--set", "a=b c"});
  EXPECT_EQ("ibrdf_solve 'it'\\''s a?photo.exr' --set 'a=b c'", flags.command);
  const StatusOr<FlagProblem> made = ProblemFromFlags(flags);
  ASSERT_TRUE(made.ok());
  EXPECT_EQ(0u, made->text.find("# Made by: " + flags.command + "\n"));
}

TEST(WriteFlagProblem, ReplacesItsOwnFilesAlone) {
  const TempDir folder;
  const std::string out = folder.path();
  ProblemFlags flags = Flags();
  flags.out = out;
  const StatusOr<FlagProblem> made = ProblemFromFlags(flags);
  ASSERT_TRUE(made.ok());
  EXPECT_TRUE(WriteFlagProblem(*made, out).ok());
  EXPECT_TRUE(WriteFlagProblem(*made, out).ok());
  const StatusOr<Problem> read = ReadProblem(out + "/problem.yaml", {});
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(ProblemToJson(made->problem), ProblemToJson(*read));
  std::ofstream(out + "/problem.yaml") << "image: {file: mine.exr}\n";
  EXPECT_EQ(StatusCode::kInvalidInput, WriteFlagProblem(*made, out).code());
}

TEST(WriteFlagProblem, AFolderBehindALinkGetsAbsolutePaths) {
  const TempDir folder;
  const fs::path before = fs::current_path();
  fs::create_directories(fs::path(folder.path()) / "real/deep");
  fs::create_directory(fs::path(folder.path()) / "work");
  fs::create_directory_symlink(fs::path(folder.path()) / "real/deep",
                               fs::path(folder.path()) / "work/link");
  fs::current_path(fs::path(folder.path()) / "work");
  ProblemFlags flags = Flags();
  flags.out = "link";
  const StatusOr<FlagProblem> made = ProblemFromFlags(flags);
  const std::string expected = fs::absolute("photo.exr").string();
  fs::current_path(before);
  ASSERT_TRUE(made.ok()) << made.status().message();
  EXPECT_EQ(expected, made->problem.image.file);
}

}  // namespace
}  // namespace ibrdf
