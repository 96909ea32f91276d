#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/study_rows.h"
#include "tests/support/swinging_bench.h"

// Runs of the study of an arm that swings, kept in a file so that a long study can be continued.
namespace flexura {

/// Result of one servo of the study; lengths as shares of the arm's length.
struct SwingingRun {
  Arrival arrival;
  MotionTotals totals;
  double lag = 0;      ///< Time shift at which a trajectory is followed best, s.
  double tracked = 0;  ///< Distance from a trajectory without this lag, root mean square over its time.
};

/// Identifies a run: the study's part, what is servoed to, the law, and the number of the target.
struct SwingingRunKey {
  std::string part, kind, law;
  std::size_t index = 0;
  auto operator<=>(const SwingingRunKey&) const = default;
};

/// Runs by their keys. Lines of the file are `part;kind;law;index;` and the numbers of the run. Thread-safe.
class SwingingRuns {
 public:
  /// Reads the runs of an earlier study from `file`, if it exists; "" keeps them in memory only.
  explicit SwingingRuns(std::string file) : file_(std::move(file)) {
    std::ifstream in(file_);
    for (std::string line; std::getline(in, line);) {
      std::istringstream parts(line);
      SwingingRunKey key;
      std::string index;
      // A line that was cut off when a study was stopped does not count.
      if (std::ranges::count(line, ';') == 5 && std::getline(parts, key.part, ';') &&
          std::getline(parts, key.kind, ';') && std::getline(parts, key.law, ';') &&
          std::getline(parts, index, ';')) {
        key.index = std::strtoull(index.c_str(), nullptr, 10);
        runs_[key] = read(parts);
      }
    }
  }
  [[nodiscard]] bool has(const SwingingRunKey& key) const {
    const std::lock_guard lock(mutex_);
    return runs_.contains(key);
  }
  void add(const SwingingRunKey& key, const SwingingRun& run) {
    const std::lock_guard lock(mutex_);
    runs_[key] = run;
    if (file_.empty()) return;
    std::ofstream out(file_, std::ios::app);
    out << fmt::format("{};{};{};{};{}\n", key.part, key.kind, key.law, key.index, written(run));
  }
  [[nodiscard]] std::vector<SwingingRun> of(const std::string& part, const std::string& kind,
                                            const std::string& law) const {
    const std::lock_guard lock(mutex_);
    std::vector<SwingingRun> found;
    for (const auto& [key, run] : runs_)
      if (key.part == part && key.kind == kind && key.law == law) found.push_back(run);
    return found;
  }

 private:
  static std::string written(const SwingingRun& run) {
    const Arrival& a = run.arrival;
    const MotionTotals& t = run.totals;
    std::string reason = a.reason;
    std::ranges::replace(reason, ';', ',');
    return fmt::format("{} {} {} {} {} {} {} {} {} {} {} {} {} {};{}", a.is_done ? 1 : 0, a.settled,
                       a.overshoot, a.rms, a.most, a.tip, t.energy, t.most_tension, t.bend_violations,
                       t.rate_violations, t.view_violations, t.contacts, run.lag, run.tracked, reason);
  }
  // Reads a number that may be "nan", which streams do not.
  static double number_from(std::istream& in) {
    std::string word;
    in >> word;
    return std::strtod(word.c_str(), nullptr);
  }
  static SwingingRun read(std::istream& in) {
    SwingingRun run;
    std::string numbers;
    std::getline(in, numbers, ';');
    std::getline(in, run.arrival.reason);
    std::istringstream words(numbers);
    run.arrival.is_done = number_from(words) != 0;
    for (double* value : {&run.arrival.settled, &run.arrival.overshoot, &run.arrival.rms, &run.arrival.most,
                          &run.arrival.tip, &run.totals.energy, &run.totals.most_tension})
      *value = number_from(words);
    for (int* value : {&run.totals.bend_violations, &run.totals.rate_violations, &run.totals.view_violations,
                       &run.totals.contacts})
      *value = static_cast<int>(number_from(words));
    run.lag = number_from(words), run.tracked = number_from(words);
    return run;
  }

