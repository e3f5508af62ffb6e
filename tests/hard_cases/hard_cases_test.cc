// Every file of cases/ is a problem that tries to break the solver: its inputs
// are made, ibrdf_solve is run on it as a user would, and what must hold is
// checked. See README.md.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "tests/hard_cases/case_checks.h"
#include "tests/hard_cases/case_inputs.h"
#include "tests/support/temp_dir.h"

extern char** environ;

namespace ibrdf {
namespace {
namespace fs = std::filesystem;

// The limit of a run; sanitizers and loaded machines are slow.
constexpr std::chrono::seconds kPatience(600);

std::vector<std::string> CaseNames() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(IBRDF_HARD_CASES_DIR)) {
    if (entry.path().extension() == ".yaml") {
      names.push_back(entry.path().stem().string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

// Both outputs go to `log`. 128 + signal where one ended it.
int RunProgram(const std::vector<std::string>& arguments,
               const std::string& log) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(),
                                   O_CREAT | O_WRONLY | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  std::vector<char*> argv;
  for (const std::string& a : arguments) {
    argv.push_back(const_cast<char*>(a.c_str()));
  }
  argv.push_back(nullptr);
  pid_t pid = 0;
  const int error =
      posix_spawn(&pid, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return -1;
  const auto end = std::chrono::steady_clock::now() + kPatience;
  int status = 0;
  while (waitpid(pid, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > end) {
      kill(pid, SIGKILL);
      waitpid(pid, &status, 0);
      return 128 + SIGKILL;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

class HardCases : public ::testing::TestWithParam<std::string> {};

TEST_P(HardCases, Holds) {
  const YAML::Node c = YAML::LoadFile(std::string(IBRDF_HARD_CASES_DIR) + "/" +
                                      GetParam() + ".yaml");
  ExpectKnownKeys(
      c, {"why", "inputs", "problem", "options", "again", "holds", "plain"});
  ASSERT_TRUE(c["why"] && c["problem"] && c["holds"]["exit"]);
  const TempDir dir;
  for (const auto& entry : c["inputs"]) {
    const Status made =
        MakeInput(entry.second, dir.path(), entry.first.as<std::string>());
    ASSERT_TRUE(made.ok()) << made.message();
  }
  WriteBytes(dir.File("problem.yaml"), c["problem"].IsScalar()
                                           ? c["problem"].as<std::string>()
                                           : YAML::Dump(c["problem"]) + "\n");
  const auto solve = [&](const YAML::Node& options, const std::string& out) {
    std::vector<std::string> arguments = {
        c["plain"] ? IBRDF_PLAIN_SOLVE : IBRDF_SOLVE,
        "--problem",
        dir.File("problem.yaml"),
        "--out",
        dir.File(out),
        "--quiet"};
    bool threads = false;
    for (const YAML::Node& option : options) {
      arguments.push_back(option.as<std::string>());
      threads |= arguments.back() == "--threads";
    }
    if (!threads) arguments.insert(arguments.end(), {"--threads", "1"});
    CaseRun run;
    run.folder = dir.File(out);
    run.exit_status = RunProgram(arguments, dir.File(out + ".txt"));
    run.terminal = ReadBytes(dir.File(out + ".txt"));
    return run;
  };
  const CaseRun run = solve(c["options"], "out");
  CheckRun(c["holds"], c["problem"], run);
  if (c["again"]) CheckSameBits(run, solve(c["again"], "again"));
}

INSTANTIATE_TEST_SUITE_P(Catalogue, HardCases, ::testing::ValuesIn(CaseNames()),
                         [](const auto& i) { return i.param; });

TEST(HardCaseCatalogue, IsLarge) { EXPECT_GE(CaseNames().size(), 80u); }

}  // namespace
}  // namespace ibrdf
