#include "flexura/view/state_message.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "flexura/math/so3.h"
#include "flexura/model/backbone.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

Arm arm_of(std::size_t sections) {
  Arm arm;
  arm.kind = ArmKind::spatial;
  for (std::size_t i = 0; i < sections; ++i)
    arm.sections.push_back({.length = 0.3 + 0.1 * static_cast<double>(i)});
  return arm;
}

ArmState random_state(TestRandom& random, std::size_t sections) {
  ArmState state = ArmState::straight(sections);
  for (Eigen::Vector2d& bend : state.bends) bend = random.vector<2>(-6, 6);
  for (double& stretch : state.stretches) stretch = random.uniform(0.5, 2);
  return state;
}

StateMessage random_message(TestRandom& random) {
  StateMessage message;
  message.is_moving = random.integer(0, 1) == 1;
  message.is_running = random.integer(0, 1) == 1;
  message.is_recording = random.integer(0, 1) == 1;
  message.is_unsafe = random.integer(0, 1) == 1;
  message.leaps = static_cast<std::uint16_t>(random.integer(0, 65535));
  message.sequence = 4000000000U + static_cast<std::uint32_t>(random.integer(0, 1000));
  message.time = random.uniform(0, 1e6);
  const auto sections = static_cast<std::size_t>(random.integer(1, 5));
  message.arm = random_state(random, sections);
  message.samples = arm_samples(Backbone(arm_of(sections), message.arm));
  for (int i = random.integer(0, 3); i > 0; --i) {
    message.cameras.push_back({{so3_exp(random.vector<3>(-1, 1)), random.vector<3>(-3, 3)},
                               {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(1, 10)},
                               random.vector<3>(-1, 1),
                               800,
                               810,
                               320,
                               240});
  }
  for (int i = random.integer(0, 9); i > 0; --i) message.displacements.push_back(random.uniform(-0.1, 0.1));
  for (int i = random.integer(0, 9); i > 0; --i)
    message.actuators.push_back(
        {random.uniform(-0.1, 0.1), random.uniform(0, 99), 10.0 * random.integer(0, 9)});
  message.is_weightless = random.integer(0, 1) == 1;
  if (random.integer(0, 1) == 1) message.energy = RodEnergy{random.uniform(0, 1), 2, random.uniform(-3, 0)};
  if (random.integer(0, 1) == 1)
    message.push = PushSample{random.uniform(0, 1), random.vector<3>(-1, 1), random.vector<3>(-5, 5)};
  if (random.integer(0, 1) == 1) message.pace = random.uniform(0, 1);
  for (int i = random.integer(0, 5); i > 0; --i)
    message.contacts.push_back({.obstacle = random.integer(-1, 3),
                                .s = random.uniform(0, 1),
                                .point = random.vector<3>(-1, 1),
                                .force = random.vector<3>(-5, 5),
                                .normal_force = random.uniform(0, 5),
                                .slip = static_cast<ContactSample::Slip>(random.integer(0, 2))});
  return message;
}

void expect_forces(const StateMessage& back, const StateMessage& message) {
  const auto near = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return (a - b).norm() < 1e-5; };
  ASSERT_EQ(back.energy.has_value(), message.energy.has_value());
  if (message.energy) {
    EXPECT_NEAR(back.energy->total(), message.energy->total(), 1e-6);
    EXPECT_EQ(back.energy->kinetic, static_cast<float>(message.energy->kinetic));
  }
  ASSERT_EQ(back.push.has_value(), message.push.has_value());
  if (message.push) {
    EXPECT_EQ(back.push->s, static_cast<float>(message.push->s));
    EXPECT_TRUE(near(back.push->to, message.push->to) && near(back.push->force, message.push->force));
  }
  ASSERT_EQ(back.pace.has_value(), message.pace.has_value());
  if (message.pace) {
    EXPECT_EQ(*back.pace, static_cast<float>(*message.pace));
  }
  ASSERT_EQ(back.contacts.size(), message.contacts.size());
  for (std::size_t i = 0; i < message.contacts.size(); ++i) {
    const ContactSample &read = back.contacts[i], &written = message.contacts[i];
    EXPECT_EQ(read.obstacle, written.obstacle);
    EXPECT_EQ(read.slip, written.slip);
    EXPECT_EQ(read.normal_force, static_cast<float>(written.normal_force));
    EXPECT_TRUE(near(read.point, written.point) && near(read.force, written.force));
  }
}

