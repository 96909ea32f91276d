#include "flexura/kinematics/batch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "flexura/kinematics/spatial.h"
#include "tests/support/arms.h"

namespace flexura {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

// The numbers that a batch's spans show.
struct Numbers {
  std::size_t count = 0;
  std::vector<double> bend_x, bend_y, stretch;

  [[nodiscard]] BatchStates states() const { return {count, bend_x, bend_y, stretch}; }
  [[nodiscard]] ArmState state(std::size_t arm, std::size_t sections) const {
    ArmState result = ArmState::straight(sections);
    for (std::size_t i = 0; i < sections; ++i) {
      const std::size_t at = i * count + arm;
      result.bends[i] = {bend_x[at], bend_y.empty() ? 0.0 : bend_y[at]};
      if (!stretch.empty()) result.stretches[i] = stretch[at];
    }
    return result;
  }
};

Numbers random_numbers(TestRandom& random, const Arm& arm, std::size_t count, bool stretches) {
  Numbers numbers;
  numbers.count = count;
  const std::size_t sections = arm.sections.size();
  numbers.bend_x.resize(sections * count);
  if (arm.kind == ArmKind::spatial) numbers.bend_y.resize(sections * count);
  if (stretches) numbers.stretch.resize(sections * count);
  for (std::size_t j = 0; j < count; ++j) {
    const ArmState state = random_state(random, arm);
    for (std::size_t i = 0; i < sections; ++i) {
      numbers.bend_x[i * count + j] = state.bends[i].x();
      if (arm.kind == ArmKind::spatial) numbers.bend_y[i * count + j] = state.bends[i].y();
      if (stretches) numbers.stretch[i * count + j] = state.stretches[i];
    }
  }
  return numbers;
}

Arm random_arm_of_kind(TestRandom& random, ArmKind kind) {
  Arm arm = random_arm(random);
  arm.kind = kind;
  return arm;
}

// All that a batch can be asked for.
struct Answers {
  std::vector<double> tips, frames, points, jacobian_tips, jacobians;
  bool operator==(const Answers& other) const {
    const auto same = [](const std::vector<double>& a, const std::vector<double>& b) {
      return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), 8 * a.size()) == 0);
    };
    return same(tips, other.tips) && same(frames, other.frames) && same(points, other.points) &&
           same(jacobian_tips, other.jacobian_tips) && same(jacobians, other.jacobians);
  }
};

Answers answers_of(const Arm& arm, const Numbers& numbers, SimdPath path) {
  const BatchKinematics kinematics(arm, path);
  const BatchStates states = numbers.states();
  const std::size_t frames = arm.sections.size() + 1;
  Answers answers;
  answers.tips.resize(12 * numbers.count, 7.0);
  answers.frames.resize(12 * frames * numbers.count, 7.0);
  answers.points.resize(3 * frames * numbers.count, 7.0);
  answers.jacobian_tips.resize(12 * numbers.count, 7.0);
  answers.jacobians.resize(6 * kinematics.jacobian_columns(states) * numbers.count, 7.0);
  kinematics.tips(states, answers.tips);
  kinematics.section_frames(states, answers.frames);
  kinematics.base_points(states, answers.points);
  kinematics.tip_jacobians(states, answers.jacobian_tips, answers.jacobians);
  return answers;
}

// Arm j's column of numbers.
Eigen::VectorXd picked(const std::vector<double>& rows, std::size_t count, std::size_t j) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(rows.size() / count));
  for (Eigen::Index row = 0; row < result.size(); ++row)
    result[row] = rows[static_cast<std::size_t>(row) * count + j];
  return result;
}

Eigen::VectorXd flat(const std::vector<Pose>& poses, bool with_rotation) {
  const Eigen::Index rows = with_rotation ? 12 : 3;
  Eigen::VectorXd result(rows * static_cast<Eigen::Index>(poses.size()));
  Eigen::Index at = 0;
  for (const Pose& pose : poses) {
    result.segment<3>(at) = pose.position;
    if (with_rotation) result.segment<9>(at + 3) = pose.rotation.reshaped();
    at += rows;
  }
  return result;
}

