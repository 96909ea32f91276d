// Tests the viewer as a user starts it: what it opens, what it leaves behind, and when it ends.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "flexura/app/view.h"
#include "flexura/store/gzip.h"
#include "flexura/store/text_file.h"
#include "tests/support/campaign_program.h"
#include "tests/support/program.h"
#include "tests/support/raw_client.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

class ViewerProgram : public Program {};

TEST_F(ViewerProgram, ServesAViewerUntilItIsTold) {
  for (const int signal : {SIGINT, SIGTERM}) {
    std::filesystem::remove(path("out"));
    const pid_t child = start("view --no-browser --port 0", path("out"));
    EXPECT_THAT(reported_in(path("out")), HasSubstr("viewer: http://127.0.0.1:"));
    kill(child, signal);
    EXPECT_EQ(wait(child).status, 0);
  }
}

// Sets an environment variable for its own lifetime.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    setenv(name, value.c_str(), 1);
  }
  ~Variable() {
    if (before_) {
      setenv(name_, before_->c_str(), 1);
    } else {
      unsetenv(name_);
    }
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

// A stand-in for the desktop's opener writes the argument that it gets and the contents of that file.
TEST_F(ViewerProgram, OpensTheBrowserUnlessItIsToldNotTo) {
  std::filesystem::create_directory(path("bin"));
  std::ofstream(path("bin/xdg-open")) << "#!/bin/sh\n{ echo \"$1\"; cat \"$1\"; } > " << path("opened")
                                      << ".part\nmv " << path("opened") << ".part " << path("opened") << "\n";
  std::filesystem::permissions(path("bin/xdg-open"), std::filesystem::perms::owner_all);
  const Variable search("PATH", path("bin") + ":" + std::getenv("PATH"));
  const Variable other_screen("WAYLAND_DISPLAY", "");
  const auto opened_by = [&](const std::string& options) {
    std::filesystem::remove(path("out"));
    std::filesystem::remove(path("opened"));
    const pid_t child = start("view --port 0 " + options, path("out"));
    const std::string printed = reported_in(path("out"));
    const bool is_expected = options.empty();
    // If no file is expected, wait for a while in which it would appear.
    for (int i = 0; i < (is_expected ? 3000 : 10) && !std::filesystem::exists(path("opened")); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    kill(child, SIGTERM);
    EXPECT_EQ(wait(child).status, 0);
    const std::string opened =
        std::filesystem::exists(path("opened")) ? read_text_file(path("opened"), 1 << 20) : "";
    return std::pair(printed, opened);
  };
  const Variable screen("DISPLAY", ":0");
  const auto [printed, opened] = opened_by("");
  const std::string url = printed.substr(8, printed.find('\n') - 8);
  EXPECT_THAT(opened, HasSubstr("location.replace(\"" + url + "\")")) << "the page leads to the viewer";
  const std::string file = opened.substr(0, opened.find('\n'));
  EXPECT_THAT(file, ::testing::EndsWith(".html"));
  EXPECT_THAT(file, ::testing::Not(HasSubstr("token"))) << "others can read the list of processes";
  EXPECT_FALSE(std::filesystem::exists(file)) << "it goes with the viewer";
  EXPECT_EQ(opened_by("--no-browser").second, "");
  const Variable no_screen("DISPLAY", "");
  EXPECT_EQ(opened_by("--name localhost").second, "") << "no screen, no browser";
}

TEST_F(ViewerProgram, RefusesANameByWhichNobodyCanCallIt) {
  for (const char* name : {"''", "'a b'", "x:99999", "http://x"}) {
    for (const std::string& command : {std::string("view "), "run " + paper_file + " --view "}) {
      const Ended ended = run(command + "--no-browser --port 0 --name " + name);
      EXPECT_EQ(ended.status, 2) << command << name;
      EXPECT_THAT(ended.err, HasSubstr("--name: ")) << name;
      const bool is_empty = std::string_view(name) == "''";
      EXPECT_THAT(ended.err, HasSubstr(is_empty ? "empty text: expected at least one character"
                                                : "expected a host name or IP address"))
          << name;
      EXPECT_EQ(std::ranges::count(ended.err, '\n'), 1) << ended.err;
    }
  }
}

TEST_F(ViewerProgram, ServesWhatARunLeft) {
  EXPECT_EQ(run("run " + paper_file + " --out results").status, 0);
  const Ended of_the_log = run("view results/log.mcap --no-browser");
  EXPECT_EQ(of_the_log.status, 2);
  EXPECT_THAT(of_the_log.err, HasSubstr("expected the results folder"));
  std::filesystem::remove(path("out"));
  const pid_t child = start("view results --no-browser --port 0", path("out"));
  EXPECT_THAT(reported_in(path("out")), HasSubstr("viewer: "));
  kill(child, SIGTERM);
  EXPECT_EQ(wait(child).status, 0);
}

TEST_F(ViewerProgram, ServesPictureFiles) {
  std::ofstream(path("a.pgm")) << "P2\n3 2\n255\n0 1 2 3 4 5\n";
  for (const char* files : {"a.pgm", "a.pgm ./a.pgm"}) {
    std::filesystem::remove(path("out"));
    const pid_t child = start(std::string("view --no-browser --port 0 ") + files, path("out"));
    EXPECT_THAT(reported_in(path("out")), HasSubstr("viewer: ")) << files;
    kill(child, SIGTERM);
    EXPECT_EQ(wait(child).status, 0);
  }
  // Several files must all be pictures.
  for (const std::string& files :
       {"a.pgm " + paper_file, std::string("a.pgm missing.png"), std::string("a.pgm .")}) {
    const Ended ended = run("view --no-browser --port 0 " + files);
    EXPECT_EQ(ended.status, 2) << files;
    EXPECT_EQ(std::ranges::count(ended.err, '\n'), 1) << ended.err;
  }
  std::ofstream(path("cut.png"), std::ios::binary) << std::string("\x89PNG\r\n\x1a\n\0\0", 10);
  EXPECT_EQ(run("view --no-browser cut.png").status, 2);
}

// Returns the port in the address that a viewer prints.
std::string port_in(const std::string& printed) {
  const std::size_t at = printed.find("127.0.0.1:") + 10;
  return printed.substr(at, printed.find('/', at) - at);
}

TEST_F(ViewerProgram, ServesThePageOrSaysThatItHasNone) {
  const pid_t child = start("view --no-browser --port 0", path("out"));
  const std::string port = port_in(reported_in(path("out")));
  RawClient client(static_cast<std::uint16_t>(std::stoi(port)));
  client.send("GET / HTTP/1.1\r\nHost: localhost:" + port + "\r\n\r\n");
  const RawAnswer answer = client.read_answer();
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.fields.at("content-encoding"), "gzip");
  const auto says_why = gzip(no_page_text);
  const bool is_built_without = answer.body == std::string(says_why.begin(), says_why.end());
  EXPECT_EQ(answer.fields.at("content-type"),
            is_built_without ? "text/plain; charset=utf-8" : "text/html; charset=utf-8");
  kill(child, SIGTERM);
  EXPECT_EQ(wait(child).status, 0);
}

TEST_F(CampaignProgram, IsViewedWithItsReport) {
  EXPECT_EQ(run("campaign campaign.toml --out a.db").status, 0);
  std::filesystem::copy_file(path("a.db"), path("other_name"));
  std::ofstream(path("text.db")) << "no file of SQLite";
  const Ended refused = run("view text.db --no-browser");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("not the results of a campaign"));
  for (const char* file : {"a.db", "other_name"}) {
    std::filesystem::remove(path("out"));
    const pid_t child = start(std::string("view --no-browser --port 0 ") + file, path("out"));
    const std::string printed = reported_in(path("out"));
    const std::string port = port_in(printed);
    RawClient client(static_cast<std::uint16_t>(std::stoi(port)));
    client.send("GET /report HTTP/1.1\r\nHost: localhost:" + port + "\r\nAuthorization: Bearer " +
                printed.substr(printed.find("#token=") + 7, 32) + "\r\n\r\n");
    const RawAnswer answer = client.read_answer();
    EXPECT_EQ(answer.status, 200);
    EXPECT_THAT(answer.body, HasSubstr("Complete: all 60 runs are done"));
    EXPECT_THAT(answer.body, HasSubstr(std::string("flexura run --from ") + file + " --row "));
    kill(child, SIGTERM);
    EXPECT_EQ(wait(child).status, 0);
  }
}

