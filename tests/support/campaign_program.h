#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/campaign_files.h"
#include "tests/support/program.h"
#include "tests/support/random_cases.h"

namespace flexura {

/// Runs `flexura campaign` in a folder with a campaign of quick runs.
class CampaignProgram : public Program {
 protected:
  CampaignProgram() {
    std::ofstream(path("bow.toml")) << bow_text;
    std::ofstream(path("campaign.toml")) << bow_campaign_text;
  }

  /// Kills a campaign `kills` times at random moments, and compares its rows with those of an undisturbed
  /// one. A campaign that ends before its kill is followed by a new one.
  void check_kills(int kills) {
    const std::string campaign = "campaign campaign.toml --set samples=1500";
    ASSERT_EQ(run(campaign + " --out whole.db --workers 1").status, 0);
    const std::string whole = rows_text(path("whole.db"));
    int killed = 0;
    TestRandom random(case_seed(0));
    for (int file = 0; killed < kills; ++file) {
      ASSERT_LT(file, 20 * kills);
      const std::string name = "killed-" + std::to_string(file) + ".db";
      for (int call = 0; call < 100; ++call) {
        const pid_t child = start(campaign + " --out " + name + " --workers 2", path("out"));
        std::this_thread::sleep_for(std::chrono::microseconds(random.integer(0, 400000)));
        ::kill(child, SIGKILL);
        const Ended ended = wait(child);
        if (ended.status == 0) break;
        ASSERT_EQ(ended.status, 128 + SIGKILL) << ended.err;
        ++killed;
      }
      ASSERT_EQ(run(campaign + " --out " + name).status, 0);
      ASSERT_EQ(rows_text(path(name)), whole);
    }
  }

  /// Kills the program of two ranks at random moments: one rank, both, or mpirun itself. Compares the rows
  /// with those of an undisturbed campaign. No call may hang: a killed rank ends all others.
  void check_kills_of_ranks(int kills) {
    const std::string campaign = "campaign campaign.toml --set samples=1500";
    ASSERT_EQ(run(campaign + " --out whole.db --workers 1").status, 0);
    const std::string whole = rows_text(path("whole.db"));
    int killed = 0;
    TestRandom random(case_seed(0));
    for (int file = 0; killed < kills; ++file) {
      ASSERT_LT(file, 20 * kills);
      const std::string name = "ranks-" + std::to_string(file) + ".db";
      for (int call = 0; call < 100; ++call) {
        const pid_t mpirun = start_ranks(2, campaign + " --out " + name);
        // Starting MPI takes about half a second.
        std::this_thread::sleep_for(std::chrono::microseconds(random.integer(0, 1500000)));
        const std::vector<pid_t> ranks = children_of(mpirun);
        const int victim = random.integer(0, static_cast<int>(ranks.size()));
        ::kill(victim == 0 ? mpirun : ranks.at(static_cast<std::size_t>(victim) - 1), SIGKILL);
        const std::optional<Ended> ended = wait_for(mpirun, ranks);
        ASSERT_TRUE(ended) << "hangs after the end of " << (victim == 0 ? "mpirun" : "a rank");
        if (ended->status == 0) break;
        ++killed;
      }
      ASSERT_EQ(run(campaign + " --out " + name).status, 0);
      ASSERT_EQ(rows_text(path(name)), whole);
    }
  }

  /// Returns the processes that a process has started.
  static std::vector<pid_t> children_of(pid_t parent) {
    std::vector<pid_t> children;
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
      std::ifstream stat(entry.path() / "stat");
      std::string text;
      if (!std::getline(stat, text)) continue;
      std::istringstream rest(text.substr(text.rfind(')') + 1));
      std::string state;
      pid_t of = 0;
      if (rest >> state >> of && of == parent && state != "Z")
        children.push_back(static_cast<pid_t>(std::stol(entry.path().filename().string())));
    }
    return children;
  }

  /// Waits for mpirun and its ranks. Kills them all and returns std::nullopt if the ranks do not end. An
  /// mpirun that stays after the end of a rank is killed, as a user would do: Open MPI 4.1 sometimes hangs
  /// there, after it has printed its message. The other ranks must then end by themselves.
  std::optional<Ended> wait_for(pid_t mpirun, const std::vector<pid_t>& ranks) {
    constexpr int patience = 1200;  // Of 50 ms.
    const auto lives = [](pid_t process) { return ::kill(process, 0) == 0; };
    for (int i = 0; i < patience; ++i) {
      // The state of a child that has ended stays until wait().
      siginfo_t info{};
      ::waitid(P_PID, static_cast<id_t>(mpirun), &info, WEXITED | WNOHANG | WNOWAIT);
      if (info.si_pid == mpirun && std::ranges::none_of(ranks, lives)) return wait(mpirun);
      if (i == patience / 2 && info.si_pid != mpirun) ::kill(mpirun, SIGKILL);
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    for (const pid_t rank : ranks) ::kill(rank, SIGKILL);
    ::kill(mpirun, SIGKILL);
    (void)wait(mpirun);
    return std::nullopt;
  }

  /// Starts `ranks` ranks through mpirun, which becomes the returned process.
  pid_t start_ranks(int ranks, const std::string& arguments) {
    const std::string command = "cd " + path("") +
                                // Open MPI does not release all of its memory.
                                " && export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
                                "LSAN_OPTIONS=detect_leaks=0 && "
                                "exec mpirun --oversubscribe -n " +
                                std::to_string(ranks) + " " + program + " " + arguments +
                                " >out 2>err </dev/null";
    const pid_t child = fork();
    if (child == 0) {
      execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
      _exit(127);
    }
    return child;
  }
  Ended run_ranks(int ranks, const std::string& arguments) { return wait(start_ranks(ranks, arguments)); }

  /// Returns whether the machine and the program have MPI that can be tested.
  bool has_mpi() {
#if defined(__SANITIZE_THREAD__)
    return false;  // ThreadSanitizer cannot see into the packaged library, and reports its locks as races.
#else
    return std::system("command -v mpirun >/dev/null") == 0 &&
           run_ranks(1, "campaign campaign.toml --dry-run").err.find("built without MPI") ==
               std::string::npos;
#endif
  }
};

}  // namespace flexura