// The columns of a 6 x 3n Jacobian that a batch has.
Eigen::VectorXd kept_columns(const Jacobian& J, ArmKind kind, bool stretches) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index column = 0; column < J.cols(); ++column) {
    if (column % 3 == 1 && kind == ArmKind::planar) continue;
    if (column % 3 == 2 && !stretches) continue;
    kept.push_back(column);
  }
  return J(Eigen::all, kept).reshaped();
}

// Differences in parts of the arm's reach (or of 1, for what is no length).
double scale_of(const Arm& arm) { return 1.0 + arm.X_WB.position.norm() + 1.4 * arm.length(); }

void expect_as_one_by_one(const Arm& arm, const Numbers& numbers) {
  const Answers answers = answers_of(arm, numbers, best_simd_path());
  const double tolerance = 1e-14 * scale_of(arm);
  for (std::size_t j = 0; j < numbers.count; ++j) {
    SCOPED_TRACE(j);
    const ArmState state = numbers.state(j, arm.sections.size());
    const std::vector<Pose> frames = section_frames(arm, state);
    const Eigen::VectorXd J = kept_columns(tip_jacobian(arm, state), arm.kind, !numbers.stretch.empty());
    const auto off = [&](const std::vector<double>& rows, const Eigen::VectorXd& expected) {
      return (picked(rows, numbers.count, j) - expected).cwiseAbs().maxCoeff();
    };
    EXPECT_LE(off(answers.frames, flat(frames, true)), tolerance);
    EXPECT_LE(off(answers.points, flat(frames, false)), tolerance);
    EXPECT_LE(off(answers.tips, flat({frames.back()}, true)), tolerance);
    EXPECT_LE(off(answers.jacobian_tips, flat({frames.back()}, true)), tolerance);
    EXPECT_LE(off(answers.jacobians, J), tolerance);
  }
}

TEST(Batch, AgreesWithOneArmAtATimeTo1em14) {
  for (const ArmKind kind : {ArmKind::spatial, ArmKind::planar}) {
    for_random_cases(60, [kind](TestRandom& random) {
      const Arm arm = random_arm_of_kind(random, kind);
      const auto count = static_cast<std::size_t>(random.integer(1, 40));
      expect_as_one_by_one(arm, random_numbers(random, arm, count, random.integer(0, 1) == 1));
    });
  }
}

TEST(Batch, GivesTheSameBitsOnEveryPathAndForEveryTail) {
  for (const ArmKind kind : {ArmKind::spatial, ArmKind::planar}) {
    for_random_cases(12, [kind](TestRandom& random) {
      const Arm arm = random_arm_of_kind(random, kind);
      for (std::size_t count = 0; count <= 35; ++count) {
        const Numbers numbers = random_numbers(random, arm, count, random.integer(0, 1) == 1);
        const Answers expected = answers_of(arm, numbers, SimdPath::baseline);
        for (const SimdPath path : available_simd_paths()) {
          EXPECT_TRUE(answers_of(arm, numbers, path) == expected) << name_of(path) << ", " << count;
        }
      }
    });
  }
}

TEST(Batch, GivesOneStateTheSameBitsAsInABatch) {
  for_random_cases(50, [](TestRandom& random) {
    const Arm arm = random_arm(random);
    const std::size_t sections = arm.sections.size();
    const Numbers numbers = random_numbers(random, arm, 13, true);
    const Answers answers = answers_of(arm, numbers, best_simd_path());
    const BatchKinematics kinematics(arm);
    Jacobian J(6, 3 * static_cast<Eigen::Index>(sections));
    for (std::size_t j = 0; j < numbers.count; ++j) {
      const ArmState state = numbers.state(j, sections);
      EXPECT_EQ(flat({kinematics.tip(state)}, true), picked(answers.tips, numbers.count, j));
      EXPECT_EQ(flat({kinematics.tip_jacobian(state, J)}, true),
                picked(answers.jacobian_tips, numbers.count, j));
      EXPECT_EQ(Eigen::VectorXd(J.reshaped()), picked(answers.jacobians, numbers.count, j));
    }
  });
}

