#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <numbers>
#include <optional>
#include <vector>

#include "flexura/math/derivative_check.h"
#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/rod_parts.h"
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
  robot.rod.tendons = {{.section = 0, .radius = 0.01},
                       {.section = 0, .radius = 0.01, .angle = std::numbers::pi}};
  robot.tensions = {4, 0};
  return robot;
}

double tip_error(const DiskRobot& robot, const Pose& reference) {
  const Equilibrium at = RodStatics(robot.rod).solve({.tensions = robot.tensions}, robot.loads());
  EXPECT_TRUE(at.converged()) << words(at.end);
  return (at.tip.position - reference.position).norm() / robot.rod.length();
}

// Within a section's bend of 120 degrees and without a note. Single robots near buckling are off by up to
// 1.3e-3 of the length (StaticsChordsFull).
TEST(StaticsChords, AgreeWithShootingFromDiskToDisk) {
  std::vector<double> errors, turns;
  for_random_cases(12, [&](TestRandom& random) {
    const DiskRobot robot = random_disk_robot(random, 1.5);
    RodStatics statics(robot.rod);
    const Equilibrium at = statics.solve({.tensions = robot.tensions}, robot.loads());
    if (!at.converged() || at.coarse_section || largest_section_bend(statics.chain()) > 2.1) return;
    const std::optional<Pose> tip = ChordRod(robot.rod, robot.tensions, robot.force, 16).tip(4);
    if (!tip) return;
    errors.push_back((at.tip.position - tip->position).norm() / robot.rod.length());
    turns.push_back((at.tip.rotation - tip->rotation).norm());
    EXPECT_LE(errors.back(), 4e-3);
  });
  ASSERT_FALSE(errors.empty());
  std::ranges::sort(errors);
  std::ranges::sort(turns);
  EXPECT_LE(errors[errors.size() / 2], 1e-4);
  EXPECT_LE(turns[turns.size() / 2], 1e-3);
}

