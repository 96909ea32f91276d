#include "flexura/model/actuation.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

#include "flexura/model/arm_model.h"
#include "tests/support/arms.h"

namespace flexura {
namespace {

// Returns an arm with sections of up to five arcs that share the bend arbitrarily.
Arm uneven_arm(TestRandom& random) {
  Arm arm = random_arm(random);
  for (Section& section : arm.sections) {
    if (random.integer(0, 3) == 0) continue;
    std::vector<double> profile(static_cast<std::size_t>(random.integer(1, 5)));
    for (double& part : profile) part = random.uniform(0, 2);
    profile.front() += 0.1;
    section.bend_profile = profile;
    section.radius = {random.uniform(0.01, 0.05), random.uniform(0.01, 0.05)};
  }
  return arm;
}

TEST(Actuation, SharesTheBendAndKeepsTheLength) {
  for_random_cases(200, [](TestRandom& random) {
    const Arm arm = uneven_arm(random);
    const ArmModel model(arm);
    const ArmState command = random_state(random, arm);
    const ArmState shape = model.actuation().shape(command);
    ASSERT_EQ(shape.bends.size(), model.shaped().sections.size());
    ArmState sums = ArmState::straight(arm.sections.size());
    std::vector<double> lengths(arm.sections.size(), 0);
    for (std::size_t arc = 0; arc < shape.bends.size(); ++arc) {
      const std::size_t section = model.actuation().section_of()[arc];
      sums.bends[section] += shape.bends[arc];
      lengths[section] += model.shaped().sections[arc].length;
      EXPECT_EQ(shape.stretches[arc], command.stretches[section]);
    }
    for (std::size_t i = 0; i < arm.sections.size(); ++i) {
      EXPECT_LE((sums.bends[i] - command.bends[i]).norm(), 1e-14 * (1 + command.bends[i].norm()));
      EXPECT_NEAR(lengths[i], arm.sections[i].length, 1e-14);
    }
    EXPECT_NEAR(model.backbone(command).rest_length(), arm.length(), 1e-13);
  });
}

TEST(Actuation, FindsTheCommandOfAShape) {
  for_random_cases(200, [](TestRandom& random) {
    const Arm arm = uneven_arm(random);
    const Actuation actuation(arm);
    const ArmState command = random_state(random, arm);
    const ArmState found = actuation.command(actuation.shape(command));
    for (std::size_t i = 0; i < arm.sections.size(); ++i) {
      EXPECT_LE((found.bends[i] - command.bends[i]).norm(), 1e-13 * (1 + command.bends[i].norm()));
      EXPECT_NEAR(found.stretches[i], command.stretches[i], 1e-13);
    }
  });
}

// An arm that sags: each section's bend differs from the command by a part of all bends, and by their
// squares.
class SaggingResponse : public ArmResponse {
 public:
  SaggingResponse(TestRandom& random, std::size_t sections) : mixing_(2 * sections, 2 * sections) {
    for (double& part : mixing_.reshaped()) part = random.uniform(-0.08, 0.08);
  }
  [[nodiscard]] ArmState shape(const ArmState& command) const override {
    ++asked;
    ArmState shape = command;
    Eigen::VectorXd bends(mixing_.rows());
    for (std::size_t i = 0; i < command.bends.size(); ++i)
      bends.segment<2>(2 * static_cast<Eigen::Index>(i)) = command.bends[i];
    const Eigen::VectorXd sag = mixing_ * bends + 0.02 * bends.cwiseAbs2();
    for (std::size_t i = 0; i < command.bends.size(); ++i)
      shape.bends[i] += sag.segment<2>(2 * static_cast<Eigen::Index>(i));
    return shape;
  }
  void slopes(const ArmState&, Eigen::MatrixXd&) const override { ADD_FAILURE() << "not needed"; }
  mutable int asked = 0;

