#include "flexura/app/forward.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <sstream>

#include "flexura/app/commands.h"
#include "flexura/base/degree.h"
#include "flexura/experiment/experiment.h"
#include "flexura/store/json.h"
#include "tests/support/checkout.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

const std::string paper_arm = checkout_file("examples/01_paper_arm/experiment.toml");

Arm spatial_arm() {
  return parse_experiment("[arm]\nkind='spatial'\n[[arm.section]]\nlength=1\n[[arm.section]]\nlength=2\n",
                          "x.toml")
      .arm.arm();
}

std::vector<double> numbers(const Node& node) {
  std::vector<double> values;
  for (const Node& entry : *node.as<Node::Array>()) values.push_back(*entry.as<double>());
  return values;
}

TEST(AnswerForward, GivesThePapersEndEffectorFromItsCordAngles) {
  const Arm arm = load_experiment(paper_arm).arm.arm();
  std::vector<double> angles;
  for (const double angle : {.55, .65, .8, 1., 1.15, .9, .8, .65}) angles.push_back(angle * std::numbers::pi);
  const std::string line = fmt::format(R"({{"cord_angles":[{}]}})", fmt::join(angles, ","));
  const Node answer = parse_json(answer_forward(arm, line), "answer");
  const auto tip = numbers(*answer.find("tip")->find("position"));
  EXPECT_NEAR(tip[0], -10.737859, 5e-7);
  EXPECT_NEAR(tip[1], 5.201359, 5e-7);
  EXPECT_EQ(answer.find("bases")->as<Node::Array>()->size(), 9U);
  EXPECT_EQ(answer.find("at"), nullptr);
}

TEST(AnswerForward, CountsCordAnglesFromTheBasesTangentAsItIsWritten) {
  for (int degrees = -720; degrees <= 720; degrees += 10) {
    const Arm arm =
        parse_experiment(fmt::format("[arm]\nkind='planar'\nbase.tangent_deg={}\n[[arm.section]]\nlength=2\n"
                                     "[[arm.section]]\nlength=1\n",
                                     degrees),
                         "x.toml")
            .arm.arm();
    const double angle = degrees * degree;
    const Node answer =
        parse_json(answer_forward(arm, fmt::format(R"({{"cord_angles":[{},{}]}})", angle, angle)), "answer");
    const auto tip = numbers(*answer.find("tip")->find("position"));
    EXPECT_NEAR(tip[0], 3 * std::cos(angle), 1e-12) << degrees;
    EXPECT_NEAR(tip[1], 3 * std::sin(angle), 1e-12) << degrees;
  }
}

TEST(AnswerForward, TakesTheArmsOwnLengthForAPlaceOnIt) {
  for (const double third : {0.1, 0.3, 0.7, 1.1}) {
    const Arm arm =
        parse_experiment(fmt::format("[arm]\nkind='spatial'\n[[arm.section]]\nlength={0}\n[[arm.section]]\n"
                                     "length={0}\n[[arm.section]]\nlength={0}\n",
                                     third),
                         "x.toml")
            .arm.arm();
    const std::string bends = R"("bends":[[0,0],[0,0],[0,0]],"at":[)";
    for (const double length : {3 * third, third + third + third})
      EXPECT_EQ(
          parse_json(answer_forward(arm, fmt::format("{{{}{}]}}", bends, length)), "answer").find("error"),
          nullptr);
    EXPECT_NE(parse_json(answer_forward(arm, fmt::format("{{{}{}]}}", bends, 3.001 * third)), "answer")
                  .find("error"),
              nullptr);
  }
}

TEST(AnswerForward, AnswersAlongTheArmOnlyWhenAsked) {
  const Node answer = parse_json(
      answer_forward(spatial_arm(), R"({"bends":[[0,0],[0,0]],"stretches":[1,0.5],"at":[0,1.5,2]})"),
      "answer");
  const auto& at = *answer.find("at")->as<Node::Array>();
  ASSERT_EQ(at.size(), 3U);
  EXPECT_THAT(numbers(*at[1].find("position")), ::testing::ElementsAre(0, 1.5, 0));
  EXPECT_THAT(numbers(*answer.find("tip")->find("position")), ::testing::ElementsAre(0, 2, 0));
}

