#include "flexura/app/statics.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "flexura/app/commands.h"
#include "flexura/base/source.h"
#include "flexura/experiment/experiment.h"
#include "flexura/store/json.h"
#include "tests/support/checkout.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

const std::string wire_file = checkout_file("examples/09_tendon_statics/experiment.toml");

StaticsAnswers answers_of_text(const std::string& text) {
  const Experiment experiment = parse_experiment(text, "x.toml");
  return {experiment.arm, experiment.drive};
}

StaticsAnswers wire_answers() {
  const Experiment experiment = load_experiment(wire_file);
  return {experiment.arm, experiment.drive};
}

Node answer_to(StaticsAnswers& answers, const std::string& line) {
  return parse_json(answers.answer(line), "answer");
}

std::vector<double> listed_numbers(const Node* node) {
  std::vector<double> values;
  if (node == nullptr) return values;
  for (const Node& entry : *node->as<Node::Array>()) values.push_back(*entry.as<double>());
  return values;
}

std::vector<double> tip_position(const Node& answer) {
  const Node* tip = answer.find("tip");
  return tip == nullptr ? std::vector<double>{} : listed_numbers(tip->find("position"));
}

auto near(std::vector<double> values, double within) {
  std::vector<::testing::Matcher<double>> each;
  for (const double value : values) each.push_back(::testing::DoubleNear(value, within));
  return ::testing::ElementsAreArray(each);
}

constexpr const char* pulled = R"({"tensions":[4,0,0,0,2,0]})";

TEST(AnswerStatics, GivesTheKnownTipOfTheExample) {
  StaticsAnswers answers = wire_answers();
  const Node answer = answer_to(answers, pulled);
  EXPECT_TRUE(*answer.find("converged")->as<bool>());
  EXPECT_EQ(*answer.find("reason")->as<std::string>(), "converged");
  EXPECT_THAT(tip_position(answer), near({0.127607603, 0.143467423, 0.336406799}, 2e-8));
  EXPECT_THAT(listed_numbers(answer.find("tensions")), ::testing::ElementsAre(4, 0, 0, 0, 2, 0));
  EXPECT_EQ(listed_numbers(answer.find("displacements")).size(), 6U);
  EXPECT_TRUE(*answer.find("stable")->as<bool>());
  EXPECT_FALSE(*answer.find("snapped")->as<bool>());
  EXPECT_FALSE(*answer.find("ambiguous")->as<bool>());
  EXPECT_GT(*answer.find("strain_energy")->as<double>(), 0);
  EXPECT_EQ(answer.find("at"), nullptr);
}

TEST(AnswerStatics, IsStraightWhenNothingPulls) {
  StaticsAnswers answers = wire_answers();
  EXPECT_THAT(tip_position(answer_to(answers, "{}")), near({0, 0, 0.4}, 1e-12));
}

TEST(AnswerStatics, FindsTheTensionsOfDisplacements) {
  StaticsAnswers answers = wire_answers();
  // All tendons are taut: the tension of a slack one does not determine its displacement.
  const Node pulls = answer_to(answers, R"({"tensions":[4,1,1,1,2,1]})");
  const std::vector<double> pulled_in = listed_numbers(pulls.find("displacements"));
  const Node back = answer_to(answers, fmt::format(R"({{"displacements":[{}]}})", fmt::join(pulled_in, ",")));
  EXPECT_THAT(tip_position(back), near(tip_position(pulls), 1e-8));
  EXPECT_THAT(listed_numbers(back.find("displacements")), near(pulled_in, 1e-9));
}

TEST(AnswerStatics, AddsAForceAtTheTip) {
  StaticsAnswers answers = wire_answers();
  EXPECT_THAT(tip_position(answer_to(answers, R"({"tip_force":[0.1,0,0]})")),
              near({0.169688740, 0, 0.353786806}, 2e-8));
  // A moment about y bends towards x.
  const auto turned = tip_position(answer_to(answers, R"({"tip_moment":[0,0.01,0]})"));
  ASSERT_EQ(turned.size(), 3U);
  EXPECT_GT(turned[0], 0.01);
}

