// Tests the program as a user starts it: exit statuses, what goes to stdout and to stderr, being killed.
#include "tests/support/program.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "flexura/base/version.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"
#include "tests/support/checkout.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;
using ::testing::StartsWith;

TEST_F(Program, RunsTheExperimentAndSaysWhereTheResultsAre) {
  const Ended ended = run("run " + paper_file);
  EXPECT_EQ(ended.status, 0);
  EXPECT_EQ(ended.out,
            "end effector: (-10.738, 5.201)\nresults: results/01_paper_arm\noutcome: bend: at the target "
            "shape after 5 s\n");
  EXPECT_THAT(ended.err, IsEmpty()) << "no progress line in a pipe";
  for (const char* file :
       {"experiment.toml", "log.mcap", "summary.json", "timing.json", "report.html", "figures/arm-end.svg"}) {
    EXPECT_TRUE(std::filesystem::exists(path("results/01_paper_arm/") + file)) << file;
  }
  EXPECT_THAT(run("run " + paper_file).out, HasSubstr("results: results/01_paper_arm-2\n"));
}

TEST_F(Program, PrintsALineOfEachThingWhateverItIsCalled) {
  const Ended ended = run("run " + paper_file + " --out 'two\nlines'");
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(
      ended.out,
      "end effector: (-10.738, 5.201)\nresults: two\\nlines\noutcome: bend: at the target shape after 5 s\n");
  EXPECT_TRUE(std::filesystem::exists(path("two\nlines/summary.json"))) << "the folder has the name itself";
  const std::string name = R"( --set 'task.0.name="bend\u009b2J\u2028"')";
  const Ended unsafe = run("check " + paper_file + name + " --set 'task.0.to={position=[30,0,0]}'");
  EXPECT_EQ(unsafe.status, 1);
  EXPECT_THAT(unsafe.out, HasSubstr("bend\\xc2\\x9b2J\\xe2\\x80\\xa8: target outside the workspace"));
}

TEST_F(Program, TasksThatNeedTwoCamerasSaySoInOneLine) {
  const std::string rig =
      "[arm]\nkind = \"spatial\"\n[[arm.section]]\nlength = 1\n[[camera]]\nname = \"only\"\nmount = { "
      "position = [0, 0.5, 2], look_at = [0, 0.5, 0] }\n[[task]]\nkind = ";
  write_new_file(path("servo.toml"), rig + "\"servo\"\n[[task.target]]\nbends = [[0.8, 0.3]]\n");
  const Ended servo = run("run servo.toml");
  EXPECT_EQ(servo.status, 2);
  EXPECT_EQ(servo.err, "servo.toml:8:1: task[0]: needs two cameras: expected a second [[camera]]\n");
  write_new_file(path("calibrate.toml"), rig + "\"calibrate\"\nmethod = \"arcs\"\n");
  const Ended calibrate = run("check calibrate.toml");
  EXPECT_EQ(calibrate.status, 2);
  EXPECT_THAT(calibrate.err, HasSubstr("task[0]: needs two cameras: expected a second [[camera]]\n"));
}

TEST_F(Program, PrintsOneJsonDocumentWhenAsked) {
  const Ended ended = run("run " + paper_file + " --json --out elsewhere --seed 5");
  EXPECT_EQ(ended.status, 0);
  const Node summary = parse_json(ended.out, "stdout");
  EXPECT_EQ(*summary.find("seed")->as<std::int64_t>(), 5);
  EXPECT_EQ(ended.err, "results: elsewhere\n");
  EXPECT_EQ(read_text_file(path("elsewhere/summary.json"), 1 << 20), ended.out);
}

TEST_F(Program, EndsWithOneWhenALimitWouldBeBroken) {
  const Ended ended = run("run " + paper_file + " --set arm.section.1.max_bend_deg=3");
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.err, HasSubstr("unsafe: 0.833333 s to 5 s: section 2: bend 18 deg, limit 3 deg\n"));
}

