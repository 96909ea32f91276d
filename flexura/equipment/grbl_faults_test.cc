#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "flexura/equipment/grbl_drive.h"
#include "tests/support/grbl_bench.h"

// A drive on a bad line: whatever happens to the bytes, it ends each call in time, and a position that it
// returns is one where the motors were during the call.
namespace flexura {
namespace {

struct BadLine {
  const char* name;
  LinkFaults faults;
};

class GrblFaults : public testing::TestWithParam<BadLine> {};

// Where the motors were.
class Track {
 public:
  explicit Track(GrblBench& bench) {
    bench.link->on_tick = [this, &bench](double now) {
      places_.emplace_back(now, bench.device.positions(now));
    };
  }
  // Returns the largest distance of an axis from the nearest place since a time, microsteps.
  [[nodiscard]] double distance(const std::vector<double>& position, double since) {
    while (!places_.empty() && places_.front().first < since) places_.pop_front();
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& [time, place] : places_) {
      double farthest = 0;
      for (std::size_t i = 0; i < place.size(); ++i)
        farthest = std::max(farthest, std::abs(place[i] - position[i]));
      nearest = std::min(nearest, farthest);
    }
    return nearest;
  }

 private:
  std::deque<std::pair<double, std::vector<double>>> places_;
};

// Makes a drive that has lost its position usable again.
bool repair(GrblBench& bench) {
  for (int i = 0; i < 5; ++i) {
    if (!bench.drive->knows_position() || !bench.drive->read()) (void)bench.drive->unlock();
    if (bench.drive->knows_position() && bench.drive->read()) return true;
    bench.link->pass(1);
    if (bench.drive->connect()) {
      (void)bench.drive->unlock();
      (void)bench.drive->set_positions(bench.motors());
    }
  }
  return false;
}

constexpr double longest_call = 30;  // s; several timeouts in a row.

TEST_P(GrblFaults, NeverHangsNorReturnsAWrongPosition) {
  int good = 0, asked = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    GrblBench bench({}, {}, seed);
    Track track(bench);
    ASSERT_TRUE(bench.start());
    bench.link->faults = GetParam().faults;
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(-1500, 1500), share(0, 1);
    for (int step = 0; step < 60; ++step) {
      const double start = bench.clock.now();
      const double choice = share(random);
      if (choice < 0.5) {
        const std::vector<double> target{place(random), place(random), place(random)};
        (void)bench.drive->command(target, 0.3 * share(random));
      } else if (choice < 0.53) {
        (void)bench.drive->halt();
      } else {
        ++asked;
        const auto reading = bench.drive->read();
        if (reading) {
          ++good;
          EXPECT_LE(track.distance(reading.value().values, start - GetParam().faults.most_late), 2.5)
              << "seed " << seed << ", step " << step;
        }
      }
      EXPECT_LT(bench.clock.now() - start, longest_call);
      bench.link->pass(0.1 * share(random));
      if (!bench.drive->knows_position()) {
        // A person looks at the motors after all has come to rest.
        bench.link->pass(2);
        (void)bench.drive->unlock();
        bench.link->pass(2);
        (void)bench.drive->set_positions(bench.motors());
      }
    }
    bench.link->faults = {};
    bench.link->pass(1);
    ASSERT_TRUE(repair(bench)) << "seed " << seed;
    const std::vector<double> target{100, -200, 300};
    const auto moved = bench.drive->command(target, 0.5);
    ASSERT_TRUE(moved) << text(*moved.fault());
    bench.link->pass(8);
    EXPECT_EQ(bench.drive->read().value().values, target);
    EXPECT_EQ(bench.motors(), target);
  }
  EXPECT_GT(good, asked / 4);
}

INSTANTIATE_TEST_SUITE_P(Each, GrblFaults,
                         testing::Values(BadLine{"none", {}}, BadLine{"lost", {.lose = 0.05}},
                                         BadLine{"doubled", {.repeat = 0.1}},
                                         BadLine{"truncated", {.cut = 0.05}},
                                         BadLine{"damaged", {.damage = 0.05}},
                                         BadLine{"reordered", {.swap = 0.05}},
                                         BadLine{"delayed", {.delay = 0.1, .most_late = 0.1}},
                                         BadLine{"late", {.delay = 0.05, .most_late = 1}},
                                         BadLine{"all",
                                                 {.lose = 0.02,
                                                  .repeat = 0.02,
                                                  .cut = 0.02,
                                                  .damage = 0.02,
                                                  .swap = 0.02,
                                                  .delay = 0.02,
                                                  .most_late = 0.3}}),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(GrblVanishing, IsReportedAndEnds) {
  GrblBench bench;
  ASSERT_TRUE(bench.start());
  ASSERT_TRUE(bench.drive->command(std::vector<double>{1000, 0, 0}, 1));
  bench.link->pass(0.3);
  bench.link->is_silent = true;
  EXPECT_FALSE(bench.drive->read());
  EXPECT_FALSE(bench.drive->command(std::vector<double>{0, 0, 0}, 1));
  bench.link->pass(5);
  bench.link->is_silent = false;
  // The controller has gone on to its last target, which is on the commanded path.
  EXPECT_TRUE(repair(bench));
  EXPECT_EQ(bench.drive->read().value().values, bench.motors());
}

}  // namespace
}  // namespace flexura