TEST(AnswerStatics, TakesTheFilesGravityAndLoadsInTheWorldsFrame) {
  // The base's z is the world's Y, its x the world's X and its y the world's -Z.
  const std::string rod = R"(
[[arm.section]]
length = 0.5
material = { youngs_modulus = 200e9, radius_mm = 1, density = 8000 }
)";
  const std::string arm = "[arm]\nkind = 'spatial'\nmodel = 'static'\n";
  StaticsAnswers free = answers_of_text(arm + rod);
  StaticsAnswers heavy = answers_of_text(arm + "gravity = [0, 0, -9.81]\n" + rod);
  StaticsAnswers loaded = answers_of_text(arm + "[[arm.load]]\nsection = 1\nforce = [0, 0, -0.1]\n" + rod);
  const std::string in_base = R"({"gravity":[0,9.81,0]})";
  EXPECT_THAT(tip_position(answer_to(heavy, "{}")), near(tip_position(answer_to(free, in_base)), 1e-12));
  EXPECT_GT(tip_position(answer_to(heavy, "{}"))[1], 0.01);
  EXPECT_THAT(tip_position(answer_to(heavy, R"({"gravity":[0,0,0]})")), near({0, 0, 0.5}, 1e-12));
  EXPECT_THAT(tip_position(answer_to(loaded, "{}")),
              near(tip_position(answer_to(free, R"({"tip_force":[0,0.1,0]})")), 1e-12));
}

TEST(AnswerStatics, AnswersAlongTheArmAtRestOnlyWhenAsked) {
  StaticsAnswers answers = wire_answers();
  const Node answer = answer_to(answers, R"({"tensions":[4,0,0,0,2,0],"at":[0,0.2,0.3,0.4,0.13,0.3]})");
  const auto& at = *answer.find("at")->as<Node::Array>();
  ASSERT_EQ(at.size(), 6U);
  const auto position = [&](std::size_t i) { return listed_numbers(at[i].find("position")); };
  EXPECT_THAT(position(0), near({0, 0, 0}, 0));
  EXPECT_THAT(position(3), near(tip_position(answer), 1e-12));
  EXPECT_THAT(position(3), near({0.127607603, 0.143467423, 0.336406799}, 2e-8));
  EXPECT_THAT(position(5), near(position(2), 1e-12));
  EXPECT_EQ(listed_numbers(at[0].find("rotation")).size(), 4U);
  EXPECT_TRUE(answer_to(answers, R"({"at":[]})").find("at")->as<Node::Array>()->empty());
  const Node straight = answer_to(answers, R"({"at":[0.25]})");
  EXPECT_THAT(listed_numbers((*straight.find("at")->as<Node::Array>())[0].find("position")),
              near({0, 0, 0.25}, 1e-12));
}

TEST(AnswerStatics, DoesNotDependOnTheLinesBefore) {
  StaticsAnswers answers = wire_answers();
  const std::string first = answers.answer(pulled);
  for (const char* between : {"rubbish", R"({"tensions":[0,0,0,9,0,0],"tip_force":[1,1,1]})",
                              R"({"displacements":[0,0,0.01,0,0,0]})", R"({"at":[0.1]})",
                              R"({"tip_moment":[3,-5,2],"gravity":[100,0,0]})"}) {
    (void)answers.answer(between);
    EXPECT_EQ(answers.answer(pulled), first) << between;
  }
}

double number_of(const Node& answer, const char* name) { return *answer.find(name)->as<double>(); }

TEST(AnswerStatics, FindsTheTensionsOfATarget) {
  StaticsAnswers answers = wire_answers();
  const Node made = answer_to(answers, R"({"tensions":[4,0,0,0,2,0],"at":[0.1,0.2,0.3]})");
  const auto quaternion = listed_numbers(made.find("tip")->find("rotation"));
  const std::string tip = fmt::format("\"tip\":[{}]", fmt::join(tip_position(made), ",")),
                    rotation = fmt::format("\"rotation\":[{}]", fmt::join(quaternion, ","));
  std::string shape = "\"shape\":[";
  const auto& at = *made.find("at")->as<Node::Array>();
  for (std::size_t i = 0; i < at.size(); ++i)
    shape +=
        fmt::format("{}{{\"at\":{},\"position\":[{}]}}", i == 0 ? "" : ",", 0.1 * static_cast<double>(i + 1),
                    fmt::join(listed_numbers(at[i].find("position")), ","));
  shape += "]";
  for (const std::string& target : {tip, tip + "," + rotation, shape, tip + ",\"direction\":[0.3,0.5,1]"}) {
    const bool has_angle = target.find("tip") != std::string::npos && target != tip;
    const Node answer = answer_to(answers, "{\"target\":{" + target + "},\"at\":[0.4]}");
    ASSERT_NE(answer.find("residual"), nullptr) << target;
    EXPECT_EQ(answer.find("residual_angle") != nullptr, has_angle) << target;
    double effort = 0;
    std::string again = "{\"tensions\":[";
    for (const double tension : listed_numbers(answer.find("tensions"))) {
      EXPECT_GE(tension, 0);
      effort += tension * tension;
      again += fmt::format("{},", tension);
    }
    again.back() = ']';
    EXPECT_THAT(tip_position(answer_to(answers, again + "}")), near(tip_position(answer), 1e-9)) << target;
    if (target.find("direction") != std::string::npos) continue;  // Which those tensions do not make.
    EXPECT_TRUE(*answer.find("reached")->as<bool>()) << target;
    EXPECT_EQ(answer.find("why_not"), nullptr);
    EXPECT_LE(number_of(answer, "residual"), 1e-7) << target;
    EXPECT_LE(effort, 20 + 1e-4) << target;
    EXPECT_TRUE(*answer.find("stable")->as<bool>());
  }
}

