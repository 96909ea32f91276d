#include "flexura/app/inverse.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "flexura/app/commands.h"
#include "flexura/app/forward.h"
#include "flexura/experiment/experiment.h"
#include "flexura/store/json.h"
#include "tests/support/checkout.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::string paper_arm_file = checkout_file("examples/01_paper_arm/experiment.toml");

Arm limited_arm(const std::string& limits = "max_bend_deg=120") {
  const std::string section = "[[arm.section]]\nlength=0.3\n" + limits + "\n";
  return parse_experiment("[arm]\nkind='spatial'\n" + section + section + section, "x.toml").arm.arm();
}

Node parsed(const std::string& answer) { return parse_json(answer, "answer"); }
double number(const Node& node, const char* key) { return *node.find(key)->as<double>(); }
bool flag(const Node& node, const char* key) { return *node.find(key)->as<bool>(); }
std::string text(const Node& node, const char* key) { return *node.find(key)->as<std::string>(); }

TEST(AnswerInverse, IsUndoneByForwardKinematics) {
  const Arm arm = limited_arm();
  const Node answer = parsed(answer_inverse(arm, R"({"position":[0.2,0.6,0.1],"rotation":[1,0,0,0]})"));
  EXPECT_TRUE(flag(answer, "converged"));
  EXPECT_EQ(text(answer, "reason"), "converged");
  EXPECT_EQ(answer.find("stretches"), nullptr);
  EXPECT_EQ(answer.find("nearest"), nullptr);
  const Node shape{Node::Table{{"bends", {}, *answer.find("bends")}}, {}};
  const Node tip = *parsed(answer_forward(arm, write_json(shape))).find("tip");
  const std::vector<double> desired = {0.2, 0.6, 0.1};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(*tip.find("position")->as<Node::Array>()->at(i).as<double>(), desired[i], 1e-9);
  }
  EXPECT_NEAR(*tip.find("rotation")->as<Node::Array>()->at(0).as<double>(), 1.0, 1e-9);
  EXPECT_LE(number(answer, "position_error"), 1e-9);
  EXPECT_LE(number(answer, "angle_error"), 1e-9);
}

TEST(AnswerInverse, OfAPlanarArmSaysArchings) {
  const Arm arm = load_experiment(paper_arm_file).arm.arm();
  const Node answer = parsed(answer_inverse(arm, R"({"position":[-10.738,5.201,0]})"));
  EXPECT_TRUE(flag(answer, "converged"));
  EXPECT_EQ(answer.find("archings")->as<Node::Array>()->size(), 8U);
  EXPECT_EQ(answer.find("bends"), nullptr);
  EXPECT_EQ(answer.find("angle_error"), nullptr);
  const Node shape{Node::Table{{"archings", {}, *answer.find("archings")}}, {}};
  const Node tip = *parsed(answer_forward(arm, write_json(shape))).find("tip");
  EXPECT_NEAR(*tip.find("position")->as<Node::Array>()->at(0).as<double>(), -10.738, 1e-7);
  const Node off = parsed(answer_inverse(arm, R"({"position":[-10.738,5.201,2]})"));
  EXPECT_EQ(text(off, "reason"), "not_reachable");
  EXPECT_NEAR(number(off, "distance"), 2.0, 1e-9);
  EXPECT_TRUE(flag(off, "proven"));
}

TEST(AnswerInverse, SaysStretchesWhereTheyAreFree) {
  const Arm arm = limited_arm("stretch_limits=[0.8,1.2]");
  const Node answer = parsed(answer_inverse(arm, R"({"position":[0,1.0,0]})"));
  EXPECT_TRUE(flag(answer, "converged"));
  double length = 0.0;
  for (const Node& stretch : *answer.find("stretches")->as<Node::Array>())
    length += 0.3 * *stretch.as<double>();
  EXPECT_GE(length, 1.0 - 1e-9);
}

TEST(AnswerInverse, SaysWhyNotAndWhatIsNearest) {
  const Node far = parsed(answer_inverse(limited_arm(), R"({"position":[0,1.9,0]})"));
  EXPECT_FALSE(flag(far, "converged"));
  EXPECT_EQ(text(far, "reason"), "not_reachable");
  EXPECT_TRUE(flag(far, "proven"));
  EXPECT_NEAR(number(far, "distance"), 1.0, 1e-9);
  EXPECT_NEAR(*far.find("nearest")->as<Node::Array>()->at(1).as<double>(), 0.9, 1e-9);
  const Node held = parsed(answer_inverse(limited_arm(), R"({"position":[0,0.01,0]})"));
  EXPECT_EQ(text(held, "reason"), "at_limit");
  EXPECT_EQ(number(held, "distance"), number(held, "position_error"));
}

