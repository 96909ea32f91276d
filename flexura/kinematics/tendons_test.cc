#include "flexura/kinematics/tendons.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "flexura/kinematics/shape.h"
#include "flexura/math/derivative_check.h"
#include "flexura/math/quadrature.h"
#include "flexura/model/arm_difference.h"
#include "flexura/model/backbone.h"
#include "tests/support/arms.h"
#include "tests/support/drives.h"

namespace flexura {
namespace {

// Bends up to two thirds of a turn on sections of 0.2 m or more keep every tendon of random_drive inside.
ArmState gentle_state(TestRandom& random, const Arm& arm) {
  ArmState state = random_state(random, arm);
  for (Eigen::Vector2d& bend : state.bends) bend *= 0.45;
  return state;
}

Eigen::Vector3d on_tendon(const Backbone& backbone, const Tendon& tendon, double s) {
  const Eigen::Vector2d offset = tendon.offset();
  return backbone.pose(s) * Eigen::Vector3d(offset.x(), offset.y(), 0);
}

// Returns the speed along the curve at the tendon's offset from the backbone, per metre of backbone.
double speed_along(const Arc& arc, const Tendon& tendon, double distance) {
  const Eigen::Vector2d curvature = arc.bend / arc.length;
  const Eigen::Vector2d offset = tendon.offset();
  const Eigen::Vector3d turning(-curvature.y(), curvature.x(), 0);
  const Eigen::Matrix3d& R_WS = arc.pose(distance).rotation;
  const Eigen::Vector3d velocity =
      R_WS.col(2) + (R_WS * turning).cross(R_WS * Eigen::Vector3d(offset.x(), offset.y(), 0));
  return velocity.norm();
}

// Returns the length of a tendon with this displacement.
double length_of(const Arm& arm, const Tendon& tendon, double pulled) {
  double straight = 0;
  for (std::size_t i = 0; i <= tendon.section; ++i) straight += arm.sections[i].length;
  return straight - pulled;
}

TEST(Tendons, AreTheIntegralAlongThemselvesTo1em12) {
  const Quadrature rule = gauss_legendre(8);
  for_random_cases(150, [&](TestRandom& random) {
    const Arm arm = random_arm(random);
    const Drive drive = random_drive(random, arm);
    const ArmState state = gentle_state(random, arm);
    const Backbone backbone(arm, state);
    const std::vector<double> pulled = tendon_displacements(arm, drive, state).pulled;
    for (std::size_t t = 0; t < drive.tendons.size(); ++t) {
      double integral = 0;
      for (std::size_t i = 0; i <= drive.tendons[t].section; ++i) {
        const Arc& arc = backbone.arcs()[i];
        integral +=
            integrate(rule, [&](double at) { return speed_along(arc, drive.tendons[t], at); }, 0, arc.length);
      }
      EXPECT_NEAR(length_of(arm, drive.tendons[t], pulled[t]), integral, 1e-12);
    }
  });
}

TEST(Tendons, BetweenDisksRunStraight) {
  for_random_cases(100, [](TestRandom& random) {
    const Arm arm = random_arm(random);
    Drive drive = random_drive(random, arm);
    drive.disks = random.integer(1, 12);
    const ArmState state = gentle_state(random, arm);
    const Backbone backbone(arm, state);
    const std::vector<double> pulled = tendon_displacements(arm, drive, state).pulled;
    const auto pieces = static_cast<int>(*drive.disks);
    for (std::size_t t = 0; t < drive.tendons.size(); ++t) {
      double straight = 0;
      for (std::size_t i = 0; i <= drive.tendons[t].section; ++i) {
        const Arc& arc = backbone.arcs()[i];
        const auto at = [&](int disk) {
          return on_tendon(backbone, drive.tendons[t], arc.s + arc.length * disk / pieces);
        };
        for (int disk = 0; disk < pieces; ++disk) straight += (at(disk + 1) - at(disk)).norm();
      }
      EXPECT_NEAR(length_of(arm, drive.tendons[t], pulled[t]), straight, 1e-12);
    }
  });
}

TEST(Tendons, PullingInBendsTowardsTheTendon) {
  Arm arm;
  arm.kind = ArmKind::spatial;
  arm.sections = {{.length = 0.3}, {.length = 0.2}};
  Drive drive;
  drive.tendons = {{0, 0.01, 0}, {0, 0.01, std::numbers::pi / 2}, {1, 0.02, 0}};
  ArmState state = ArmState::straight(2);
  state.bends = {{0.5, -0.2}, {0.3, 0.1}};
  const TendonDisplacements found = tendon_displacements(arm, drive, state);
  EXPECT_NEAR(found.pulled[0], 0.01 * 0.5, 1e-16);
  EXPECT_NEAR(found.pulled[1], 0.01 * -0.2, 1e-16);
  EXPECT_NEAR(found.pulled[2], 0.02 * (0.5 + 0.3), 1e-16) << "runs through the first section too";
  state.stretches[0] = 1.1;
  EXPECT_NEAR(tendon_displacements(arm, drive, state).pulled[0], 0.005 - 0.03, 1e-16);
}

Eigen::VectorXd vector_of(const TendonDisplacements& displacements) {
  return Eigen::Map<const Eigen::VectorXd>(displacements.pulled.data(),
                                           static_cast<Eigen::Index>(displacements.pulled.size()));
}

TEST(Tendons, JacobianIsTheDerivativeAndInAChannelTheMapItself) {
  for_random_cases(100, [](TestRandom& random) {
    const Arm arm = random_arm(random);
    Drive drive = random_drive(random, arm);
    const ArmState state = random_state(random, arm);
    const Eigen::VectorXd straight = packed(ArmState::straight(arm.sections.size()));
    const Eigen::MatrixXd map = tendon_jacobian(arm, drive, state);
    EXPECT_LE((map * (packed(state) - straight) - vector_of(tendon_displacements(arm, drive, state)))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-14);
    drive.disks = random.integer(1, 12);
    const NumericalJacobian numerical = numerical_jacobian(
        [&](const Eigen::VectorXd& q) -> Eigen::VectorXd {
          return vector_of(tendon_displacements(arm, drive, unpacked(q)));
        },
        packed(state));
    EXPECT_LE((tendon_jacobian(arm, drive, state) - numerical.value).cwiseAbs().maxCoeff(), 1e-10);
  });
}

void expect_state_near(const ArmState& found, const ArmState& desired, double tolerance) {
  for (std::size_t i = 0; i < desired.bends.size(); ++i) {
    EXPECT_LE((found.bends[i] - desired.bends[i]).norm(), tolerance) << i;
    EXPECT_NEAR(found.stretches[i], desired.stretches[i], tolerance) << i;
  }
}

TEST(Tendons, LeadBackToTheStateTheyCameFrom) {
  for_random_cases(300, [](TestRandom& random) {
    Arm arm = random_arm(random);
    ArmState state = gentle_state(random, arm);
    for (std::size_t i = 0; i < arm.sections.size(); ++i) {
      if (random.integer(0, 1) == 1) {
        arm.sections[i].stretch_limits = {0.5, 1.5};
      } else {
        state.stretches[i] = 1;
      }
    }
    Drive drive = random_drive(random, arm);
    if (random.integer(0, 1) == 1) drive.disks = random.integer(2, 12);
    const TendonFit fit = fit_state(arm, drive, tendon_displacements(arm, drive, state));
    EXPECT_TRUE(fit.converged);
    expect_state_near(fit.state, state, 1e-10);
    EXPECT_LE(vector_of(fit.residual).cwiseAbs().maxCoeff(), 1e-13);
  });
}

TEST(Tendons, TwoASectionAreEnoughForAnArmThatDoesNotStretch) {
  for_random_cases(100, [](TestRandom& random) {
    const Arm arm = random_arm(random);
    ArmState state = gentle_state(random, arm);
    std::ranges::fill(state.stretches, 1.0);
    Drive drive = random_scanty_drive(random, arm);
    ASSERT_EQ(drive.tendons.size(), 2 * arm.sections.size());
    if (random.integer(0, 1) == 1) drive.disks = random.integer(10, 30);
    const TendonFit fit = fit_state(arm, drive, tendon_displacements(arm, drive, state));
    EXPECT_TRUE(fit.converged);
    expect_state_near(fit.state, state, 1e-9);
  });
}

TEST(Tendons, OneASectionIsEnoughInAPlane) {
  const Arm arm = paper_arm();
  Drive drive;
  for (std::size_t i = 0; i < 8; ++i) drive.tendons.push_back({i, 0.1, i % 2 == 0 ? 0 : std::numbers::pi});
  const TendonFit fit = fit_state(arm, drive, tendon_displacements(arm, drive, paper_state()));
  expect_state_near(fit.state, paper_state(), 1e-13);
}

TEST(Tendons, ThatDisagreeGiveTheLeastSquaresStateAndSayWhichHangsSlack) {
  for_random_cases(100, [](TestRandom& random) {
    Arm arm = random_arm(random);
    const Drive drive = random_drive(random, arm);
    TendonDisplacements given = tendon_displacements(arm, drive, gentle_state(random, arm));
    for (double& pulled : given.pulled) pulled += random.uniform(-1e-3, 1e-3);
    const TendonFit fit = fit_state(arm, drive, given);
    EXPECT_TRUE(fit.converged);
    // At the least sum of squares over all tendons no bend makes it smaller.
    const Eigen::VectorXd slope =
        tendon_jacobian(arm, drive, fit.state).transpose() * vector_of(fit.residual);
    for (Eigen::Index i = 0; i < slope.size(); i += 3) {
      EXPECT_LE(slope.segment<2>(i).norm(), 1e-14) << i / 3;
    }
  });
  Arm arm;
  arm.kind = ArmKind::spatial;
  arm.sections = {{.length = 0.3}};
  Drive drive;
  for (int i = 0; i < 4; ++i) drive.tendons.push_back({0, 0.01, i * std::numbers::pi / 2});
  const TendonFit fit = fit_state(arm, drive, {{5e-3, 0, -7e-3, 0}});
  EXPECT_NEAR(fit.state.bends[0].x(), 0.6, 1e-15);
  EXPECT_NEAR(fit.residual.pulled[0], -1e-3, 1e-16) << "6 mm wanted, 5 pulled in";
  EXPECT_NEAR(fit.residual.pulled[2], -1e-3, 1e-16) << "6 mm let out would do";
}

TEST(Tendons, SpeedsStayBelowTheirBounds) {
  for_random_cases(100, [](TestRandom& random) {
    Arm arm = random_arm(random);
    for (Section& section : arm.sections) section.stretch_limits = {0.7, 1.4};
    Drive drive = random_drive(random, arm);
    if (random.integer(0, 1) == 1) drive.disks = random.integer(1, 5);
    const ArmState from = random_state(random, arm);
    const ArmState to = random_state(random, arm);
    std::vector<SectionRates> rates(arm.sections.size());
    for (std::size_t i = 0; i < arm.sections.size(); ++i) {
      rates[i] = {(to.bends[i] - from.bends[i]).norm(), std::abs(to.stretches[i] - from.stretches[i])};
    }
    const std::vector<double> bounds = tendon_speed_bounds(arm, drive, rates);
    const Eigen::VectorXd direction = packed(to) - packed(from);
    for (double at = 0; at <= 1; at += 1.0 / 64) {
      const Eigen::VectorXd speeds = tendon_jacobian(arm, drive, interpolate(from, to, at)) * direction;
      for (std::size_t t = 0; t < bounds.size(); ++t)
        EXPECT_LE(std::abs(speeds(static_cast<Eigen::Index>(t))), bounds[t] * (1 + 1e-12));
    }
  });
}

TEST(Tendons, SpeedBoundsAreReachedByAPureBendTowardsTheTendon) {
  Arm arm;
  arm.sections = {{.length = 0.3}};
  Drive drive;
  drive.tendons = {{0, 0.01, 0}};
  EXPECT_NEAR(tendon_speed_bounds(arm, drive, std::vector<SectionRates>{{2.0, 0.5}})[0], 0.02 + 0.15, 1e-16);
}

TEST(Tendons, RefuseWhatDoesNotFit) {
  Arm arm;
  arm.sections = {{.length = 0.3}};
  Drive drive;
  drive.tendons = {{0, 0.01, 0}};
  EXPECT_THROW((void)tendon_displacements(arm, drive, ArmState::straight(2)), std::invalid_argument);
  EXPECT_THROW((void)fit_state(arm, drive, {{0, 0}}), std::invalid_argument);
  drive.tendons[0].section = 1;
  EXPECT_THROW((void)tendon_displacements(arm, drive, ArmState::straight(1)), std::invalid_argument);
  EXPECT_THROW((void)fit_state(arm, drive, {{0}}), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
