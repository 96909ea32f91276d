// Calibrates random simulated rigs by each method, pictures and all, and prints how well: paper_study
// [TRIALS] [SEED] [PRINTED]: so many trials of the methods that are meant to succeed, and PRINTED ones of the
// paper's as printed, which take ten times as long. docs/studies/calibration.md
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/calibration_bench.h"
#include "tests/support/loop_files.h"

namespace flexura {
namespace {

struct Ending {
  bool is_done = false;
  std::string reason;
  double pictures = 0;  // A camera.
  double angle = 0, aim = 0, zoom = 0;
};

// The reason without its numbers and names, to be counted.
std::string kind_of(const std::string& reason) {
  static const std::vector<std::string> kinds = {"back and forth", "runs away",      "two red axes",
                                                 "limit of",       "out of view",    "cannot have all",
                                                 "no red axis",    "not verified",   "no circle's arc",
                                                 "does not see",   "correlation is", "ends"};
  for (const std::string& kind : kinds)
    if (reason.find(kind) != std::string::npos) return kind;
  return reason.substr(0, reason.find(';'));
}

Ending run_one(const std::string& method, std::uint64_t seed) {
  TestRandom random(seed);
  WrongRig wrong = wrong_rig(random);
  // `bundle` learns the principal point; the others cannot see it.
  constexpr double rougher = 10;
  if (method == "bundle")
    for (WrongStart* start : {&wrong.front, &wrong.side}) start->cx *= rougher, start->cy *= rougher;
  const std::string task = "method = \"" + method + "\"\n";
  const bool has_arm = !method.starts_with("etalon");
  const LoopRig cameras = arcs_cameras({wrong.front, wrong.side}, method == "arcs-paper");
  CalibrationBench bench(has_arm ? arcs_rig(task, cameras, wrong.longer)
                                 : etalon_rig(task, {.wrong = {wrong.front, wrong.side}}));
  RigPorts ports = bench.ports();
  WrongArm arm(*ports.arm, wrong.gains);
  if (has_arm) ports.arm = &arm;
  Ending ending;
  if (method == "bundle") {
    const RigSessionResult result = bench.calibrate_bundle(ports);
    ending.is_done = result.is_done, ending.reason = result.reason;
    ending.pictures = 0.5 * static_cast<double>(result.pictures[0] + result.pictures[1]);
    if (!result.is_done) return ending;
    const RigRemainder left = bench.truth(result.target);
    ending.angle = left.angle, ending.zoom = left.zoom_ratio - 1;
    ending.aim = std::max(left.aim[0].norm(), left.aim[1].norm());
    return ending;
  }
  const LoopResult result = bench.calibrate(ports);
  ending.is_done = result.is_done, ending.reason = result.reason;
  ending.pictures = 0.5 * static_cast<double>(result.pictures[0] + result.pictures[1]);
  if (!result.is_done) return ending;
  const RigRemainder left = bench.truth(result);
  ending.angle = left.angle, ending.zoom = left.zoom_ratio - 1;
  ending.aim = std::max(left.aim[0].norm(), left.aim[1].norm());
  return ending;
}

double share_95(std::vector<double> sizes) {
  for (double& size : sizes) size = std::abs(size);
  std::ranges::sort(sizes);
  return sizes[static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(sizes.size()))) - 1];
}
double middle_of(std::vector<double> sizes) {
  for (double& size : sizes) size = std::abs(size);
  std::ranges::sort(sizes);
  return sizes[sizes.size() / 2];
}

void print_row(const std::string& method, std::size_t trials, std::uint64_t seed,
               std::map<std::string, std::map<std::string, int>>& failures) {
  std::vector<Ending> endings(trials);
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < trials; i = next++) endings[i] = run_one(method, seed * 1000003 + i);
  };
  std::vector<std::thread> threads;
  for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  std::vector<double> pictures, angle, aim, zoom;
  for (const Ending& one : endings) {
    if (!one.is_done) {
      ++failures[method][kind_of(one.reason)];
      continue;
    }
    pictures.push_back(one.pictures), angle.push_back(one.angle), aim.push_back(one.aim),
        zoom.push_back(one.zoom);
  }
  fmt::print("| `{}` | {} of {} |", method, pictures.size(), trials);
  if (pictures.empty()) {
    fmt::print(" - | - | - | - | - | - |\n");
    return;
  }
  constexpr double in_degrees = 180 / std::numbers::pi;
  fmt::print(" {:.1f} | {:.3f} | {:.3f} | {:.1f} | {:.1f} | {:.2f} |\n", middle_of(pictures),
             middle_of(angle) * in_degrees, share_95(angle) * in_degrees, middle_of(aim) * 1e3,
             share_95(aim) * 1e3, share_95(zoom) * 100);
}

}  // namespace
}  // namespace flexura

int main(int argc, char** argv) {
  using namespace flexura;
  const auto trials = static_cast<std::size_t>(argc > 1 ? std::atoi(argv[1]) : 20);
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  std::map<std::string, std::map<std::string, int>> failures;
  fmt::print(
      "| method | done | pictures a camera, median | axes from 90 deg, median | 95 % | aim, mm, median | 95 "
      "% | zoom "
      "ratio from 1, %, 95 % |\n| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
  const auto printed = static_cast<std::size_t>(argc > 3 ? std::atoi(argv[3]) : 20);
  for (const std::string method : {"bundle", "etalon", "arcs", "etalon-paper", "arcs-paper"}) {
    print_row(method, method.ends_with("-paper") ? printed : trials, seed, failures);
    std::fflush(stdout);
  }
  fmt::print("\n");
  for (const auto& [method, kinds] : failures) {
    fmt::print("`{}` stopped:", method);
    const char* before = " ";
    for (const auto& [kind, count] : kinds) fmt::print("{}{} x \"{}\"", before, count, kind), before = ", ";
    fmt::print(".\n");
  }
  return 0;
}