TEST(Batch, HoldsFromAlmostStraightToManyTurns) {
  for (const double bend : {0.0, 5e-324, 1e-300, 1e-160, 1e-154, 1e-12, 1e-8, 1e-4, 0.1, 1.9999, 2.0, 2.0001,
                            std::numbers::pi, 2 * std::numbers::pi, 9.0, 12.5, 1000.0}) {
    SCOPED_TRACE(bend);
    for_random_cases(5, [bend](TestRandom& random) {
      const Arm arm = random_arm(random);
      Numbers numbers = random_numbers(random, arm, 9, true);
      for (std::size_t at = 0; at < numbers.bend_x.size(); ++at) {
        const Eigen::Vector2d b = bend * random.vector<2>(-1.0, 1.0).normalized();
        numbers.bend_x[at] = b.x();
        numbers.bend_y[at] = b.y();
      }
      // The scalar functions take the sine and cosine of the same |bend|, rounded; a thousand radians round
      // to 1e-13.
      if (bend < 100.0) expect_as_one_by_one(arm, numbers);
      const Answers expected = answers_of(arm, numbers, SimdPath::baseline);
      for (const SimdPath path : available_simd_paths()) {
        EXPECT_TRUE(answers_of(arm, numbers, path) == expected) << name_of(path);
      }
    });
  }
}

// Near straight, relative to each number itself: the tip of one section moves aside by length * bend / 2.
TEST(Batch, IsExactTo1em14RelativeNearStraight) {
  Arm arm;
  arm.kind = ArmKind::spatial;
  arm.X_WB = Pose{};
  arm.sections.emplace_back().length = 2.0;
  for (double bend = 1e-12; bend < 1e-3; bend *= 3.0) {
    SCOPED_TRACE(bend);
    Jacobian J(6, 3);
    const Pose tip = BatchKinematics(arm).tip_jacobian({{{bend, 0.0}}, {1.0}}, J);
    const double squared = bend * bend;
    EXPECT_NEAR(tip.position.x() / bend, 1.0 - squared / 12, 1e-14);
    EXPECT_NEAR(J(0, 0), 1.0 - squared / 4, 1e-14);
    EXPECT_NEAR(J(2, 0) / bend, -2.0 / 3.0 + squared / 15, 1e-14);
    EXPECT_NEAR(J(3, 1), squared / 6 - 1.0, 1e-14);
    EXPECT_NEAR(J(5, 1) / bend, 0.5 - squared / 24, 1e-14);
  }
}

TEST(Batch, KeepsWhatIsNotFiniteToItsOwnArm) {
  TestRandom random(1);
  for (const ArmKind kind : {ArmKind::spatial, ArmKind::planar}) {
    Arm arm = random_arm_of_kind(random, kind);
    const Numbers good = random_numbers(random, arm, 11, true);
    const Answers expected = answers_of(arm, good, best_simd_path());
    for (const double bad : {not_a_number, infinity, -infinity, 1e200}) {
      Numbers numbers = good;
      numbers.bend_x[2] = bad;
      for (const SimdPath path : available_simd_paths()) {
        const Answers answers = answers_of(arm, numbers, path);
        const bool is_planar_and_finite = kind == ArmKind::planar && std::isfinite(bad);
        EXPECT_EQ(picked(answers.tips, 11, 2).allFinite(), is_planar_and_finite);
        for (const std::size_t j : {0u, 1u, 3u, 4u, 10u}) {
          EXPECT_EQ(picked(answers.tips, 11, j), picked(expected.tips, 11, j));
          EXPECT_EQ(picked(answers.jacobians, 11, j), picked(expected.jacobians, 11, j));
        }
      }
    }
  }
}

TEST(Batch, EndsThePapersArmWhereThePaperSays) {
  const ArmState state = paper_state();
  std::vector<double> bend_x;
  bend_x.reserve(8);
  for (const Eigen::Vector2d& bend : state.bends) bend_x.push_back(bend.x());
  std::vector<double> points(27);
  BatchKinematics(paper_arm()).base_points({1, bend_x, {}, {}}, points);
  EXPECT_NEAR(points[24], -10.737859, 5e-7);
  EXPECT_NEAR(points[25], 5.201359, 5e-7);
  EXPECT_EQ(points[26], 0.0);
}