// The error falls geometrically with the even polynomials of a piece: here 3, 5 or 7 modes each, spread from
// those of the section, with enough of shear, stretch and twist. Modes of the whole section cannot follow the
// chords.
TEST(StaticsChords, ErrorsFallWithTheModesOfAPiece) {
  DiskRobot robot = strongly_bent();
  const std::optional<Pose> tip = ChordRod(robot.rod, robot.tensions, robot.force, 128).tip(8);
  ASSERT_TRUE(tip);
  std::vector<double> errors;
  for (const int bend : {3, 6, 9}) {
    StrainModes& modes = robot.rod.sections[0].modes;
    modes = {.shear = 12, .stretch = 12, .bend = bend, .twist = 12};
    const int of_piece = parts_of(robot.rod)[0].rod.modes.bend;
    EXPECT_EQ(of_piece, 3 + 2 * static_cast<int>(errors.size()));
    errors.push_back(tip_error(robot, *tip));
    modes.by_piece = false;
    const double whole = tip_error(robot, *tip);
    std::printf("%d bend modes of each piece: %.1e; %d of the section: %.1e\n", of_piece, errors.back(), bend,
                whole);
    EXPECT_GE(whole, 100 * errors.back());
  }
  // A single robot: 2e-5, 2e-7, 8e-8. The reference is exact to about 2e-8.
  EXPECT_LE(errors[1], 0.1 * errors[0]);
  EXPECT_LE(errors[2], 0.5 * errors[1] + 1e-7);
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
    places.reserve(rod.sections.size());
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

// A damped rod that starts straight comes to rest in the equilibrium of the statics, and a place of a section
// is the same in both.
TEST(StaticsChords, TheRestOfAMovingRodIsTheEquilibrium) {
  int compared = 0;
  for_random_cases(4, [&](TestRandom& random) {
    DiskRobot robot = random_disk_robot(random, 1.2);
    for (RodSection& section : robot.rod.sections) {
      section.density = 6000;
      section.damping_time = 0.1;
    }
    RodLoads loads = robot.loads();
    loads.gravity = {0, 3, -9.81};
    const std::vector<RodPlace> places = {{.section = 0, .at = 0.4}};
    RodStatics statics(robot.rod, places);
    const Equilibrium from_no_load = statics.settle({.tensions = robot.tensions}, loads);
    if (!from_no_load.converged()) return;
    RodDynamics dynamics(robot.rod, {.spectral_radius = 0, .tolerance = 1e-11}, places);
    RodState state = dynamics.rest();
    bool rests = false;
    for (int i = 0; i < 1000 && !rests; ++i) {
      const Eigen::VectorXd before = state.q;
      ASSERT_TRUE(dynamics.step(state, {.tensions = robot.tensions}, loads, 0.02).converged());
      rests = (state.q - before).cwiseProduct(dynamics.chain().scales()).cwiseAbs().maxCoeff() < 1e-11;
    }
    if (!rests) return;  // Near buckling the slowest motion takes a minute to decay.
    ++compared;
    // The nearby equilibrium: a rod that swings may come to rest in another one than under growing load.
    Equilibrium there = from_no_load;
    there.q = state.q;
    const Equilibrium at = statics.solve({.tensions = robot.tensions}, loads, there);
    ASSERT_TRUE(at.converged() && at.stable);
    const double near = 1e-9 * robot.rod.length();
    EXPECT_LE((dynamics.tip(state).position - at.tip.position).norm(), near);
    EXPECT_LE((dynamics.motion(state, places[0]).pose.position -
               statics.chain().pose(statics.chain().node_of(places[0])).position)
                  .norm(),
              near);
  });
}

// A robot turned about the axis of its base, with its tendons and loads.
TEST(StaticsChords, NothingDependsOnHowTheBaseIsTurned) {
  for_random_cases(6, [](TestRandom& random) {
    const DiskRobot robot = random_disk_robot(random, 1.5);
    const double angle = random.uniform(-3, 3);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    DiskRobot turned = robot;
    for (TendonRoute& tendon : turned.rod.tendons) tendon.angle += angle;
    turned.force = turn * robot.force;
    const Equilibrium at = RodStatics(robot.rod).solve({.tensions = robot.tensions}, robot.loads()),
                      there = RodStatics(turned.rod).solve({.tensions = turned.tensions}, turned.loads());
    ASSERT_EQ(at.end, there.end);
    if (!at.converged() || at.ambiguous) return;
    EXPECT_LE((there.tip.position - turn * at.tip.position).norm(), 1e-9 * robot.rod.length());
    EXPECT_LE((there.tip.rotation - turn * at.tip.rotation * turn.transpose()).norm(), 1e-8);
  });
}

// Tangent, and the derivatives of the equilibrium by tensions and by the tip's force.
TEST(StaticsChords, DerivativesAreThoseByDifferences) {
  for_random_cases(4, [&](TestRandom& random) {
    // Some robots collapse until their disks meet.
    DiskRobot robot;
    Equilibrium at;
    for (int tries = 0; tries < 20 && !at.converged(); ++tries) {
      robot = random_disk_robot(random, 0.8, random.integer(3, 5));
      at = RodStatics(robot.rod).solve({.tensions = robot.tensions}, robot.loads());
      ASSERT_TRUE(at.converged() || at.end == StaticsEnd::disks_meet) << words(at.end);
    }
    ASSERT_TRUE(at.converged());
    RodStatics statics(robot.rod);
    at = statics.solve({.tensions = robot.tensions}, robot.loads());
    const EquilibriumSlopes slopes = statics.slopes();

    RodChain chain(robot.rod);
    const Eigen::VectorXd unit = chain.scales().cwiseInverse();
    const auto residual = [&](const Eigen::VectorXd& q) {
      chain.balance(q.cwiseProduct(unit), robot.tensions, robot.loads(), 1);
      return Eigen::VectorXd(chain.residual().cwiseProduct(unit));
    };
    const Eigen::VectorXd q = at.q.cwiseProduct(chain.scales());
    Eigen::MatrixXd product = unit.cwiseInverse().asDiagonal() * numerical_jacobian(residual, q, 0.02).value;
    (void)residual(q);
    ASSERT_TRUE(chain.factor());
    chain.solve(product);
    product = unit.cwiseInverse().asDiagonal() * product;
    EXPECT_LE((product - Eigen::MatrixXd::Identity(q.size(), q.size())).cwiseAbs().maxCoeff(), 1e-4);

    const auto expect_column = [&](const Vector6d& found, double step, auto&& solved) {
      const Eigen::Vector3d by = (solved(step) - solved(-step)) / (2 * step);
      EXPECT_LE((found.head<3>() - by).norm(), 1e-4 * (by.norm() + 1e-3 * robot.rod.length()));
    };
    for (std::size_t i = 0; i < robot.tensions.size(); ++i) {
      if (robot.tensions[i] == 0) continue;
      expect_column(slopes.tip_by_input.col(static_cast<Eigen::Index>(i)), 1e-4 * robot.tensions[i],
                    [&](double step) {
                      std::vector<double> tensions = robot.tensions;
                      tensions[i] += step;
                      return statics.solve({.tensions = tensions}, robot.loads(), at).tip.position;
                    });
    }
    for (int c = 0; c < 3; ++c)
      expect_column(slopes.tip_by_tip.col(c), 1e-5, [&](double step) {
        DiskRobot pulled = robot;
        pulled.force[c] += step;
        return statics.solve({.tensions = robot.tensions}, pulled.loads(), at).tip.position;
      });
  });
}

// Only sections with disks, and with at least three bend modes, are divided.
TEST(StaticsChords, ARodWithoutDisksIsNotDivided) {
  for_random_cases(4, [](TestRandom& random) {
    Rod rod = random_rod(random);
    EXPECT_EQ(parts_of(rod).size(), rod.sections.size());
    const TendonInput input{.tensions = random_tensions(random, rod, 4)};
    const RodLoads loads = random_loads(random, rod);
    const Equilibrium at = RodStatics(rod).solve(input, loads);
    for (RodSection& section : rod.sections) section.modes.by_piece = false;
    const Equilibrium same = RodStatics(rod).solve(input, loads);
    EXPECT_TRUE(at.q == same.q);
    EXPECT_TRUE(at.tip.position == same.tip.position);
    EXPECT_FALSE(at.coarse_section);
  });
  const auto parts_with = [](int disks, int bend, bool by_piece) {
    Rod rod;
    rod.sections = {{.length = 0.4, .disks = disks}};
    rod.sections[0].modes.bend = bend;
    rod.sections[0].modes.by_piece = by_piece;
    return parts_of(rod).size();
  };
  EXPECT_EQ(parts_with(4, 5, true), 4u);
  EXPECT_EQ(parts_with(4, 2, true), 1u);
  EXPECT_EQ(parts_with(4, 5, false), 1u);
  EXPECT_EQ(parts_with(11, 5, true), 11u);
  EXPECT_EQ(parts_with(12, 5, true), 1u);
}

bool is_finite(const Equilibrium& at) {
  const auto finite = [](double value) { return std::isfinite(value); };
  return at.q.allFinite() && at.tip.position.allFinite() && at.tip.rotation.allFinite() &&
         std::isfinite(at.strain_energy) && std::ranges::all_of(at.tensions, finite) &&
         std::ranges::all_of(at.tendon_lengths, finite) && std::ranges::all_of(at.displacements, finite);
}

// Above the buckling load of a piece a tendon pulls its disks together. Every result is finite, and is an
// equilibrium or says that disks meet.
TEST(StaticsChords, DisksThatAreDrawnTogetherAreReported) {
  DiskRobot robot = strongly_bent();
  RodStatics statics(robot.rod);
  const double pi = std::numbers::pi, buckling = 0.01 * pi * pi / (0.1 * 0.1);  // N, of a piece.
  for (const double part : {0.2, 0.9, 1.1, 2.0, 20.0, 1e6}) {
    for (const double other : {0.0, 1.0}) {
      const TendonInput input{.tensions = {part * buckling, other * part * buckling}};
      for (const Equilibrium& at : {statics.solve(input, {}), statics.settle(input, {})}) {
        EXPECT_TRUE(is_finite(at)) << part << " " << other;
        EXPECT_TRUE(at.converged() || part > 0.3) << part << " " << other << ": " << words(at.end);
        EXPECT_TRUE(at.converged() || at.end == StaticsEnd::disks_meet)
            << part << " " << other << ": " << words(at.end);
      }
    }
    EXPECT_TRUE(part < 2 ||
                statics.solve({.tensions = {part * buckling, 0}}, {}).end == StaticsEnd::disks_meet)
        << part;
  }
}

// Tendons that are pulled in by about the length of the rod leave no place for it.
TEST(StaticsChords, ARodIsNotPulledIntoNothing) {
  Rod rod;
  for (int i = 0; i < 2; ++i) {
    RodSection section{.length = 0.2, .disks = 8};
    section.stiffness = (Vector6d() << 3e4, 3e4, 8e4, 0.01, 0.01, 0.008).finished();
    rod.sections.push_back(section);
    for (int k = 0; k < 3; ++k)
      rod.tendons.push_back(
          {.section = static_cast<std::size_t>(i), .radius = 0.01, .angle = 2 * std::numbers::pi * k / 3});
  }
  RodStatics statics(rod);
  for (const double pulled : {0.1985, 0.199, 0.1999, 0.2, 0.2001}) {
    const Equilibrium at = statics.solve({.displacements = std::vector<double>(6, pulled)}, {});
    EXPECT_TRUE(is_finite(at)) << pulled;
    EXPECT_FALSE(at.converged()) << pulled;
  }
}

TEST(StaticsChords, AMovingRodWhoseDisksMeetStopsWithFiniteNumbers) {
  DiskRobot robot = strongly_bent();
  robot.rod.sections[0].mass_per_length = 0.05;
  robot.rod.sections[0].damping_time = 0.01;
  RodDynamics dynamics(robot.rod, {.most_pieces = 256});
  RodState state = dynamics.rest();
  DynamicsEnd end = DynamicsEnd::converged;
  for (int i = 0; i < 100 && end == DynamicsEnd::converged; ++i)
    end = dynamics.step(state, {.tensions = {0.6 * i, 0}}, {}, 5e-3).end;
  EXPECT_EQ(end, DynamicsEnd::did_not_converge);
  EXPECT_TRUE(state.q.allFinite() && state.momentum.allFinite());
  EXPECT_TRUE(dynamics.tip(state).position.allFinite());
}

TEST(StaticsChords, ABendThatNeedsMoreModesIsReported) {
  DiskRobot robot = strongly_bent();
  EXPECT_FALSE(RodStatics(robot.rod).solve({.tensions = robot.tensions}, {}).coarse_section);
  robot.rod.sections[0].modes.bend = 2;
  EXPECT_EQ(RodStatics(robot.rod).solve({.tensions = robot.tensions}, {}).coarse_section, 0u);
}

}  // namespace
}  // namespace flexura