  std::string file_;
  mutable std::mutex mutex_;
  std::map<SwingingRunKey, SwingingRun> runs_;
};

inline std::string violations_of(const std::vector<SwingingRun>& runs) {
  std::array<int, 4> sums = {};
  for (const SwingingRun& run : runs) {
    sums[0] += run.totals.bend_violations, sums[1] += run.totals.rate_violations;
    sums[2] += run.totals.view_violations, sums[3] += run.totals.contacts;
  }
  return fmt::format("{} / {} / {} / {}", sums[0], sums[1], sums[2], sums[3]);
}

template <class Of>
std::vector<double> numbers_of_runs(const std::vector<SwingingRun>& runs, Of of) {
  std::vector<double> values;
  for (const SwingingRun& run : runs) values.push_back(of(run));
  return values;
}

/// Prints a table with a row for each law, of servos to shapes.
inline void print_targets(const SwingingRuns& all, const std::string& part,
                          const std::vector<std::string>& laws) {
  fmt::print(
      "| law | converged | within 2 % at the end | time to 2 % error, s (median / 95 %) | overshoot, % (95 "
      "%) | final RMS error, % (median / 95 % / largest) | energy, J (median) | tension, N (largest) | "
      "violations: bend / rate / view / contact |\n| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | "
      "---: |\n");
  for (const std::string& law : laws) {
    const std::vector<SwingingRun> runs = all.of(part, "target", law);
    if (runs.empty()) continue;
    const auto of = [&](auto get) { return numbers_of_runs(runs, get); };
    const auto done = std::ranges::count_if(runs, [](const SwingingRun& run) { return run.arrival.is_done; });
    const auto near =
        std::ranges::count_if(runs, [](const SwingingRun& run) { return run.arrival.rms <= 0.02; });
    const std::vector<double> settled = of([](const SwingingRun& run) { return run.arrival.settled; }),
                              overshoot = of([](const SwingingRun& run) {
                                return 100 * std::max(0.0, run.arrival.overshoot);
                              }),
                              left = of([](const SwingingRun& run) { return 100 * run.arrival.rms; }),
                              energy = of([](const SwingingRun& run) { return run.totals.energy; }),
                              tension = of([](const SwingingRun& run) { return run.totals.most_tension; });
    fmt::print("| {} | {}/{} | {} | {} / {} | {} | {} / {} / {} | {} | {} | {} |\n", law, done, runs.size(),
               near, number(quantile(settled, 0.5), 2), number(quantile(settled, 0.95), 2),
               number(quantile(overshoot, 0.95), 1), number(quantile(left, 0.5), 3),
               number(quantile(left, 0.95), 3), number(quantile(left, 1), 2),
               number(quantile(energy, 0.5), 2), number(quantile(tension, 1), 0), violations_of(runs));
  }
  fmt::print("\n");
  for (const std::string& law : laws) {
    std::vector<Arrival> arrivals;
    for (const SwingingRun& run : all.of(part, "target", law)) arrivals.push_back(run.arrival);
    print_reasons(law, arrivals);
  }
  fmt::print("\n");
}

/// Prints a table with a row for each law, of shapes that move.
inline void print_trajectories(const SwingingRuns& all, const std::string& part,
                               const std::vector<std::string>& laws) {
  fmt::print(
      "| law | followed to the end | lag, s (median / largest) | RMS error, % (median / 95 %) | RMS error "
      "without the lag, % (median / 95 %) | tension, N (largest) | violations: bend / rate / view / contact "
      "|\n"
      "| --- | ---: | ---: | ---: | ---: | ---: | ---: |\n");
  for (const std::string& law : laws) {
    const std::vector<SwingingRun> runs = all.of(part, "trajectory", law);
    if (runs.empty()) continue;
    const auto of = [&](auto get) { return numbers_of_runs(runs, get); };
    const auto done = std::ranges::count_if(runs, [](const SwingingRun& run) { return run.arrival.is_done; });
    const std::vector<double> lag = of([](const SwingingRun& run) { return run.lag; }),
                              off = of([](const SwingingRun& run) { return 100 * run.arrival.rms; }),
                              tracked = of([](const SwingingRun& run) { return 100 * run.tracked; }),
                              tension = of([](const SwingingRun& run) { return run.totals.most_tension; });
    fmt::print("| {} | {}/{} | {} / {} | {} / {} | {} / {} | {} | {} |\n", law, done, runs.size(),
               number(quantile(lag, 0.5), 2), number(quantile(lag, 1), 2), number(quantile(off, 0.5), 2),
               number(quantile(off, 0.95), 2), number(quantile(tracked, 0.5), 2),
               number(quantile(tracked, 0.95), 2), number(quantile(tension, 1), 0), violations_of(runs));
  }
  fmt::print("\n");
}

}  // namespace flexura