TEST_F(Program, ChecksWithoutRunning) {
  const Ended safe = run("check " + paper_file);
  EXPECT_EQ(safe.status, 0);
  EXPECT_EQ(safe.out, "note: 0 s: singular: the tip Jacobian has rank 1 of 2\nsafe\n");
  const Ended unsafe = run("check " + paper_file + " --json --set arm.section.1.max_bend_deg=3");
  EXPECT_EQ(unsafe.status, 1);
  const Node found = parse_json(unsafe.out, "stdout");
  EXPECT_FALSE(*found.find("safe")->as<bool>());
  const Node& violation = found.find("violations")->as<Node::Array>()->at(0);
  EXPECT_EQ(*violation.find("hazard")->as<std::string>(), "bend");
  EXPECT_EQ(*violation.find("section")->as<std::int64_t>(), 2);
  EXPECT_EQ(*violation.find("end")->as<double>(), 5.0);
  EXPECT_FALSE(std::filesystem::exists(path("results")));
}

TEST_F(Program, EndsWithOneWhenATargetIsOutsideTheWorkspace) {
  std::ofstream(path("reach.toml")) << "[[arm.section]]\nlength = 1\n[[arm.section]]\nlength = 0.5\n"
                                       "[[task]]\nkind = 'move'\nname = 'up'\nto.position = [0, 1.5, 0]\n";
  EXPECT_EQ(run("check reach.toml").status, 0);
  const Ended ended = run("check reach.toml --set task.0.to.position=[0,1.75,0]");
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.out,
              HasSubstr("unsafe: 0 s to 1 s: up: target outside the workspace, 250 mm from the nearest "
                        "pose\n"));
  EXPECT_EQ(run("run reach.toml --set task.0.to.position=[0,1.75,0]").status, 1);
}

TEST_F(Program, SaysWhereAnObstacleIsWrong) {
  std::ofstream(path("ball.toml")) << "[[arm.section]]\nlength = 1\n[[obstacle]]\nkind = 'sphere'\n"
                                      "center = [0, 0, 0]\nradius = -0.1\n[[task]]\nkind = 'hold'\n";
  const Ended ended = run("check ball.toml");
  EXPECT_EQ(ended.status, 2);
  EXPECT_THAT(ended.err, HasSubstr("ball.toml:6:10: obstacle[0].radius = -0.1: expected"));
}

TEST_F(Program, EndsWithTwoOnBadInputAndMakesNoResults) {
  for (const char* arguments : {"",
                                "fly",
                                "run",
                                "run none.toml",
                                "run . ",
                                "run --seed -1 x.toml",
                                "run --seed x x.toml",
                                "export . --to csv",
                                "export",
                                "export . --to pdf",
                                "schema --format yaml",
                                "fk none.toml",
                                "check",
                                "check none.toml",
                                "view none.toml",
                                "view .",
                                "view --port x",
                                "view --port 70000",
                                "view --address nowhere --no-browser",
                                "view --address 127.0.0.1.5 --no-browser",
                                "run x.toml --no-browser",
                                "--verson",
                                "-x check none.toml",
                                "view '' --no-browser",
                                "measure x.png --level ''",
                                "measure x.png --radius ''",
                                "measure x.png --figure ''",
                                "measure x.png --overlay ''",
                                "measure x.png --camera ''",
                                "measure x.png --threshold otsu --level 100",
                                "estimate a.png b.png --cameras c.toml --length ''",
                                "estimate a.png b.png --cameras c.toml --arm ''",
                                "intrinsics a.png --board 9x6 --square 0.02 --distortion ''",
                                "intrinsics a.png --board 9x6 --square 0.02 --out ''",
                                "render x.toml --camera front --out a.png --time ''",
                                "run x.toml --out ''"}) {
    const Ended ended = run(arguments);
    EXPECT_EQ(ended.status, 2) << arguments;
    EXPECT_THAT(ended.out, IsEmpty()) << arguments;
    EXPECT_EQ(std::ranges::count(ended.err, '\n'), 1) << arguments << ": " << ended.err;
  }
  EXPECT_THAT(run("chek x.toml").err, HasSubstr("unknown command \"chek\"; did you mean \"check\"?"));
  EXPECT_THAT(run("view --address nowhere --no-browser").err,
              HasSubstr("--address: \"nowhere\": expected an IP address of this machine"));
  EXPECT_THAT(run("--verson").err, HasSubstr("unknown option \"--verson\""));
  EXPECT_THAT(run("measure x.png --level ''").err,
              HasSubstr("--level: empty text: expected at least one character"));
  EXPECT_THAT(run("measure x.png --threshold otsu --level 100").err,
              HasSubstr("needs --threshold fixed: \"otsu\" computes its own level"));
  // The arguments after an option's numbers are not read as numbers.
  for (const char* before : {"estimate --base 0,0,0", "estimate --markers 0.2,0.4 --length 1"})
    EXPECT_THAT(run(std::string(before) + " a.png b.png --cameras c.toml").err, StartsWith("c.toml: "));
  EXPECT_EQ(run("run " + paper_file + " --set arm.section.0.length=nan").status, 2);
  EXPECT_FALSE(std::filesystem::exists(path("results")));
}

