#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <optional>
#include <vector>

#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/statics.h"
#include "tests/support/chord_rod.h"
#include "tests/support/disk_robots.h"
#include "tests/support/random_cases.h"
#include "tests/support/random_rods.h"

namespace flexura {
namespace {

// Four pieces of 0.1 m, tendons at 10 mm, bent by 1.6 rad.
DiskRobot strongly_bent() {
  DiskRobot robot;
  RodSection section{.length = 0.4, .disks = 4};
  section.stiffness = (Vector6d() << 1e4, 1e4, 1e4, 0.01, 0.01, 0.008).finished();
  robot.rod.sections = {section};
  robot.rod.tendons = {{.section = 0, .radius = 0.01}, {.section = 0, .radius = 0.01, .angle = M_PI}};
  robot.tensions = {4, 0};
  return robot;
}

double tip_error(const DiskRobot& robot, const Pose& reference) {
  const Equilibrium at = RodStatics(robot.rod).solve({.tensions = robot.tensions}, robot.loads());
  EXPECT_TRUE(at.converged()) << words(at.end);
  return (at.tip.position - reference.position).norm() / robot.rod.length();
}

// Within a section's bend of 120 degrees.
TEST(StaticsChords, AgreeWithShootingFromDiskToDisk) {
  int compared = 0;
  for_random_cases(8, [&](TestRandom& random) {
    const DiskRobot robot = random_disk_robot(random, 1.5);
    RodStatics statics(robot.rod);
    const Equilibrium at = statics.solve({.tensions = robot.tensions}, robot.loads());
    if (!at.converged() || at.coarse_section || largest_section_bend(statics.chain()) > 2.1) return;
    const std::optional<Pose> tip = ChordRod(robot.rod, robot.tensions, robot.force).tip(4);
    if (!tip) return;
    ++compared;
    EXPECT_LE((at.tip.position - tip->position).norm(), 1e-4 * robot.rod.length());
    EXPECT_LE((at.tip.rotation - tip->rotation).norm(), 1e-3);
  });
  EXPECT_GE(compared, 1);
}

// Numbers of docs/mechanics.md: the error falls geometrically with the modes of a piece. Modes of a whole
// section cannot follow the chords.
TEST(StaticsChords, ErrorsFallWithTheModesOfAPiece) {
  DiskRobot robot = strongly_bent();
  const std::optional<Pose> tip = ChordRod(robot.rod, robot.tensions, robot.force).tip(8);
  ASSERT_TRUE(tip);
  std::vector<double> errors;
  for (const int bend : {3, 4, 5, 6, 7}) {
    StrainModes& modes = robot.rod.sections[0].modes;
    modes.bend = bend, modes.by_piece = true;
    const double by_piece = tip_error(robot, *tip);
    modes.by_piece = false;
    std::printf("%d bend modes: of each piece %.1e, of the section %.1e\n", bend, by_piece,
                tip_error(robot, *tip));
    errors.push_back(by_piece);
    modes.bend = 5;
    EXPECT_GT(tip_error(robot, *tip), 1e-3) << "of the section";
  }
  // Even polynomials matter, odd ones hardly.
  EXPECT_LE(errors[0], 3e-3);
  EXPECT_LE(errors[2], 0.1 * errors[0] + 1e-6);
  EXPECT_LE(errors[4], 0.3 * errors[2] + 1e-6);
}

// The division does not change what a rod is: weights, bodies, loads, tapers and curvature at rest.
TEST(StaticsChords, APieceIsPartOfItsSection) {
  for_random_cases(6, [](TestRandom& random) {
    Rod rod = random_rod(random);
    for (RodSection& section : rod.sections) {
      section.disks = random.integer(1, 4);
      section.modes = {.shear = 2, .stretch = 2, .bend = 12, .twist = 8};
    }
    const std::vector<double> tensions = random_tensions(random, rod, 0.5);
    RodLoads loads = random_loads(random, rod);
    std::vector<RodPlace> places;
    for (std::size_t i = 0; i < rod.sections.size(); ++i) places.push_back({i, random.uniform(0, 1)});
    RodStatics divided(rod, places);
    const Equilibrium pieces = divided.solve({.tensions = tensions}, loads);
    for (RodSection& section : rod.sections) section.modes.by_piece = false;
    RodStatics undivided(rod, places);
    const Equilibrium whole = undivided.solve({.tensions = tensions}, loads);
    ASSERT_TRUE(pieces.converged() && whole.converged());
    EXPECT_LE((pieces.tip.position - whole.tip.position).norm(), 1e-4);
    for (const RodPlace& place : places)
      EXPECT_LE((divided.chain().pose(divided.chain().node_of(place)).position -
                 undivided.chain().pose(undivided.chain().node_of(place)).position)
                    .norm(),
                1e-4);
    EXPECT_NEAR(pieces.strain_energy, whole.strain_energy, 0.01 * whole.strain_energy + 1e-6);
  });
}

// An equilibrium of the statics stays at rest, and a moving rod keeps the places of its sections.
TEST(StaticsChords, ARodInMotionHasTheSameParts) {
  DiskRobot robot = strongly_bent();
  robot.rod.sections[0].mass_per_length = 0.05;
  robot.rod.sections[0].damping_time = 0.01;
  const RodPlace middle{0, 0.4};
  RodDynamics dynamics(robot.rod, {}, std::vector<RodPlace>{middle});
  RodStatics statics(robot.rod, std::vector<RodPlace>{middle});
  const Equilibrium at = statics.solve({.tensions = robot.tensions}, {});
  RodState state = dynamics.rest(at);
  for (int i = 0; i < 10; ++i)
    ASSERT_EQ(dynamics.step(state, {.tensions = robot.tensions}, {}, 0.01).end, DynamicsEnd::converged);
  EXPECT_LE((dynamics.tip(state).position - at.tip.position).norm(), 1e-8);
  EXPECT_LE((dynamics.motion(state, middle).pose.position -
             statics.chain().pose(statics.chain().node_of(middle)).position)
                .norm(),
            1e-8);
}

// Above the buckling load of a piece a tendon pulls its disks together.
TEST(StaticsChords, DisksThatAreDrawnTogetherAreReported) {
  DiskRobot robot = strongly_bent();
  robot.tensions = {60, 0};
  const Equilibrium at = RodStatics(robot.rod).solve({.tensions = robot.tensions}, {});
  EXPECT_EQ(at.end, StaticsEnd::disks_meet) << words(at.end);
  robot.tensions = {1, 0};
  EXPECT_TRUE(RodStatics(robot.rod).solve({.tensions = robot.tensions}, {}).converged());
}

TEST(StaticsChords, ABendThatNeedsMoreModesIsReported) {
  DiskRobot robot = strongly_bent();
  EXPECT_FALSE(RodStatics(robot.rod).solve({.tensions = robot.tensions}, {}).coarse_section);
  robot.rod.sections[0].modes.bend = 2;
  EXPECT_EQ(RodStatics(robot.rod).solve({.tensions = robot.tensions}, {}).coarse_section, 0u);
}

}  // namespace
}  // namespace flexura