TEST(StateMessage, ReadsBackInSinglePrecision) {
  for_random_cases(100, [](TestRandom& random) {
    const StateMessage message = random_message(random);
    const auto back = read_state_message(state_message(message));
    ASSERT_TRUE(back);
    EXPECT_EQ(back->is_moving, message.is_moving);
    EXPECT_EQ(back->leaps, message.leaps);
    EXPECT_EQ(back->is_running, message.is_running);
    EXPECT_EQ(back->is_recording, message.is_recording);
    EXPECT_EQ(back->is_unsafe, message.is_unsafe);
    EXPECT_EQ(back->sequence, message.sequence);
    expect_forces(*back, message);
    EXPECT_EQ(back->time, message.time);
    ASSERT_EQ(back->samples.size(), message.samples.size());
    for (std::size_t i = 0; i < message.samples.size(); ++i) {
      EXPECT_EQ(back->samples[i].s, static_cast<float>(message.samples[i].s));
      EXPECT_TRUE(back->samples[i].X_WS.rotation.isApprox(message.samples[i].X_WS.rotation, 1e-6));
      EXPECT_TRUE(back->samples[i].X_WS.position.isApprox(message.samples[i].X_WS.position, 1e-6));
    }
    for (std::size_t i = 0; i < message.arm.bends.size(); ++i) {
      EXPECT_TRUE(back->arm.bends[i].isApprox(message.arm.bends[i], 1e-6));
      EXPECT_EQ(back->arm.stretches[i], static_cast<float>(message.arm.stretches[i]));
    }
    ASSERT_EQ(back->cameras.size(), message.cameras.size());
    for (std::size_t i = 0; i < message.cameras.size(); ++i) {
      EXPECT_NEAR(back->cameras[i].head.zoom, message.cameras[i].head.zoom, 1e-6);
      EXPECT_TRUE(back->cameras[i].stage.isApprox(message.cameras[i].stage, 1e-6));
      EXPECT_EQ(back->cameras[i].fy, 810);
    }
    ASSERT_EQ(back->displacements.size(), message.displacements.size());
    EXPECT_EQ(back->is_weightless, message.is_weightless);
    ASSERT_EQ(back->actuators.size(), message.actuators.size());
    for (std::size_t i = 0; i < message.actuators.size(); ++i) {
      EXPECT_EQ(back->actuators[i].value, static_cast<float>(message.actuators[i].value));
      EXPECT_EQ(back->actuators[i].force, static_cast<float>(message.actuators[i].force));
      EXPECT_EQ(back->actuators[i].lost, message.actuators[i].lost);
    }
  });
}

TEST(StateMessage, LiesAsTheProtocolSays) {
  StateMessage message;
  message.is_moving = message.is_unsafe = true;
  message.sequence = 0x01020304;
  message.time = 1.5;
  message.arm = {{{0.25, -0.5}}, {1.0}};
  message.samples = {{0, Pose{}}, {0.5, Pose{Eigen::Matrix3d::Identity(), {1, 2, 3}}}};
  message.displacements = {0.125};
  message.actuators = {{0.5, 2, 1}};
  const std::string bytes = state_message(message);
  ASSERT_EQ(bytes.size(), 28 + 4 * (3 + 2 * 8 + 1 + 3));
  EXPECT_EQ(bytes.substr(0, 16), std::string("\x01\x09\x01\0\x02\0\0\0\x01\0\0\0\x04\x03\x02\x01", 16));
  EXPECT_EQ(bytes.substr(16, 8), std::string("\0\0\0\0\0\0\xf8\x3f", 8));
  EXPECT_EQ(bytes.substr(24, 4), std::string("\x01\0\0\0", 4));
  EXPECT_EQ(bytes.substr(28, 8), std::string("\0\0\x80\x3e\0\0\0\xbf", 8));
  EXPECT_EQ(bytes.substr(bytes.size() - 12), std::string("\0\0\0\x3f\0\0\0\x40\0\0\x80\x3f", 12));
  // The second sample: s, then x.
  EXPECT_EQ(bytes.substr(28 + 12 + 32, 8), std::string("\0\0\0\x3f\0\0\x80\x3f", 8));
}

TEST(StateMessage, IsNoneWhenAByteIsMissingOrTooMany) {
  TestRandom random(1);
  const std::string bytes = state_message(random_message(random));
  for (std::size_t size = 0; size < bytes.size(); ++size)
    ASSERT_FALSE(read_state_message(std::string_view(bytes).substr(0, size))) << size;
  EXPECT_FALSE(read_state_message(bytes + "x"));
  EXPECT_FALSE(read_state_message("\x02" + bytes.substr(1)));
}

// Between two samples there is one arc, which is determined by the tangent at the first and the position of
// the second.
TEST(StateMessage, HasOneArcBetweenTwoSamples) {
  for_random_cases(50, [](TestRandom& random) {
    const Arm arm = arm_of(3);
    const ArmState state = random_state(random, 3);
    const Backbone backbone(arm, state);
    const auto samples = arm_samples(Backbone(arm, state));
    EXPECT_EQ(samples.front().s, 0);
    EXPECT_NEAR(samples.back().s, arm.length(), 1e-12);
    double at = 0;
    for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
      const Pose between = samples[i].X_WS.inverse() * samples[i + 1].X_WS;
      const Eigen::Vector3d turn = so3_log(between.rotation);
      EXPECT_LT(turn.norm(), std::numbers::pi / 2 + 1e-6);
      EXPECT_NEAR(turn.z(), 0, 1e-9);
      const double chord = between.position.norm(), half = turn.norm() / 2;
      const double length = half > 1e-9 ? chord * half / std::sin(half) : chord;
      const Pose end = samples[i].X_WS * arc_pose({turn.y(), -turn.x()}, length);
      EXPECT_LT((end.position - samples[i + 1].X_WS.position).norm(), 1e-9);
      const Pose middle = samples[i].X_WS * arc_pose(Eigen::Vector2d(turn.y(), -turn.x()) / 2, length / 2);
      EXPECT_LT((middle.position - backbone.pose(at + length / 2).position).norm(), 1e-9);
      at += length;
    }
    EXPECT_NEAR(at, backbone.length(), 1e-9);
  });
}

TEST(ImageMessage, LiesAsTheProtocolSays) {
  EXPECT_EQ(image_message(3, ImageFormat::png, 0x0a0b, 1.5, "file"),
            std::string("\x02\x03\x01\0\x0b\x0a\0\0\0\0\0\0\0\0\xf8\x3f", 16) + "file");
}

}  // namespace
}  // namespace flexura