// A viewer that cannot print its address, and a file size limit, end the program like a full disk.
TEST_F(Program, WhatCannotBeWrittenEndsItWithAReason) {
  EXPECT_EQ(run("--version").status, 0);
  const Ended deaf = wait(start("view --no-browser --port 0", "/dev/full"));
  EXPECT_EQ(deaf.status, 3);
  EXPECT_THAT(deaf.err, HasSubstr("cannot write to the standard output"));
  before_ = "ulimit -f 8 && ";
  const Ended limited = run("run " + paper_file + " --out limited");
  EXPECT_EQ(limited.status, 3) << limited.err;
  EXPECT_THAT(limited.err, HasSubstr("cannot write"));
}

// A pseudo-terminal at which a program can be started, and what appeared on it.
class Terminal {
 public:
  Terminal() : screen_(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)) {
    if (screen_ < 0 || grantpt(screen_) != 0 || unlockpt(screen_) != 0) return;
    name_ = ptsname(screen_);
    end_ = open(name_.c_str(), O_RDWR | O_NOCTTY);  // Held open, so that written text stays readable.
  }
  ~Terminal() {
    if (end_ >= 0) close(end_);
    if (screen_ >= 0) close(screen_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  [[nodiscard]] bool is_there() const { return end_ >= 0; }
  [[nodiscard]] const std::string& name() const { return name_; }
  // Returns what is shown until the process has ended.
  [[nodiscard]] std::string shown_by(pid_t process) const {
    std::string text;
    for (bool has_ended = false;;) {
      std::array<char, 4096> part{};
      const ssize_t count = read(screen_, part.data(), part.size());
      if (count > 0) text.append(part.data(), static_cast<std::size_t>(count));
      if (count <= 0 && has_ended) return text;
      if (count <= 0) has_ended = waitpid(process, nullptr, WNOHANG) != 0;
      if (count <= 0 && !has_ended) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }

 private:
  int screen_ = -1;
  int end_ = -1;
  std::string name_;
};

TEST_F(Program, ShowsAPersonAtATerminalHowFarItIsAndNobodyElse) {
  const Terminal terminal;
  ASSERT_TRUE(terminal.is_there());
  const std::string shown = terminal.shown_by(start("run " + paper_file, path("out"), terminal.name()));
  // Each progress line overwrites the one before, and the last one is removed.
  const std::string cleared = "\r\x1b[K";
  EXPECT_THAT(shown, StartsWith(cleared + "  0 % [.............................."));
  EXPECT_THAT(shown, EndsWith(cleared));
  EXPECT_EQ(shown.find('\n'), std::string::npos) << shown;
  EXPECT_THAT(run("run " + paper_file).err, IsEmpty()) << "a file is no person";
}

TEST_F(Program, EndsWithThreeWhenTheSystemFails) {
  EXPECT_EQ(run("run " + paper_file + " --out /proc/here").status, 3);
  std::ofstream(path("out")) << "";
  EXPECT_EQ(wait(start("schema", "/dev/full")).status, 3);
}

TEST_F(Program, TellsItsVersionAndHelp) {
  EXPECT_EQ(run("--version").out, std::string(version()) + "\n");
  for (const char* command : {"", "run", "check", "fk", "export", "schema", "view"}) {
    const Ended ended = run(std::string(command) + " --help");
    EXPECT_EQ(ended.status, 0) << command;
    EXPECT_THAT(ended.out, HasSubstr("OPTIONS")) << command;
  }
  // An error after a command's name refers to that command's help.
  const Ended wrong = run("check --outt x " + paper_file);
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, HasSubstr("--outt"));
  EXPECT_THAT(wrong.err, HasSubstr("(see flexura check --help)"));
}

TEST_F(Program, LeavesALogThatReadsWhenKilled) {
  std::ofstream(path("long.toml"))
      << "record.report = false\nclock.step = 1e-3\n[[arm.section]]\nlength = 1\n[[task]]\nkind = 'move'\n"
         "duration = 900\nto.archings = [1]\n";
  const pid_t child = start("run long.toml", path("out"));
  const auto log = path("results/long/log.mcap");
  const auto big_enough = [&] {
    return std::filesystem::exists(log) && std::filesystem::file_size(log) > 1'500'000;
  };
  for (int i = 0; i < 3000 && !big_enough(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ASSERT_TRUE(big_enough());
  kill(child, SIGKILL);
  EXPECT_EQ(wait(child).status, 128 + SIGKILL);
  const Ended ended = run("export results/long --to csv");
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.err, HasSubstr("the run was interrupted"));
  const std::string states = read_text_file(path("results/long/csv/states.csv"), std::size_t{1} << 30);
  EXPECT_GT(std::ranges::count(states, '\n'), 1000);
}

TEST_F(Program, ExportsWhatADamagedLogHas) {
  std::ofstream(path("short.toml"))
      << "record.report = false\nclock.step = 1e-3\n[[arm.section]]\nlength = 1\n[[task]]\nkind = 'move'\n"
         "duration = 20\nto.archings = [1]\n";
  ASSERT_EQ(run("run short.toml").status, 0);
  const auto log = path("results/short/log.mcap");
  std::string bytes = read_text_file(log, std::size_t{1} << 30);
  bytes[bytes.size() / 2] ^= 1;
  std::ofstream(log, std::ios::binary) << bytes;
  const Ended ended = run("export results/short --to csv");
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.err, MatchesRegex("note: the log is damaged: its messages from [0-9.]+ to [0-9.]+ s are "
                                      "missing .*\n"));
  const std::string states = read_text_file(path("results/short/csv/states.csv"), std::size_t{1} << 30);
  const auto rows = std::ranges::count(states, '\n');
  EXPECT_GT(rows, 1000);
  EXPECT_LT(rows, 20000);
  std::ofstream(log).close();
  const Ended empty = run("export results/short --to csv");
  EXPECT_EQ(empty.status, 2);
  EXPECT_THAT(empty.err, HasSubstr("log.mcap: has no messages: its run was interrupted at the start"));
}

TEST_F(Program, ReferencePageIsTheOneItPrints) {
  EXPECT_EQ(read_text_file(checkout_file("docs/experiment-file.md"), 1 << 20),
            run("schema --format markdown").out)
      << "make it anew: flexura schema --format markdown >docs/experiment-file.md";
  EXPECT_EQ(read_text_file(checkout_file("docs/campaign-file.md"), 1 << 20),
            run("schema --format markdown --of campaign").out)
      << "make it anew: flexura schema --format markdown --of campaign >docs/campaign-file.md";
}

}  // namespace
}  // namespace flexura