TEST(AnswerInverse, ListsAllSolutionsWhenAsked) {
  const Node answer =
      parsed(answer_inverse(limited_arm(), R"({"position":[0.2,0.6,0.1],"rotation":[1,0,0,0],"all":true})"));
  ASSERT_GE(answer.find("solutions")->as<Node::Array>()->size(), 1U);
  EXPECT_EQ(*answer.find("solutions")
                 ->as<Node::Array>()
                 ->at(0)
                 .find("bends")
                 ->as<Node::Array>()
                 ->at(0)
                 .as<Node::Array>()
                 ->at(0)
                 .as<double>(),
            *answer.find("bends")->as<Node::Array>()->at(0).as<Node::Array>()->at(0).as<double>());
  const Node none = parsed(answer_inverse(limited_arm(), R"({"position":[0,2,0],"all":true})"));
  EXPECT_TRUE(none.find("solutions")->as<Node::Array>()->empty());
  EXPECT_EQ(text(none, "reason"), "not_reachable");
}

TEST(AnswerInverse, LaysTheArmAlongACurve) {
  const Node straight = parsed(answer_inverse(limited_arm(), R"({"curve":[[0,0,0],[0,0.9,0]]})"));
  EXPECT_TRUE(flag(straight, "converged"));
  EXPECT_LE(number(straight, "position_error"), 1e-9);
  EXPECT_NEAR(number(straight, "tolerance"), 0.9e-3, 1e-15);
  const Node longer = parsed(answer_inverse(limited_arm(), R"({"curve":[[0,0,0],[0,1.9,0]]})"));
  EXPECT_EQ(text(longer, "reason"), "not_reachable");
}

TEST(AnswerInverse, OfACurveGivenByAFewPointsAllowsForWhatLiesBetweenThemOrForWhatIsAsked) {
  // A sixth of a circle of the arm's length, given by five points.
  const std::string points =
      R"("curve":[[0.0,0.0,0],[0.02936,0.22242,0],[0.11544,0.42961,0],[0.25233,0.60736,0],[0.43065,0.74351,0]])";
  const Node plain = parsed(answer_inverse(limited_arm(), "{" + points + "}"));
  EXPECT_TRUE(flag(plain, "converged")) << number(plain, "position_error");
  EXPECT_NEAR(number(plain, "tolerance"), 0.009, 1e-12)
      << "a hundredth of the arm, and not all they leave open";
  const Node strict = parsed(answer_inverse(limited_arm(), "{" + points + R"(,"tolerance":1e-9})"));
  EXPECT_FALSE(flag(strict, "converged"));
  EXPECT_EQ(number(strict, "tolerance"), 1e-9);
  const Node loose = parsed(answer_inverse(limited_arm(), "{" + points + R"(,"tolerance":0.05})"));
  EXPECT_TRUE(flag(loose, "converged"));
  EXPECT_EQ(text(parsed(answer_inverse(limited_arm(), R"({"position":[0,0.8,0],"tolerance":0.1})")), "error"),
            "tolerance: is for a curve");
  EXPECT_NE(text(parsed(answer_inverse(limited_arm(), "{" + points + R"(,"tolerance":0})")), "error")
                .find("tolerance"),
            std::string::npos);
}

TEST(AnswerInverse, OfACoarseCurveThatTheArmMissesSaysSo) {
  // Four points on an arc of a full turn; each section can bend by at most 90 degrees.
  const Node missed = parsed(
      answer_inverse(limited_arm(), R"({"curve":[[0,0,0],[0.15,0.25,0],[0.42,0.25,0],[0.6,0.02,0]]})"));
  EXPECT_FALSE(flag(missed, "converged"));
  EXPECT_GT(number(missed, "distance"), 0.009);
}