TEST(Batch, TakesAnArmOfMoreSectionsThanUsual) {
  TestRandom random(2);
  Arm arm;
  arm.kind = ArmKind::spatial;
  for (int i = 0; i < 40; ++i) arm.sections.emplace_back().length = random.uniform(0.1, 0.3);
  const ArmState state = random_state(random, arm);
  Jacobian J(6, 120);
  const Pose tip = BatchKinematics(arm).tip_jacobian(state, J);
  EXPECT_LE((tip.position - tip_pose(arm, state).position).norm(), 1e-13);
  EXPECT_LE((J - tip_jacobian(arm, state)).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(Batch, TakesAnEmptyVectorWithMemoryOfItsOwnForNone) {
  const Arm arm = paper_arm();
  std::vector<double> bend_x(8, 0.3), reserved(100, 9.0), expected(12), tip(12);
  reserved.clear();
  BatchKinematics(arm).tips({1, bend_x, {}, {}}, expected);
  BatchKinematics(arm).tips({1, bend_x, reserved, reserved}, tip);
  EXPECT_EQ(tip, expected);
}

TEST(Batch, WritesAJacobianIntoPartOfATallerMatrix) {
  const BatchKinematics kinematics(paper_arm());
  Jacobian expected(6, 24);
  kinematics.tip_jacobian(paper_state(), expected);
  Eigen::MatrixXd tall = Eigen::MatrixXd::Constant(9, 24, 7.0);
  kinematics.tip_jacobian(paper_state(), tall.middleRows<6>(2));
  EXPECT_EQ(Eigen::MatrixXd(tall.middleRows<6>(2)), Eigen::MatrixXd(expected));
  EXPECT_EQ(tall.topRows<2>().minCoeff(), 7.0);
  EXPECT_EQ(tall.bottomRows<1>().maxCoeff(), 7.0);
}

TEST(Batch, RefusesSizesThatDoNotFit) {
  Arm arm = paper_arm();
  arm.kind = ArmKind::spatial;
  const BatchKinematics spatial(arm);
  const BatchKinematics planar(paper_arm());
  const std::vector<double> n16(16), n15(15);
  std::vector<double> frames(24), wrong(25), jacobians(192);
  EXPECT_NO_THROW(spatial.tips({2, n16, n16, {}}, frames));
  EXPECT_NO_THROW(planar.tips({2, n16, {}, n16}, frames));
  EXPECT_THROW(spatial.tips({2, n15, n16, {}}, frames), std::invalid_argument);
  EXPECT_THROW(spatial.tips({2, n16, n15, {}}, frames), std::invalid_argument);
  EXPECT_THROW(spatial.tips({2, n16, {}, {}}, frames), std::invalid_argument);
  EXPECT_THROW(planar.tips({2, n16, n16, {}}, frames), std::invalid_argument);
  EXPECT_THROW(spatial.tips({2, n16, n16, n15}, frames), std::invalid_argument);
  EXPECT_THROW(spatial.tips({2, n16, n16, {}}, wrong), std::invalid_argument);
  EXPECT_THROW(spatial.section_frames({2, n16, n16, {}}, frames), std::invalid_argument);
  EXPECT_THROW(spatial.base_points({2, n16, n16, {}}, frames), std::invalid_argument);
  EXPECT_NO_THROW(spatial.tip_jacobians({2, n16, n16, {}}, frames, jacobians));
  EXPECT_THROW(spatial.tip_jacobians({2, n16, n16, n16}, frames, jacobians), std::invalid_argument);
  EXPECT_THROW(spatial.tip_jacobians({2, n16, n16, {}}, wrong, jacobians), std::invalid_argument);
  Jacobian J(6, 21);
  EXPECT_THROW(spatial.tip_jacobian(paper_state(), J), std::invalid_argument);
  EXPECT_THROW((void)spatial.tip(ArmState::straight(3)), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
