// The program as a user starts it: exit statuses, what goes to stdout and what to stderr, and being killed.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "flexura/base/version.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"
#include "tests/support/raw_client.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string program = FLEXURA_BINARY_DIR "/bin/flexura";
const std::string paper_file = FLEXURA_SOURCE_DIR "/examples/01_paper_arm/experiment.toml";

struct Ended {
  int status = -1;
  std::string out;
  std::string err;
};

class Program : public ::testing::Test {
 protected:
  // Starts the program in the test's folder; arguments are given as a person types them, without quoting.
  pid_t start(const std::string& arguments, const std::string& out) {
    const std::string err = path("err");
    const pid_t child = fork();
    if (child == 0) {
      const std::string command = "cd " + folder_.path().string() + " && exec " + program + " " + arguments +
                                  " >" + out + " 2>" + err + " </dev/null";
      execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
      _exit(127);
    }
    return child;
  }
  Ended wait(pid_t child) {
    int status = 0;
    waitpid(child, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
            read_text_file(path("out"), 1 << 24), read_text_file(path("err"), 1 << 24)};
  }
  Ended run(const std::string& arguments) { return wait(start(arguments, path("out"))); }
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  TemporaryFolder folder_;
};

TEST_F(Program, RunsTheExperimentAndSaysWhereTheResultsAre) {
  const Ended ended = run("run " + paper_file);
  EXPECT_EQ(ended.status, 0);
  EXPECT_EQ(ended.out, "end effector: (-10.738, 5.201)\nresults: results/01_paper_arm\n");
  EXPECT_THAT(ended.err, IsEmpty()) << "no progress line in a pipe";
  for (const char* file :
       {"experiment.toml", "log.mcap", "summary.json", "timing.json", "report.html", "figures/arm-end.svg"}) {
    EXPECT_TRUE(std::filesystem::exists(path("results/01_paper_arm/") + file)) << file;
  }
  EXPECT_THAT(run("run " + paper_file).out, HasSubstr("results: results/01_paper_arm-2\n"));
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
  EXPECT_EQ(safe.out, "note: 0 s: singular pose: the tip can set out in 1 of 2 dimensions\nsafe\n");
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
  for (const char* arguments :
       {"", "fly", "run", "run none.toml", "run . ", "run --seed -1 x.toml", "run --seed x x.toml",
        "export . --to csv", "export", "export . --to pdf", "schema --format yaml", "fk none.toml", "check",
        "check none.toml", "view none.toml", "view .", "view --port x", "view --port 70000",
        "run x.toml --no-browser"}) {
    const Ended ended = run(arguments);
    EXPECT_EQ(ended.status, 2) << arguments;
    EXPECT_THAT(ended.out, IsEmpty()) << arguments;
    EXPECT_EQ(std::ranges::count(ended.err, '\n'), 1) << arguments << ": " << ended.err;
  }
  EXPECT_THAT(run("chek x.toml").err, HasSubstr("there is no command \"chek\"; did you mean \"check\"?"));
  EXPECT_EQ(run("run " + paper_file + " --set arm.section.0.length=nan").status, 2);
  EXPECT_FALSE(std::filesystem::exists(path("results")));
}

TEST_F(Program, EndsWithThreeWhenTheSystemFails) {
  EXPECT_EQ(run("run " + paper_file + " --out /proc/here").status, 3);
  std::ofstream(path("out")) << "";
  EXPECT_EQ(wait(start("schema", "/dev/full")).status, 3);
}