TEST(AnswerInverse, SaysWhatIsNearestInEveryAnswerThatDidNotConverge) {
  const Arm arm = limited_arm();
  for (const char* line :
       {R"({"curve":[[0,0,0],[0,1.9,0]]})", R"({"curve":[[0,0,0],[0.3,0.1,0],[0,0.2,0],[0.3,0.3,0.2]]})",
        R"({"curve":[[0,0,0],[0.2,0,0],[0,0,0],[0.2,0,0],[0,0,0]]})", R"({"curve":[[0,0.01,0],[0,0.9,0]]})",
        R"({"position":[0,2,0]})", R"({"position":[0,0.8,0],"direction":[0,-1,0]})",
        R"({"position":[0,0.01,0],"rotation":[1,0,0,0]})", R"({"position":[0,2,0],"all":true})"}) {
    SCOPED_TRACE(line);
    const Node answer = parsed(answer_inverse(arm, line));
    ASSERT_FALSE(flag(answer, "converged"));
    const Node shape{Node::Table{{"bends", {}, *answer.find("bends")}}, {}};
    const Node tip = *parsed(answer_forward(arm, write_json(shape))).find("tip");
    ASSERT_NE(answer.find("nearest"), nullptr);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(*answer.find("nearest")->as<Node::Array>()->at(i).as<double>(),
                  *tip.find("position")->as<Node::Array>()->at(i).as<double>(), 1e-9);
    }
    EXPECT_GT(number(answer, "distance"), 0);
  }
}

TEST(AnswerInverse, BeginsAtTheStartAndFollowsTheWish) {
  const Arm arm = limited_arm();
  const std::string start = R"("start":{"bends":[[1,0],[0,1],[-1,0]]})";
  const std::string there = answer_inverse(arm, R"({"position":[0.2,0.6,0.1],)" + start + "}");
  const std::string plain = answer_inverse(arm, R"({"position":[0.2,0.6,0.1]})");
  EXPECT_NE(there, plain);
  const std::string with_objective =
      answer_inverse(arm, R"({"position":[0.2,0.6,0.1],"prefer":"least_bending",)" + start + "}");
  EXPECT_NE(there, with_objective);
  EXPECT_TRUE(flag(parsed(with_objective), "converged"));
}

TEST(AnswerInverse, AnswersABadLineWithItsError) {
  const std::vector<std::pair<const char*, const char*>> lines{
      {"", "not JSON"},
      {"{}", "expected either position or curve"},
      {"[]", "expected a table"},
      {R"({"position":[0,1,0],"curve":[[0,0,0],[0,1,0]]})", "expected either position or curve"},
      {R"({"position":[0,1]})", "position is an array of 2: expected an array of 3"},
      {R"({"position":[0,"1",0]})", "position[1] = \\\"1\\\": expected a number"},
      {R"({"position":[0,NaN,0]})", "not JSON"},
      {R"({"position":[0,1e300,0]})", "position[1] = 1e+300: expected a number from"},
      {R"({"position":[0,1e999,0]})", "error"},
      {R"({"position":[0,1,0],"direction":[0,0,0]})", "direction: is zero"},
      {R"({"position":[0,1,0],"direction":[0,1]})", "expected an array of 3"},
      {R"({"position":[0,1,0],"rotation":[0,0,0,0]})",
       "rotation: has the norm 0: expected a unit quaternion"},
      {R"({"position":[0,1,0],"rotation":[1,0,0,0.1]})", "has the norm 1.00499"},
      {R"({"position":[0,1,0],"rotation":[1,0,0]})", "expected an array of 4"},
      {R"({"position":[0,1,0],"rotation":[1,0,0,0],"direction":[0,1,0]})", "gives the orientation twice"},
      {R"({"position":[0,1,0],"prefer":"more"})", "expected one of"},
      {R"({"position":[0,1,0],"all":1})", "expected true or false"},
      {R"({"position":[0,1,0],"start":{"bends":[[0,0]]}})", "start.bends: 1 given: expected 3"},
      {R"({"position":[0,1,0],"start":{"archings":[0,0,0]}})", "is for planar arms"},
      {R"({"curve":[[0,0,0]]})", "curve"},
      {R"({"curve":[[0,1,0],[0,1,0]]})", "has no length"},
      {R"({"curve":[[0,0,0],[0,1e-300,0]]})", "has no length"},
      {R"({"curve":[[0,0,0],[0,1,0]],"direction":[0,1,0]})", "curve: cannot be combined"},
      {R"({"positon":[0,1,0]})", "did you mean \\\"position\\\"?"},
      {R"({"position":[0,1,0],"position":[0,1,0]})", "occurs twice"},
  };
  for (const auto& [line, error] : lines) {
    EXPECT_THAT(answer_inverse(limited_arm(), line), HasSubstr(error)) << line;
    EXPECT_THAT(answer_inverse(limited_arm(), line), ::testing::StartsWith("{\"error\":")) << line;
  }
}