TEST(AnswerForward, BendsTowardsTheBasesOwnAxes) {
  // A quarter turn towards x_B, which is +X: from direction +Y to +X, ending at (r, r) with r = 1/(pi/2).
  const Node answer =
      parse_json(answer_forward(spatial_arm(), R"({"bends":[[1.5707963267948966,0],[0,0]]})"), "answer");
  const auto base = numbers(answer.find("bases")->as<Node::Array>()->at(1));
  EXPECT_NEAR(base[0], 2 / std::numbers::pi, 1e-15);
  EXPECT_NEAR(base[1], 2 / std::numbers::pi, 1e-15);
  const auto tip = numbers(*answer.find("tip")->find("position"));
  EXPECT_NEAR(tip[0], 2 / std::numbers::pi + 2, 1e-15);
}

TEST(AnswerForward, AnswersABadLineWithItsError) {
  const Arm arm = spatial_arm();
  const std::vector<std::pair<const char*, const char*>> lines{
      {"", "not JSON"},
      {"{", "column 2: not JSON"},
      {"{}", "has no shape"},
      {"[]", "expected a table"},
      {"null", "expected a table"},
      {R"({"bends":[[0,0]]})", "bends: 1 given: expected 2"},
      {R"({"bends":[[0,0],[0]]})", "bends[1] is an array of 1: expected an array of 2"},
      {R"({"bends":[[0,0],[0,"x"]]})", "bends[1][1] = \\\"x\\\": expected a number"},
      {R"({"bends":[[0,0],[0,null]]})", "bends[1][1] = nothing: expected a number"},
      {R"({"bends":[[0,0],[0,1e300]]})", "bends[1][1] = 1e+300: expected a number from"},
      {R"({"bends":[[0,0],[0,0]],"bends":[]})", "occurs twice"},
      {R"({"archings":[0,0]})", "is for planar arms"},
      {R"({"bends":[[0,0],[0,0]],"at":[3.1]})", "at[0]: 3.1 is beyond the tip: expected at most 3 m"},
      {R"({"bends":[[0,0],[0,0]],"at":[-1]})", "at[0] = -1: expected a number at least 0 m"},
      {R"({"stretches":[0,1]})", "stretches[0] = 0: expected a number above 0"},
      {R"({"bend":[[0,0],[0,0]]})", "did you mean \\\"bends\\\"?"},
  };
  const std::string many_digits = answer_forward(arm, "{\"at\":[" + std::string(5000, '9') + "]}");
  EXPECT_THAT(many_digits, HasSubstr("number overflow parsing '99"));
  EXPECT_LT(many_digits.size(), 250U);
  for (const auto& [line, error] : lines) {
    EXPECT_THAT(answer_forward(arm, line), HasSubstr(error)) << line;
    EXPECT_THAT(answer_forward(arm, line), ::testing::StartsWith("{\"error\":")) << line;
  }
}

TEST(ForwardCommand, AnswersEveryLineInOrder) {
  std::istringstream in("{\"archings\":[0,0,0,0,0,0,0,0]}\nrubbish\n\n{\"stretches\":[1,1,1,1,1,1,1,1]}");
  std::ostringstream out;
  EXPECT_EQ(forward_command(paper_arm, in, out), exit_done);
  std::istringstream lines(out.str());
  std::vector<std::string> answers;
  for (std::string line; std::getline(lines, line);) answers.push_back(line);
  ASSERT_EQ(answers.size(), 4U);
  EXPECT_THAT(answers[0], HasSubstr("\"tip\""));
  EXPECT_THAT(answers[1], HasSubstr("\"error\""));
  EXPECT_THAT(answers[2], HasSubstr("\"error\""));
  EXPECT_EQ(answers[3], answers[0]);
}

TEST(ForwardCommand, SkipsALineThatIsTooLongWithoutLosingTheNext) {
  std::istringstream in(std::string((1 << 24) + 10, '[') + "\n{\"stretches\":[1,1,1,1,1,1,1,1]}\n");
  std::ostringstream out;
  EXPECT_EQ(forward_command(paper_arm, in, out), exit_done);
  EXPECT_THAT(out.str(), ::testing::StartsWith("{\"error\":\"the line is longer than 16 MiB\"}\n{\"tip\""));
}

}  // namespace
}  // namespace flexura