TEST(AnswerStatics, SaysHowFarATargetIsOutOfReach) {
  StaticsAnswers answers = wire_answers();
  const Node answer = answer_to(answers, R"({"target":{"tip":[0,0,0.5]},"gravity":[0,0,-1]})");
  EXPECT_TRUE(*answer.find("converged")->as<bool>());
  EXPECT_FALSE(*answer.find("reached")->as<bool>());
  EXPECT_THAT(*answer.find("why_not")->as<std::string>(), HasSubstr("bounds"));
  EXPECT_NEAR(number_of(answer, "residual"), 0.1, 1e-3);
  // Under a force that pulls the tip aside tendons pull against it.
  const Node held = answer_to(answers, R"({"target":{"tip":[0,0,0.399]},"tip_force":[0.02,0,0]})");
  EXPECT_TRUE(*held.find("reached")->as<bool>()) << write_json(held);
  EXPECT_THAT(tip_position(held), near({0, 0, 0.399}, 1e-7));
}

TEST(AnswerStatics, SaysNothingOfWhatItDoesNotFind) {
  StaticsAnswers answers = answers_of_text(R"([arm]
kind = "spatial"
[[arm.section]]
length = 0.5
material = { youngs_modulus = 1e6, radius_mm = 1 }
)");
  const std::string answer = answers.answer(R"({"tip_force":[1e9,3e8,-1e9],"tip_moment":[1e9,-1e9,1e9]})");
  EXPECT_THAT(answer, ::testing::StartsWith(R"({"converged":false,"reason":")"));
  EXPECT_THAT(answer, ::testing::Not(HasSubstr("tip")));
  EXPECT_THAT(answer, ::testing::Not(HasSubstr("null")));
}

// Four pieces of 0.1 m: each has modes of its own, so that the section is that of four short ones. With modes
// that make it an arc, a note says so.
TEST(AnswerStatics, FollowsChordsAndNotesWhereItCannot) {
  const auto arm = [](int sections, int disks, int modes) {
    std::string text = "[arm]\nkind = \"spatial\"\n";
    for (int i = 0; i < sections; ++i)
      text += fmt::format(
          "[[arm.section]]\nlength = {}\nradius = 0.02\nmaterial = {{ stiffness = {{ shear = 1e4, stretch = "
          "1e4, "
          "bend = 0.01, twist = 0.008 }}, disks = {}, modes = {{ bend = {} }} }}\n",
          0.4 / sections, disks, modes);
    for (const int angle : {0, 180})
      text += fmt::format("[[arm.tendon]]\nsection = {}\nradius = 0.01\nangle_deg = {}\n", sections, angle);
    return answers_of_text(text);
  };
  StaticsAnswers arcs = arm(1, 4, 1), usual = arm(1, 4, 5), pieces = arm(4, 1, 5);
  const std::string line = R"({"tensions":[4,2]})";
  const Node of_arcs = answer_to(arcs, line), of_usual = answer_to(usual, line);
  ASSERT_NE(of_arcs.find("note"), nullptr);
  EXPECT_THAT(*of_arcs.find("note")->as<std::string>(), HasSubstr("material.modes.bend"));
  EXPECT_EQ(of_usual.find("note"), nullptr);
  EXPECT_EQ(answer_to(arcs, R"({"tensions":[0.2,0.1]})").find("note"), nullptr) << "hardly bent";
  const Node of_pieces = answer_to(pieces, line);
  EXPECT_THAT(tip_position(of_usual), near(tip_position(of_pieces), 1e-4));
  EXPECT_THAT(tip_position(of_arcs), ::testing::Not(near(tip_position(of_pieces), 2e-2)));
}

TEST(AnswerStatics, NamesDisksThatMeet) {
  StaticsAnswers answers = answers_of_text(R"([arm]
kind = "spatial"
[[arm.section]]
length = 0.4
radius = 0.02
material = { stiffness = { shear = 1e4, stretch = 1e4, bend = 0.01, twist = 0.008 }, disks = 4 }
[[arm.tendon]]
section = 1
radius = 0.01
)");
  EXPECT_EQ(answers.answer(R"({"tensions":[60]})"), R"({"converged":false,"reason":"disks_meet"})");
}

TEST(AnswerStatics, AnswersABadLineWithItsError) {
  StaticsAnswers answers = wire_answers();
  const std::vector<std::pair<const char*, const char*>> lines{
      {"", "not JSON"},
      {"[]", "expected a table"},
      {R"({"tensions":[1,2]})", "tensions: 2 given: expected 6 values, one per tendon"},
      {R"({"tensions":[]})", "tensions: 0 given: expected 6"},
      {R"({"tensions":[0,0,0,0,0,-1]})", "tensions[5] = -1: expected a number from 0 to"},
      {R"({"tensions":[0,0,0,0,0,1e300]})", "tensions[5] = 1e+300: expected a number from 0 to"},
      {R"({"tensions":[0,0,0,0,0,NaN]})", "not JSON"},
      {R"({"tensions":[0,0,0,0,0,1e999]})", "number overflow"},
      {R"({"displacements":[0]})", "displacements: 1 given: expected 6"},
      {R"({"tensions":[0,0,0,0,0,0],"displacements":[0,0,0,0,0,0]})",
       "displacements: are given together with tensions: expected either displacements or tensions"},
      {R"({"tip_force":[1,2]})", "tip_force is an array of 2: expected an array of 3"},
      {R"({"tip_force":[1,2,null]})", "tip_force[2] = nothing: expected a number"},
      {R"({"tip_moment":[1,2,1e300]})", "tip_moment[2] = 1e+300: expected a number from"},
      {R"({"gravity":[1,2,-1e300]})", "gravity[2] = -1e+300: expected a number from"},
      {R"({"at":[0.41]})", "at[0]: 0.41 is beyond the tip: expected at most 0.4 m"},
      {R"({"at":[-1]})", "at[0] = -1: expected a number at least 0 m"},
      {R"({"target":{}})", "target: is empty: expected tip, direction, rotation or shape"},
      {R"({"target":[1,2,3]})", "expected a table"},
      {R"({"target":{"tip":[1,2]}})", "target.tip is an array of 2: expected an array of 3"},
      {R"({"target":{"tip":[1,2,1e300]}})", "target.tip[2] = 1e+300: expected a number from"},
      {R"({"target":{"tip":[0,0,1]},"tensions":[0,0,0,0,0,0]})",
       "target: is given together with tensions or displacements: expected only one of the three keys"},
      {R"({"target":{"direction":[0,0,0]}})", "target.direction: is zero: expected a vector other than zero"},
      {R"({"target":{"rotation":[1,1,1,1]}})", "target.rotation"},
      {R"({"target":{"direction":[0,0,1],"rotation":[1,0,0,0]}})", "gives the orientation twice"},
      {R"({"target":{"shape":[]}})", "target.shape"},
      {R"({"target":{"shape":[{"at":0.5,"position":[0,0,0]}]}})",
       "target.shape[0].at: 0.5 is beyond the tip: expected at most 0.4 m"},
      {R"({"target":{"tip":[0,0,1],"most_tension":0}})",
       "target.most_tension = 0: expected a number above 0"},
      {R"({"target":{"tp":[0,0,1]}})", "did you mean \\\"tip\\\"?"},
      {R"({"tension":[]})", "did you mean \\\"tensions\\\"?"},
  };
  for (const auto& [line, error] : lines) {
    EXPECT_THAT(answers.answer(line), HasSubstr(error)) << line;
    EXPECT_THAT(answers.answer(line), ::testing::StartsWith("{\"error\":")) << line;
  }
}

TEST(StaticsCommand, AnswersEveryLineInOrder) {
  std::istringstream in(fmt::format("{}\nrubbish\n{}", pulled, pulled));
  std::ostringstream out;
  EXPECT_EQ(statics_command(wire_file, in, out), exit_done);
  std::istringstream lines(out.str());
  std::vector<std::string> given;
  for (std::string line; std::getline(lines, line);) given.push_back(line);
  ASSERT_EQ(given.size(), 3U);
  EXPECT_THAT(given[0], HasSubstr("\"tip\""));
  EXPECT_THAT(given[1], HasSubstr("\"error\""));
  EXPECT_EQ(given[2], given[0]);
}

TEST(AnswerStatics, RefusesATargetOfAnArmWithoutTendons) {
  StaticsAnswers answers = answers_of_text(R"([arm]
kind = "spatial"
[[arm.section]]
length = 0.5
material = { youngs_modulus = 1e6, radius_mm = 1 }
)");
  EXPECT_THAT(answers.answer(R"({"target":{"tip":[0,0,0.4]}})"), HasSubstr("needs an arm with tendons"));
}

TEST(StaticsCommand, RefusesAnArmThatIsNotElastic) {
  const std::string file = checkout_file("examples/01_paper_arm/experiment.toml");
  std::istringstream in;
  std::ostringstream out;
  try {
    (void)statics_command(file, in, out);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), file +
                                ": arm.section[0]: has no material: expected material.youngs_modulus or "
                                "material.stiffness");
  }
}

}  // namespace
}  // namespace flexura