TEST(AnswerInverse, TakesAQuaternionThatIsAlmostOfUnitLength) {
  const std::string answer =
      answer_inverse(limited_arm(), R"({"position":[0.2,0.6,0.1],"rotation":[1.0005,0,0,0]})");
  EXPECT_THAT(answer, HasSubstr("\"converged\":true"));
  EXPECT_THAT(answer, Not(HasSubstr("error\":\"")));
}

TEST(InverseCommand, AnswersEveryLineInOrder) {
  std::istringstream in("{\"position\":[1,15,0]}\nrubbish\n{\"position\":[0,99,0]}");
  std::ostringstream out;
  EXPECT_EQ(inverse_command(paper_arm_file, in, out), exit_done);
  std::istringstream lines(out.str());
  std::vector<std::string> answers;
  for (std::string line; std::getline(lines, line);) answers.push_back(line);
  ASSERT_EQ(answers.size(), 3U);
  EXPECT_THAT(answers[0], HasSubstr("\"converged\":true"));
  EXPECT_THAT(answers[1], HasSubstr("\"error\""));
  EXPECT_THAT(answers[2], HasSubstr("\"not_reachable\""));
}

// Returns an arm of two wires of 2 mm radius with this mass per length and three tendons to the end of each.
ArmModel elastic_arm(const std::string& mass, const std::string& load = "") {
  std::string text = "[arm]\nkind='spatial'\nmodel='static'\ngravity=[0,-9.81,0]\n";
  for (int section = 1; section <= 2; ++section) {
    text += "[[arm.section]]\nlength=0.35\nmax_bend_deg=120\n";
    text += "material={youngs_modulus=54e9,radius_mm=2,mass_per_length=" + mass + "}\n";
  }
  for (int i = 0; i < 6; ++i)
    text += fmt::format("[[arm.tendon]]\nsection={}\nradius_mm=15\nangle_deg={}\n", i / 3 + 1, 120 * (i % 3));
  return parse_experiment(text + load, "x.toml").arm_model();
}

TEST(AnswerInverse, OfAnElasticArmIsUndoneByForwardKinematicsUnderItsWeight) {
  const ArmModel arm = elastic_arm("0.2");
  const Node answer = parsed(answer_inverse(arm, R"({"position":[0.3,0.45,0.1]})"));
  ASSERT_TRUE(flag(answer, "converged"));
  const Node shape{Node::Table{{"bends", {}, *answer.find("bends")}}, {}};
  const auto tip_of = [&](const std::string& of) {
    const Node tip = *parsed(of).find("tip");
    const Node::Array& position = *tip.find("position")->as<Node::Array>();
    return Eigen::Vector3d(*position[0].as<double>(), *position[1].as<double>(), *position[2].as<double>());
  };
  const Eigen::Vector3d desired(0.3, 0.45, 0.1);
  EXPECT_LE((tip_of(answer_forward(arm, write_json(shape))) - desired).norm(), 1e-8);
  // Arcs with these bends have their tip elsewhere: the arm sags.
  EXPECT_GE((tip_of(answer_forward(arm.driven(), write_json(shape))) - desired).norm(), 0.01);
  EXPECT_THAT(answer_forward(arm, R"({"bends":[[0,0],[0,0]],"at":[0,0.7]})"), Not(HasSubstr("error")));
}

TEST(AnswerInverse, OfAnArmThatComesToNoRestIsAnError) {
  EXPECT_THROW((void)elastic_arm("0.2", "[[arm.load]]\nsection=2\nforce=[0,-1e9,0]\nfollowing=true\n"),
               InputError);
  EXPECT_THAT(answer_forward(elastic_arm("0.2"), R"({"bends":[[0,0],[0,0]],"stretches":[1,0.5]})"),
              Not(HasSubstr("null")));
}

}  // namespace
}  // namespace flexura
