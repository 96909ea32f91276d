// Servos one simulated arm for days between two repeated target shapes and prints errors and memory use for
// each hour: endurance_study [HOURS] [SEED]. See docs/studies/endurance.md.
#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "flexura/servo/servo_session.h"
#include "tests/support/random_cases.h"
#include "tests/support/servo_bench.h"

namespace flexura {
namespace {

constexpr int slices = 24;  // Number of rows of the table; one hour each in a run of a day.
// Period of the repeated targets and rest time in each, s: 3 s at rest, 2 s of motion to the other shape, and
// back.
constexpr double period = 10, rest = 3;

// Heap in use (heap_in_use) and resident memory of the process (resident), bytes.
double heap_in_use() {
  const auto info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}
double resident() {
  std::ifstream file("/proc/self/statm");
  double all = 0, pages = 0;
  file >> all >> pages;
  return pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}

// Results of one hour. Errors are those of the simulated truth, as shares of the arm's length.
struct Hour {
  double rest_squares = 0, rest_most = 0, way_squares = 0, way_most = 0;
  double rests = 0, ways = 0;  // Numbers of these errors.
  long steps = 0, fresh = 0, limited = 0, reported = 0;
  double heap = 0, resident = 0;

  [[nodiscard]] double rest_rms() const { return std::sqrt(rest_squares / std::max(1.0, rests)); }
  [[nodiscard]] double way_rms() const { return std::sqrt(way_squares / std::max(1.0, ways)); }
};

// Collects statistics while the servo runs, one row per hour. The rows are allocated before the start.
class Logbook : public ServoSessionWatcher {
 public:
  Logbook(SimulatedRig& rig, const Arm& arm, double hour) : rig_(rig), arm_(arm), hour_(hour) {
    hours.resize(slices);
  }
  void arm_sent(double, const ArmState&, double) override {}
  void reported(double time, const std::string& what) override {
    ++at(time).reported;
    if (++lines_ <= 10) std::fprintf(stderr, "%.1f s: %s\n", time, what.c_str());
  }
  void stepped(const ServoStep& step) override {
    Hour& hour = at(step.time);
    ++hour.steps;
    hour.limited += step.limited.empty() ? 0 : 1;
    hour.heap = heap_in_use(), hour.resident = resident();
    if (!step.is_fresh) return;
    ++hour.fresh;
    const double off = servo_error(arm_, rig_.arm().truth(*step.seen_at), step.desired).rms;
    const double phase = std::fmod(*step.seen_at - start_, 0.5 * period);
    // The last second of a rest, when the arm has settled.
    if (phase > rest - 1.01 && phase <= rest) {
      hour.rest_squares += off * off, hour.rest_most = std::max(hour.rest_most, off), ++hour.rests;
    } else if (phase > rest) {
      hour.way_squares += off * off, hour.way_most = std::max(hour.way_most, off), ++hour.ways;
    }
  }
  void begin(double start) { start_ = start; }

  std::vector<Hour> hours;