// What a file says once it says something.
std::string told_in(const std::string& file) {
  for (int i = 0; i < 3000; ++i) {
    if (std::filesystem::exists(file)) {
      std::string text = read_text_file(file, 1 << 24);
      if (text.ends_with('\n')) return text;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return "nothing";
}

TEST_F(Program, ServesAViewerUntilItIsTold) {
  for (const int signal : {SIGINT, SIGTERM}) {
    std::filesystem::remove(path("out"));
    const pid_t child = start("view --no-browser --port 0", path("out"));
    EXPECT_THAT(told_in(path("out")), HasSubstr("viewer: http://127.0.0.1:"));
    kill(child, signal);
    EXPECT_EQ(wait(child).status, 0);
  }
}

TEST_F(Program, KeepsTheTokenOfAPortWhenItIsStartedAgain) {
  // What a viewer prints, started once and ended.
  const auto printed = [this](const std::string& options) {
    std::filesystem::remove(path("out"));
    const pid_t child = start("view --no-browser " + options, path("out"));
    std::string text = told_in(path("out"));
    kill(child, SIGTERM);
    EXPECT_EQ(wait(child).status, 0);
    return text;
  };
  std::filesystem::create_directory(path("runtime"));
  setenv("XDG_RUNTIME_DIR", path("runtime").c_str(), 1);
  const std::string any = printed("--port 0");
  EXPECT_FALSE(std::filesystem::exists(path("runtime/flexura")));
  const std::size_t at = any.find("127.0.0.1:") + 10;
  const std::string port = any.substr(at, any.find('/', at) - at);
  const std::string first = printed("--port " + port);
  EXPECT_NE(first, any);
  EXPECT_EQ(printed("--port " + port), first);
  std::filesystem::permissions(path("runtime/flexura"), std::filesystem::perms::others_exec,
                               std::filesystem::perm_options::add);
  EXPECT_NE(printed("--port " + port), first);
  unsetenv("XDG_RUNTIME_DIR");
}

TEST_F(Program, ServesWhatARunLeft) {
  EXPECT_EQ(run("run " + paper_file + " --out results").status, 0);
  const Ended of_the_log = run("view results/log.mcap --no-browser");
  EXPECT_EQ(of_the_log.status, 2);
  EXPECT_THAT(of_the_log.err, HasSubstr("expected the folder in which it lies"));
  std::filesystem::remove(path("out"));
  const pid_t child = start("view results --no-browser --port 0", path("out"));
  EXPECT_THAT(told_in(path("out")), HasSubstr("viewer: "));
  kill(child, SIGTERM);
  EXPECT_EQ(wait(child).status, 0);
}

// A page as far as the program sees: it asks for both cameras' pictures and looks until the run is over.
struct Look {
  int running_states = 0;
  int pictures = 0;
};

Look look_at_run(const std::string& printed) {
  const std::size_t at = printed.find("127.0.0.1:") + 10;
  const std::size_t token = printed.find("#token=") + 7;
  const std::string port = printed.substr(at, printed.find('/', at) - at);
  RawClient client(static_cast<std::uint16_t>(std::stoi(port)));
  client.send("GET /socket HTTP/1.1\r\nHost: localhost:" + port + "\r\nAuthorization: Bearer " +
              printed.substr(token, 32) +
              "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
              "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
  EXPECT_EQ(client.read_answer().status, 101);
  for (const char* camera : {"front", "side"})
    client.say(std::string(R"({"id":1,"do":"images","rate":30,"camera":")") + camera + "\"}");
  Look look;
  while (true) {
    const RawFrame frame = client.read_frame();
    if (frame.opcode == 0 || frame.payload.find("\"done\":true") != std::string::npos) return look;
    if (frame.opcode != 2) continue;
    constexpr unsigned running = 2;
    const bool is_image = frame.payload[0] == 2;
    if (!is_image) look.running_states += (static_cast<unsigned>(frame.payload[1]) & running) != 0 ? 1 : 0;
    if (!is_image) continue;
    ++look.pictures;
    const unsigned number =
        static_cast<unsigned char>(frame.payload[4]) + 256U * static_cast<unsigned char>(frame.payload[5]);
    client.say(R"({"do":"ack","camera":")" + std::string(frame.payload[1] == 0 ? "front" : "side") +
               R"(","number":)" + std::to_string(number) + "}");
  }
}

// The files of a run's results, but for the one of the wall clock.
std::vector<std::filesystem::path> results_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() && entry.path().filename() != "timing.json")
      files.push_back(entry.path().lexically_relative(folder));
  }
  return files;
}

TEST_F(Program, RunsToTheSameBytesWhenItIsViewed) {
  std::ofstream(path("long.toml"))
      << "[clock]\nstep = 1e-3\n[arm]\nkind = 'spatial'\n[[arm.section]]\nlength = 1\n"
         "[[camera]]\nname = 'front'\nmount = { position = [0, 0.5, 2], look_at = [0, 0.5, 0] }\n"
         "[[camera]]\nname = 'side'\nmount = { position = [-2, 0.5, 0], look_at = [0, 0.5, 0] }\n"
         "[[task]]\nkind = 'move'\nduration = 30\nto.bends = [[0.8, 0.5]]\n";
  EXPECT_EQ(run("run long.toml --out alone").status, 0);
  std::filesystem::remove(path("out"));
  const pid_t child = start("run long.toml --out viewed --view --no-browser --port 0", path("out"));
  const Look look = look_at_run(told_in(path("out")));
  EXPECT_GT(look.running_states, 0);
  EXPECT_GT(look.pictures, 0);
  kill(child, SIGTERM);
  const Ended ended = wait(child);
  EXPECT_EQ(ended.status, 0);
  EXPECT_THAT(ended.out, HasSubstr("results: viewed\n"));
  const auto files = results_in(path("alone"));
  EXPECT_GE(files.size(), 5);
  EXPECT_THAT(results_in(path("viewed")), ::testing::UnorderedElementsAreArray(files));
  for (const auto& file : files) {
    EXPECT_EQ(read_text_file(std::filesystem::path(path("alone")) / file, 1 << 28),
              read_text_file(std::filesystem::path(path("viewed")) / file, 1 << 28))
        << file;
  }
}

TEST_F(Program, EndsAViewedRunEarlyWhenItIsTold) {
  std::ofstream(path("long.toml"))
      << "[[arm.section]]\nlength = 1\n[[task]]\nkind = 'hold'\nduration = 19000\n";
  const pid_t child = start("run long.toml --out long --view --no-browser --port 0", path("out"));
  EXPECT_THAT(told_in(path("out")), HasSubstr("viewer: "));
  kill(child, SIGINT);
  EXPECT_EQ(wait(child).status, 1);
  EXPECT_THAT(read_text_file(path("long/summary.json"), 1 << 20), HasSubstr("\"outcome\": \"cancelled\""));
}

TEST_F(Program, TellsItsVersionAndHelp) {
  EXPECT_EQ(run("--version").out, std::string(version()) + "\n");
  for (const char* command : {"", "run", "check", "fk", "export", "schema", "view"}) {
    const Ended ended = run(std::string(command) + " --help");
    EXPECT_EQ(ended.status, 0) << command;
    EXPECT_THAT(ended.out, HasSubstr("OPTIONS")) << command;
  }
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
  EXPECT_THAT(ended.err, HasSubstr("the run was cut short"));
  const std::string states = read_text_file(path("results/long/csv/states.csv"), std::size_t{1} << 30);
  EXPECT_GT(std::ranges::count(states, '\n'), 1000);
}

TEST_F(Program, ReferencePageIsTheOneItPrints) {
  EXPECT_EQ(read_text_file(FLEXURA_SOURCE_DIR "/docs/experiment-file.md", 1 << 20),
            run("schema --format markdown").out)
      << "make it anew: flexura schema --format markdown >docs/experiment-file.md";
}

}  // namespace
}  // namespace flexura