// Acts like the page: requests both cameras' pictures and watches until the run is over.
struct Look {
  int running_states = 0;
  int pictures = 0;
};

Look look_at_run(const std::string& printed) {
  const std::size_t token = printed.find("#token=") + 7;
  const std::string port = port_in(printed);
  RawClient client(static_cast<std::uint16_t>(std::stoi(port)));
  client.send("GET /socket HTTP/1.1\r\nHost: localhost:" + port + "\r\nAuthorization: Bearer " +
              printed.substr(token, 32) +
              "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
              "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
  EXPECT_EQ(client.read_answer().status, 101);
  for (const char* camera : {"front", "side"})
    client.send_text(std::string(R"({"id":1,"do":"images","rate":30,"camera":")") + camera + "\"}");
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
    client.send_text(R"({"do":"ack","camera":")" + std::string(frame.payload[1] == 0 ? "front" : "side") +
                     R"(","number":)" + std::to_string(number) + "}");
  }
}

// Returns the files of a run's results, except that of wall-clock times.
std::vector<std::filesystem::path> results_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() && entry.path().filename() != "timing.json")
      files.push_back(entry.path().lexically_relative(folder));
  }
  return files;
}

TEST_F(ViewerProgram, RunsToTheSameBytesWhenItIsViewed) {
  std::ofstream(path("long.toml"))
      << "[clock]\nstep = 1e-3\n[arm]\nkind = 'spatial'\n[[arm.section]]\nlength = 1\n"
         "[[camera]]\nname = 'front'\nmount = { position = [0, 0.5, 2], look_at = [0, 0.5, 0] }\n"
         "[[camera]]\nname = 'side'\nmount = { position = [-2, 0.5, 0], look_at = [0, 0.5, 0] }\n"
         "[[task]]\nkind = 'move'\nduration = 30\nto.bends = [[0.8, 0.5]]\n";
  EXPECT_EQ(run("run long.toml --out alone").status, 0);
  std::filesystem::remove(path("out"));
  const pid_t child = start("run long.toml --out viewed --view --speed 0 --no-browser --port 0", path("out"));
  const Look look = look_at_run(reported_in(path("out")));
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

TEST_F(ViewerProgram, EndsAViewedRunEarlyWhenItIsTold) {
  std::ofstream(path("long.toml"))
      << "[[arm.section]]\nlength = 1\n[[task]]\nkind = 'hold'\nduration = 19000\n";
  const pid_t child = start("run long.toml --out long --view --no-browser --port 0", path("out"));
  EXPECT_THAT(reported_in(path("out")), HasSubstr("viewer: "));
  kill(child, SIGINT);
  EXPECT_EQ(wait(child).status, 1);
  EXPECT_THAT(read_text_file(path("long/summary.json"), 1 << 20), HasSubstr("\"outcome\": \"cancelled\""));
}

}  // namespace
}  // namespace flexura