 private:
  Hour& at(double time) {
    const auto number = static_cast<std::ptrdiff_t>((time - start_) / hour_);
    return hours[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(number, 0, slices - 1))];
  }
  SimulatedRig& rig_;
  Arm arm_;
  double hour_, start_ = 0;
  int lines_ = 0;
};

std::vector<ServoGoal> repeated(const ArmState& one, const ArmState& other, double seconds) {
  std::vector<ServoGoal> goals;
  for (double time = 0; time < seconds; time += period) {
    goals.push_back({time, one}), goals.push_back({time + rest, one});
    goals.push_back({time + 0.5 * period, other}), goals.push_back({time + 0.5 * period + rest, other});
  }
  return goals;
}

// Returns the slope per row of a line fitted to the rows from the second on. The first row is excluded
// because it contains the motion to the first shape and the filling of buffers.
template <class Of>
double slope(const std::vector<Hour>& hours, Of of) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t i = 1; i < hours.size(); ++i) {
    const auto at = static_cast<double>(i);
    ++n, x += at, y += of(hours[i]), xx += at * at, xy += at * of(hours[i]);
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

// Returns the mean over a quarter of the rows: the last quarter, or the first one without its first row.
template <class Of>
double quarter(const std::vector<Hour>& hours, bool is_last, Of of) {
  const std::size_t count = slices / 4, first = is_last ? slices - count : 1, end = is_last ? slices : count;
  double sum = 0;
  for (std::size_t i = first; i < end; ++i) sum += of(hours[i]);
  return sum / static_cast<double>(end - first);
}

// Returns whether the error of the last quarter exceeds that of the first one by at most 10 %.
template <class Of>
bool is_error_level(const char* what, const std::vector<Hour>& hours, Of of) {
  constexpr double tenth = 1.1;
  const double first = quarter(hours, false, of), last = quarter(hours, true, of);
  const bool is_level = last <= tenth * first;
  fmt::print("- {}: {:.4f} % in the first quarter, {:.4f} % in the last, {:+.1e} per row: {}\n", what, first,
             last, slope(hours, of), is_level ? "steady" : "**not steady**");
  return is_level;
}

// Returns whether the memory grew by at most 4 bytes a step. A number kept for each step takes 8 bytes, a
// block of the heap at least 32. Half a number a step leaves room for tables that are still being filled on
// first use.
template <class Of>
bool is_memory_level(const char* what, const std::vector<Hour>& hours, double slack, Of of) {
  constexpr double most = 4;  // Bytes per step.
  const std::size_t from = slices - slices / 4 - 1;
  double steps = 0;
  for (std::size_t i = from + 1; i < slices; ++i) steps += static_cast<double>(hours[i].steps);
  const double grown = of(hours.back()) - of(hours[from]);
  const bool is_level = grown <= most * steps + slack;
  fmt::print("- {}: {:+.1f} kB in the last quarter, {:.2f} bytes per step: {}\n", what, grown / 1024,
             grown / std::max(1.0, steps), is_level ? "steady" : "**not steady**");
  return is_level;
}

bool judge(const std::vector<Hour>& hours) {
  constexpr double pages = 256.0 * 1024;
  bool is_fine = is_error_level("error at rest", hours, [](const Hour& h) { return 100 * h.rest_rms(); });
  is_fine &= is_error_level("error moving", hours, [](const Hour& h) { return 100 * h.way_rms(); });
  is_fine &= is_memory_level("heap in use", hours, 0, [](const Hour& h) { return h.heap; });
  is_fine &= is_memory_level("resident memory", hours, pages, [](const Hour& h) { return h.resident; });
  return is_fine;
}

void print_hours(const std::vector<Hour>& hours, double seconds) {
  fmt::print(
      "| start, h | steps | steps with pictures | RMS error at rest, % (largest) | RMS error moving, % "
      "(largest) | limited | messages | heap, kB | resident memory, kB |\n| ---: | ---: | ---: | ---: | ---: "
      "| ---: | ---: | ---: | ---: "
      "|\n");
  for (std::size_t i = 0; i < hours.size(); ++i) {
    const Hour& hour = hours[i];
    fmt::print("| {:.4g} | {} | {} | {:.4f} ({:.4f}) | {:.4f} ({:.4f}) | {} | {} | {:.1f} | {:.0f} |\n",
               static_cast<double>(i) * seconds / 3600 / slices, hour.steps, hour.fresh,
               100 * hour.rest_rms(), 100 * hour.rest_most, 100 * hour.way_rms(), 100 * hour.way_most,
               hour.limited, hour.reported, hour.heap / 1024, hour.resident / 1024);
  }
  fmt::print("\n");
}

// Runs one servo for `seconds` with a step of `step` s. Returns whether errors and memory stayed level and
// nothing failed.
bool endure(double seconds, double step, std::uint64_t seed) {
  ServoBench bench(servo_file(servo_target));
  TestRandom random(seed);
  ArmState one = ArmState::straight(3), other = one;
  for (std::size_t i = 0; i < 3; ++i) {
    one.bends[i] = random.vector<2>(-1, 1);
    other.bends[i] = one.bends[i] + random.vector<2>(-0.7, 0.7);
  }
  ServoConfig config = bench.config();
  config.step = step, config.keeps_steps = false;
  config.hold_after = std::max(0.3, 2 * step), config.give_up_after = std::max(3.0, 10 * step);
  config.goals = repeated(one, other, seconds);
  Logbook book(bench.rig(), bench.experiment().arm.arm(), seconds / slices);
  book.begin(bench.rig().clock().now());
  const RigModel model = bench.nominal();
  const ServoResult result = servo_in_session(bench.ports(), model, config, book);
  print_hours(book.hours, seconds);
  fmt::print("- end: {}; skipped steps: {}; fault: {}; stored steps: {}\n",
             result.is_done ? "done" : result.reason, result.missed_steps,
             result.fault ? result.fault->reason : "none", result.steps.size());
  const bool is_level_all = judge(book.hours);
  fmt::print("\n");
  return result.is_done && result.missed_steps == 0 && !result.fault && is_level_all;
}

}  // namespace
}  // namespace flexura

int main(int count, char** arguments) {
  using namespace flexura;
  const double hours = count > 1 ? std::strtod(arguments[1], nullptr) : 24;
  const std::uint64_t seed = count > 2 ? std::strtoull(arguments[2], nullptr, 10) : 1;
  if (!(hours > 0)) {
    std::fprintf(stderr, "endurance_study: hours: expected a number above 0\n");
    return 2;
  }
  fmt::print("## {:.4g} h, one step per second\n\n", hours);
  std::fflush(stdout);
  bool is_fine = endure(3600 * hours, 1, seed);
  std::fflush(stdout);
  fmt::print("## {:.4g} h, 30 steps per second\n\n", hours / slices);
  is_fine &= endure(3600 * hours / slices, 1.0 / 30, seed);
  fmt::print("{}\n", is_fine ? "Errors and memory are steady, and there was no failure."
                             : "**Errors or memory are not steady, or there was a failure.**");
  return is_fine ? 0 : 1;
}
