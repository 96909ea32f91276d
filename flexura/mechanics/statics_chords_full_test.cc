#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "flexura/mechanics/rod_parts.h"
#include "flexura/mechanics/statics.h"
#include "tests/support/chord_rod.h"
#include "tests/support/disk_robots.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

// A solution farther from the reference than this part of the length is another equilibrium if more modes do
// not bring it nearer.
constexpr double another = 1e-2;

DiskRobot with_modes(DiskRobot robot, bool by_piece, int bend, int others) {
  for (RodSection& section : robot.rod.sections)
    section.modes = {.shear = others, .stretch = others, .bend = bend, .twist = others, .by_piece = by_piece};
  return robot;
}

Equilibrium solved(const DiskRobot& robot) {
  return RodStatics(robot.rod).solve({.tensions = robot.tensions}, robot.loads());
}

double tip_distance(const DiskRobot& robot, const Equilibrium& at, const Pose& tip) {
  return (at.tip.position - tip.position).norm() / robot.rod.length();
}

DiskRobot random_robot_of(int pieces) {
  TestRandom random(1);
  return random_disk_robot(random, 1, pieces);
}

// Sorted errors.
struct Spread {
  std::vector<double> errors = {};

  [[nodiscard]] double part(double share) {
    std::ranges::sort(errors);
    return errors.at(static_cast<std::size_t>(share * static_cast<double>(errors.size() - 1)));
  }
  [[nodiscard]] std::string words() {
    if (errors.empty()) return "-";
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%.1e, %.1e, %.1e (%zu)", part(0.5), part(0.9), part(1),
                  errors.size());
    return text.data();
  }
};

// What a robot shows against the reference.
struct Compared {
  enum class Kind { compared, no_equilibrium, bent_too_far, no_reference, another };
  Kind kind = Kind::compared;
  double bend = 0, error = 0, whole_error = 0;  // rad; parts of the length
  bool has_note = false;
};

Compared compared(const DiskRobot& robot) {
  RodStatics statics(robot.rod);
  const Equilibrium at = statics.solve({.tensions = robot.tensions}, robot.loads());
  EXPECT_NE(at.end, StaticsEnd::out_of_steps);
  EXPECT_NE(at.end, StaticsEnd::bad_input);
  if (!at.converged()) return {.kind = Compared::Kind::no_equilibrium};
  const double bend = largest_section_bend(statics.chain());
  if (bend > 2.1) return {.kind = Compared::Kind::bent_too_far};
  const std::optional<Pose> tip = ChordRod(robot.rod, robot.tensions, robot.force).tip(12);
  if (!tip) return {.kind = Compared::Kind::no_reference};
  Compared result{.bend = bend,
                  .error = tip_distance(robot, at, *tip),
                  .whole_error = 1,
                  .has_note = at.coarse_section.has_value()};
  if (result.error > another) {
    const DiskRobot fine = with_modes(robot, true, robot.rod.sections[0].disks <= 4 ? 12 : 20, 6);
    const Equilibrium finely = solved(fine);
    if (!finely.converged() || tip_distance(fine, finely, *tip) > another)
      return {.kind = Compared::Kind::another};
  }
  const DiskRobot undivided = with_modes(robot, false, 5, 4);
  if (const Equilibrium whole = solved(undivided); whole.converged())
    result.whole_error = tip_distance(undivided, whole, *tip);
  return result;
}

// Prints the table of docs/mechanics.md. The bounds are some three times what 160 robots per row show.
TEST(StaticsChordsFull, TipsOfHundredsOfRobotsAgreeWithShootingFromDiskToDisk) {
  constexpr double sixty_degrees = 1.047;
  Spread all;
  std::printf("tip error / length: median, 90 %%, worst (robots)\n");
  for (const int pieces : {2, 3, 4, 5, 6, 8, 11, 12, 16}) {
    std::array<Spread, 2> own, whole;  // Bent by less and more than 60 degrees.
    Spread noted;
    std::array<int, 5> counts{};
    for_random_cases(40, [&](TestRandom& random) {
      const Compared one = compared(random_disk_robot(random, 2.1, pieces));
      ++counts.at(static_cast<std::size_t>(one.kind));
      if (one.kind != Compared::Kind::compared) return;
      if (one.has_note) {
        noted.errors.push_back(one.error);
        return;
      }
      const std::size_t bin = one.bend < sixty_degrees ? 0 : 1;
      own.at(bin).errors.push_back(one.error);
      whole.at(bin).errors.push_back(one.whole_error);
      if (pieces <= 11) all.errors.push_back(one.error);
    });
    const int modes = parts_of(random_robot_of(pieces).rod)[0].rod.modes.bend;
    std::printf(
        "%2d pieces, %d bend modes each: to 60 deg %s, beyond %s, with a note %s; whole section: %s, %s; "
        "disks meet %d, beyond 120 deg %d, no reference %d, another equilibrium %d\n",
        pieces, modes, own[0].words().c_str(), own[1].words().c_str(), noted.words().c_str(),
        whole[0].words().c_str(), whole[1].words().c_str(), counts[1], counts[2], counts[3], counts[4]);
    EXPECT_EQ(counts[3], 0) << "without a reference";
    EXPECT_LE(counts[4], 2) << "another equilibrium than the reference";
  }
  std::printf("all to 11 pieces, without a note: %s\n", all.words().c_str());
  EXPECT_LE(all.part(0.5), 2e-5);
  EXPECT_LE(all.part(0.95), 4e-4);
  EXPECT_LE(all.part(1), 4e-3);
}

}  // namespace
}  // namespace flexura