 private:
  Eigen::MatrixXd mixing_;
};

// Each shape costs the equilibrium of a rod: so few steps may be needed.
TEST(Actuation, FindsTheCommandOfASaggingArmInFewSteps) {
  int most = 0;
  for_random_cases(200, [&](TestRandom& random) {
    const Arm arm = random_arm(random);
    const auto response = std::make_shared<SaggingResponse>(random, arm.sections.size());
    const Actuation actuation(arm, response);
    ArmState command = ArmState::straight(arm.sections.size());
    for (Eigen::Vector2d& bend : command.bends) bend = {random.uniform(-1, 1), random.uniform(-1, 1)};
    const ArmState shape = actuation.shape(command);
    response->asked = 0;
    const ArmState found = actuation.command(shape);
    for (std::size_t i = 0; i < arm.sections.size(); ++i)
      EXPECT_LE((found.bends[i] - command.bends[i]).norm(), 2e-12);
    most = std::max(most, response->asked);
  });
  // Without Broyden's update 20 are not enough.
  EXPECT_LE(most, 16);
}

// If no command makes a shape, no other command's shape may be nearer to it.
TEST(Actuation, FindsTheNearestCommand) {
  for_random_cases(200, [](TestRandom& random) {
    const Arm arm = uneven_arm(random);
    const ArmModel model(arm);
    const Actuation& actuation = model.actuation();
    const ArmState shape = random_state(random, model.shaped());
    const auto distance = [&](const ArmState& command) {
      return (packed(actuation.shape(command)) - packed(shape)).squaredNorm();
    };
    const ArmState nearest = actuation.command(shape);
    ArmState other = nearest;
    for (Eigen::Vector2d& bend : other.bends) bend += 1e-3 * random.vector<2>(-1, 1);
    for (double& stretch : other.stretches) stretch += 1e-3 * random.uniform(-1, 1);
    EXPECT_LE(distance(nearest), distance(other) * (1 + 1e-12));
  });
}

TEST(Actuation, TakesDerivativesByShapesToThoseByCommands) {
  for_random_cases(100, [](TestRandom& random) {
    const Arm arm = uneven_arm(random);
    const ArmModel model(arm);
    const Eigen::VectorXd command = packed(random_state(random, arm));
    const auto state_of = [](const Eigen::VectorXd& x) {
      ArmState state;
      for (Eigen::Index i = 0; i < x.size(); i += 3) {
        state.bends.emplace_back(x[i], x[i + 1]);
        state.stretches.push_back(x[i + 2]);
      }
      return state;
    };
    // Any linear function of the shape.
    const Eigen::MatrixXd by_shape =
        Eigen::MatrixXd::NullaryExpr(4, 3 * static_cast<Eigen::Index>(model.shaped().sections.size()),
                                     [&] { return random.uniform(-1, 1); });
    Eigen::MatrixXd by_command;
    model.actuation().by_command(by_shape, state_of(command), by_command);
    Eigen::MatrixXd slopes;
    model.actuation().slopes(state_of(command), slopes);
    EXPECT_LE((by_shape * slopes - by_command).norm(), 1e-14 * by_command.norm());
    ASSERT_EQ(by_command.cols(), command.size());
    const auto value = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
      return by_shape * packed(model.actuation().shape(state_of(x)));
    };
    const Eigen::VectorXd zero = value(Eigen::VectorXd::Zero(command.size()));
    EXPECT_LE((by_command * command - (value(command) - zero)).norm(), 1e-12 * (1 + value(command).norm()));
  });
}

TEST(Actuation, OfSingleArcsIsNoneAtAll) {
  for_random_cases(50, [](TestRandom& random) {
    const Arm arm = random_arm(random);
    const ArmModel model(arm);
    const ArmState state = random_state(random, arm);
    EXPECT_TRUE(model.actuation().is_identity());
    EXPECT_EQ(model.actuation().shape(state), state);
    EXPECT_EQ(model.actuation().command(state), state);
    const Backbone one = model.backbone(state), other(arm, state);
    EXPECT_EQ(one.tip().position, other.tip().position);
    EXPECT_EQ(one.tip().rotation, other.tip().rotation);
  });
}

// Arcs with equal shares are the arc that they divide.
TEST(Actuation, OfEvenProfilesMakesTheSameBackbone) {
  for_random_cases(50, [](TestRandom& random) {
    const Arm plain = random_arm(random);
    Arm fine = plain;
    for (Section& section : fine.sections)
      section.bend_profile = std::vector<double>(static_cast<std::size_t>(random.integer(1, 6)), 3.0);
    const ArmState state = random_state(random, plain);
    const Backbone one(plain, state), other = ArmModel(fine).backbone(state);
    for (double s = 0; s <= 1; s += 0.1) {
      const Pose a = one.pose(s * one.length()), b = other.pose(s * other.length());
      EXPECT_LE((a.position - b.position).norm(), 1e-12 * one.length()) << s;
      EXPECT_LE((a.rotation - b.rotation).norm(), 1e-12) << s;
    }
  });
}

TEST(Actuation, RefusesWhatIsNoProfile) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::vector<double>& profile :
       {std::vector<double>{}, {0, 0}, {1, -1}, {nan, 1}, {std::numeric_limits<double>::infinity()}}) {
    Arm arm = paper_arm();
    arm.sections[1].bend_profile = profile;
    EXPECT_THROW(Actuation{arm}, std::invalid_argument);
  }
  const Actuation actuation(paper_arm());
  EXPECT_THROW((void)actuation.shape(ArmState::straight(7)), std::invalid_argument);
  EXPECT_THROW((void)actuation.command(ArmState::straight(9)), std::invalid_argument);
  EXPECT_THROW((void)actuation.with_gains({1, 2}), std::invalid_argument);
  Eigen::MatrixXd out;
  EXPECT_THROW(actuation.by_command(Eigen::MatrixXd::Zero(2, 9), ArmState::straight(8), out),
               std::invalid_argument);
}

TEST(Actuation, OfNothingIsTheIdentity) {
  const ArmState state{{{0.1, 0.2}, {0.3, 0.4}}, {1, 1.5}};
  EXPECT_EQ(Actuation().shape(state), state);
  EXPECT_EQ(Actuation().command(state), state);
  const Eigen::MatrixXd by_shape = Eigen::MatrixXd::Random(2, 6);
  Eigen::MatrixXd by_command;
  Actuation().by_command(by_shape, state, by_command);
  EXPECT_EQ(by_command, by_shape);
}

}  // namespace
}  // namespace flexura
