#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <thread>

#include "flexura/store/text_file.h"
#include "tests/support/checkout.h"
#include "tests/support/temporary_folder.h"

namespace flexura {

inline const std::string program = built_file("bin/flexura");
inline const std::string paper_file = checkout_file("examples/01_paper_arm/experiment.toml");

/// How a program ended, and what it said.
struct Ended {
  int status = -1;
  std::string out;
  std::string err;
};

/// The program as a user starts it, in a folder of the test's own.
class Program : public ::testing::Test {
 protected:
  // Starts the program in the test's folder; arguments are given as a person types them, without quoting.
  // What it says to people goes to the file or terminal `err`.
  pid_t start(const std::string& arguments, const std::string& out) {
    return start(arguments, out, path("err"));
  }
  pid_t start(const std::string& arguments, const std::string& out, const std::string& err) {
    const pid_t child = fork();
    if (child == 0) {
      const std::string command = "cd " + folder_.path().string() + " && " + before_ + "exec " + program +
                                  " " + arguments + " >" + out + " 2>" + err + " </dev/null";
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
  std::string before_;  ///< What the shell does before it becomes the program: "ulimit -f 8 && ".
};

/// What a file says once it says something.
inline std::string reported_in(const std::string& file) {
  for (int i = 0; i < 3000; ++i) {
    if (std::filesystem::exists(file)) {
      std::string text = read_text_file(file, 1 << 24);
      if (text.ends_with('\n')) return text;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return "nothing";
}

}  // namespace flexura
