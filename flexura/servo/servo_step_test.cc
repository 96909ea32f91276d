#include "flexura/servo/servo_step.h"

#include <gtest/gtest.h>

#include <string>

#include "flexura/base/table.h"

namespace flexura {
namespace {

Node written(const ServoStep& step) { return fields_of(&step).write(step); }

std::string keys_of(const Node& node) {
  std::string keys;
  for (const Node::Member& member : *node.as<Node::Table>()) keys += member.key + " ";
  return keys;
}

ServoStep whole_step() {
  ServoStep step;
  step.time = 0.5, step.seen_at = 0.25;
  step.desired = {{{0.1, 0.2}}, {1.1}}, step.seen = {{{0.3, 0.4}}, {1.2}}, step.sent = {{{0.5, 0.6}}, {1.3}};
  step.heads = {{"side", 0.01, 0.02, 1.5}}, step.lengths = {0.7};
  step.error = {0.01, 0.02, 0.03};
  step.truth = {{{0.7, 0.8}, {0.9, 1}}, {0.35, 0.36}, {0.04, 0.05, 0.06}};
  step.potential = 2, step.is_fresh = step.is_singular = true, step.limited = "section 1";
  return step;
}

// The log's keys are flat and in their order, independent of the struct's members.
TEST(ServoStep, IsWrittenUnderTheLogsKeys) {
  EXPECT_EQ(keys_of(written(whole_step())),
            "time seen_at desired desired_stretches seen seen_stretches sent sent_stretches heads lengths "
            "truth true_lengths rms most tip true_rms true_most true_tip potential fresh singular limited ");
  EXPECT_EQ(keys_of(written({})),
            "time desired desired_stretches sent sent_stretches lengths potential fresh singular ");
}

TEST(ServoStep, IsReadBackAsItWasWritten) {
  const ServoStep step = whole_step(), read = read_as<ServoStep>(written(step));
  EXPECT_EQ(read.time, step.time);
  EXPECT_EQ(read.seen_at, step.seen_at);
  EXPECT_EQ(read.desired, step.desired);
  EXPECT_EQ(read.seen, step.seen);
  EXPECT_EQ(read.sent, step.sent);
  ASSERT_EQ(read.heads.size(), 1U);
  EXPECT_EQ(read.heads[0].camera, "side");
  EXPECT_EQ(read.heads[0].zoom, 1.5);
  EXPECT_EQ(read.lengths, step.lengths);
  ASSERT_TRUE(read.error && read.truth);
  EXPECT_EQ(read.error->rms, 0.01);
  EXPECT_EQ(read.error->most, 0.02);
  EXPECT_EQ(read.error->tip, 0.03);
  EXPECT_EQ(read.truth->bends, step.truth->bends);
  EXPECT_EQ(read.truth->lengths, step.truth->lengths);
  EXPECT_EQ(read.truth->error.rms, 0.04);
  EXPECT_EQ(read.truth->error.most, 0.05);
  EXPECT_EQ(read.truth->error.tip, 0.06);
  EXPECT_TRUE(read.is_fresh && read.is_singular);
  EXPECT_EQ(read.limited, "section 1");
  const ServoStep nothing = read_as<ServoStep>(written({}));
  EXPECT_FALSE(nothing.seen || nothing.error || nothing.truth || nothing.seen_at);
  EXPECT_TRUE(nothing.heads.empty() && nothing.limited.empty());
}

}  // namespace
}  // namespace flexura
