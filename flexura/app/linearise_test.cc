#include "flexura/app/linearise.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <sstream>

#include "flexura/app/commands.h"
#include "flexura/base/source.h"
#include "flexura/experiment/experiment.h"
#include "flexura/math/derivative_check.h"
#include "flexura/mechanics/arm_rod.h"
#include "flexura/mechanics/dynamics.h"
#include "flexura/store/json.h"
#include "tests/support/checkout.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

// Spring steel, clamped, without gravity; its bending modes are those of the Euler-Bernoulli beam.
const std::string steel_cantilever = R"([arm]
kind = "spatial"
[[arm.section]]
length = 0.5
[arm.section.material]
youngs_modulus = 200e9
poisson = 0.25
radius_mm = 1
density = 8000
damping_time = 1e-4
modes = { shear = 0, stretch = 0, bend = 8, twist = 0 }
)";
const std::string two_soft_sections = R"([arm]
kind = "spatial"
gravity = [0, 9.81, 0]
[[arm.section]]
length = 0.2
[arm.section.material]
youngs_modulus = 1e6
poisson = 0.45
radius_mm = 12
density = 1100
damping_time = 0.01
modes = { shear = 0, stretch = 1, bend = 2, twist = 1 }
[[arm.section]]
length = 0.2
[arm.section.material]
youngs_modulus = 1e6
poisson = 0.45
radius_mm = 10
density = 1100
damping_time = 0.01
modes = { shear = 0, stretch = 1, bend = 2, twist = 1 }
[[arm.tendon]]
section = 1
radius_mm = 8
[[arm.tendon]]
section = 2
radius_mm = 8
angle_deg = 100
)";

LineariseAnswers linearise_answers(const std::string& text) {
  const Experiment experiment = parse_experiment(text, "x.toml");
  return {experiment.arm, experiment.drive};
}

Eigen::MatrixXd read_matrix(const Node& answer, const char* name) {
  const auto& rows = *answer.find(name)->as<Node::Array>();
  Eigen::MatrixXd matrix;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto& row = *rows[i].as<Node::Array>();
    if (i == 0) matrix.resize(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(row.size()));
    for (std::size_t j = 0; j < row.size(); ++j)
      matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = *row[j].as<double>();
  }
  return matrix;
}

std::vector<double> read_list(const Node& answer, const char* name) {
  std::vector<double> values;
  for (const Node& entry : *answer.find(name)->as<Node::Array>()) values.push_back(*entry.as<double>());
  return values;
}

std::vector<std::string> read_names(const Node& answer, const char* name) {
  std::vector<std::string> names;
  for (const Node& entry : *answer.find(name)->as<Node::Array>()) names.push_back(*entry.as<std::string>());
  return names;
}

TEST(Linearise, GivesTheFrequenciesOfACantilever) {
  LineariseAnswers answers = linearise_answers(steel_cantilever);
  const Node answer = parse_json(answers.answer("{}"), "answer");
  EXPECT_TRUE(*answer.find("converged")->as<bool>());
  EXPECT_TRUE(*answer.find("stable")->as<bool>());
  const std::vector<double> found = read_list(answer, "frequencies_hz"),
                            ratios = read_list(answer, "damping_ratios");
  ASSERT_EQ(found.size(), ratios.size());
  ASSERT_GE(found.size(), 6U);
  // Each occurs twice, as the rod is round.
  const std::vector<double> known = {5.595912, 35.068983, 98.194166};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(found[i], known[i / 2], 1e-3 * known[i / 2]);
    EXPECT_NEAR(ratios[i], 1e-4 * std::numbers::pi * found[i], 1e-6);
  }
  EXPECT_EQ(read_matrix(answer, "eigenvalues").rows(), 32);
  EXPECT_TRUE(std::ranges::is_sorted(found));
}

TEST(Linearise, ItsMatricesAreThoseByDifferences) {
  LineariseAnswers answers = linearise_answers(two_soft_sections);
  const Node answer =
      parse_json(answers.answer(R"({"tensions":[1.5,0.5],"tip_force":[0.02,0,0.01]})"), "answer");
  const Eigen::MatrixXd A = read_matrix(answer, "A"), B = read_matrix(answer, "B"),
                        C = read_matrix(answer, "C");
  const Experiment experiment = parse_experiment(two_soft_sections, "x.toml");
  const Rod rod = rod_of(experiment.arm);
  RodLoads loads = loads_of(experiment.arm);
  loads.ends.push_back({.section = 1, .force = {0.02, 0, 0.01}});
  const TendonInput tendons{.tensions = {1.5, 0.5}};
  const Equilibrium at = RodStatics(rod).solve(tendons, loads);
  RodDynamics dynamics(rod);
  const Eigen::Index n = at.q.size();
  ASSERT_EQ(A.rows(), 2 * n);
  ASSERT_EQ(A.cols(), 2 * n);
  ASSERT_EQ(B.cols(), 2);
  ASSERT_EQ(C.rows(), 6);
  ASSERT_EQ(C.cols(), 2 * n);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(2 * n + 2);
  x << at.q, Eigen::VectorXd::Zero(n), 1.5, 0.5;
  const auto rate = [&](const Eigen::VectorXd& z) {
    const TendonInput pull{.tensions = {z[2 * n], z[2 * n + 1]}};
    return Eigen::VectorXd((Eigen::VectorXd(2 * n) << z.segment(n, n),
                            dynamics.acceleration(z.head(n), z.segment(n, n), pull, loads))
                               .finished());
  };
  const Eigen::MatrixXd by = numerical_jacobian(rate, x, 1e-2).value;
  EXPECT_LE((A - by.leftCols(2 * n)).cwiseAbs().maxCoeff(), 1e-6 * A.cwiseAbs().maxCoeff());
  EXPECT_LE((B - by.rightCols(2)).cwiseAbs().maxCoeff(), 1e-6 * B.cwiseAbs().maxCoeff());
  const auto tip = [&](const Eigen::VectorXd& q) {
    RodState state = dynamics.rest();
    state.q = q;
    const Pose X = dynamics.tip(state);
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(X.rotation * at.tip.rotation.transpose()));
    return Eigen::VectorXd((Eigen::VectorXd(6) << X.position, turn.angle() * turn.axis()).finished());
  };
  const Eigen::MatrixXd tip_by_q = numerical_jacobian(tip, at.q, 1e-2).value;
  EXPECT_LE((C.leftCols(n) - tip_by_q).cwiseAbs().maxCoeff(), 1e-6 * C.cwiseAbs().maxCoeff());
  EXPECT_TRUE(C.rightCols(n).isZero(0));
}

TEST(Linearise, NamesStatesInputsAndOutputs) {
  LineariseAnswers answers = linearise_answers(two_soft_sections);
  const Node pulled = parse_json(answers.answer(R"({"displacements":[0.004,0.002]})"), "answer");
  const std::vector<std::string> states = read_names(pulled, "states");
  ASSERT_EQ(states.size(), 24U);
  EXPECT_EQ(states.front(), "q.1.stretch.0");
  EXPECT_EQ(states[2], "q.1.curvature_x.1");
  EXPECT_EQ(states[6], "q.2.stretch.0");
  EXPECT_EQ(states.back(), "v.2.twist.0");
  EXPECT_THAT(read_names(pulled, "inputs"), ::testing::ElementsAre("displacement.1", "displacement.2"));
  EXPECT_EQ(read_names(pulled, "outputs").size(), 6U);
  EXPECT_GT(read_matrix(pulled, "B").col(0).norm(), 0);
  const Node free = parse_json(answers.answer("{}"), "answer");
  EXPECT_THAT(read_names(free, "inputs"), ::testing::ElementsAre("tension.1", "tension.2"));
  // Tendons held at their displacements are stiff and raise the lowest frequencies.
  EXPECT_GT(read_list(pulled, "frequencies_hz").back(), read_list(free, "frequencies_hz").back());
}

// The rest moves with the rod's parameters like the equilibrium; damping does not move it.
TEST(Linearise, ItsParametersMoveTheRest) {
  LineariseAnswers answers = linearise_answers(two_soft_sections);
  const Node answer = parse_json(answers.answer(R"({"tensions":[1.5,0.5]})"), "answer");
  const std::vector<std::string> names = read_names(answer, "parameters");
  ASSERT_EQ(names.size(), 12U);
  EXPECT_EQ(names.front(), "shear.1");
  EXPECT_EQ(names[10], "mass.2");
  EXPECT_EQ(names.back(), "damping.2");
  const Eigen::MatrixXd rest =
      -read_matrix(answer, "A").partialPivLu().solve(read_matrix(answer, "by_parameters"));
  const Experiment experiment = parse_experiment(two_soft_sections, "x.toml");
  RodStatics statics(rod_of(experiment.arm));
  ASSERT_TRUE(statics.solve({.tensions = {1.5, 0.5}}, loads_of(experiment.arm)).converged());
  const Eigen::MatrixXd known = statics.slopes().q_by_parameters;
  const Eigen::Index n = known.rows();
  ASSERT_EQ(rest.rows(), 2 * n);
  for (const Eigen::Index section : {0, 1}) {
    const auto found = rest.middleCols(6 * section, 6);
    EXPECT_LE((found.topLeftCorner(n, 5) - known.middleCols(5 * section, 5)).cwiseAbs().maxCoeff(),
              1e-6 * known.cwiseAbs().maxCoeff());
    EXPECT_TRUE(found.col(5).isZero(0));
  }
  // Tendons held at their displacements are so stiff that only the matrices of second order keep all digits.
  const Node held = parse_json(answers.answer(R"({"displacements":[0.004,0.002]})"), "answer");
  const Eigen::MatrixXd K = read_matrix(held, "stiffness"),
                        shift = K.partialPivLu().solve(read_matrix(held, "force_by_parameters"));
  ASSERT_TRUE(statics.solve({.displacements = {0.004, 0.002}}, loads_of(experiment.arm)).converged());
  const Eigen::MatrixXd of_held = statics.slopes().q_by_parameters;
  for (const Eigen::Index section : {0, 1})
    EXPECT_LE((shift.middleCols(6 * section, 5) - of_held.middleCols(5 * section, 5)).cwiseAbs().maxCoeff(),
              1e-6 * of_held.cwiseAbs().maxCoeff());
  // A and B are made from them.
  const Eigen::MatrixXd M = read_matrix(answer, "mass"), A = read_matrix(answer, "A");
  const auto expect_near = [](const Eigen::MatrixXd& found, const Eigen::MatrixXd& wanted) {
    EXPECT_LE((found - wanted).cwiseAbs().maxCoeff(), 1e-7 * wanted.cwiseAbs().maxCoeff());
  };
  expect_near(-M * A.bottomLeftCorner(n, n), read_matrix(answer, "stiffness"));
  expect_near(-M * A.bottomRightCorner(n, n), read_matrix(answer, "damping"));
  expect_near(M * read_matrix(answer, "B").bottomRows(n), read_matrix(answer, "force_by_inputs"));
}

// Its weight lowers the frequency of a standing arm and raises that of a hanging one.
TEST(Linearise, TakesGravityOfTheLine) {
  LineariseAnswers answers = linearise_answers(steel_cantilever);
  const auto lowest = [&](const char* line) {
    return read_list(parse_json(answers.answer(line), "answer"), "frequencies_hz").at(0);
  };
  const double free = lowest("{}");
  EXPECT_LT(lowest(R"({"gravity":[0,0,-9.81]})"), 0.99 * free);
  EXPECT_GT(lowest(R"({"gravity":[0,0,9.81]})"), 1.01 * free);
  EXPECT_EQ(lowest("{}"), free);
}

TEST(Linearise, AnswersABadLineWithItsError) {
  LineariseAnswers answers = linearise_answers(two_soft_sections);
  const std::vector<std::pair<const char*, const char*>> lines{
      {"", "not JSON"},
      {"[]", "expected a table"},
      {R"({"tensions":[1]})", "tensions: 1 given: expected 2 values, one per tendon"},
      {R"({"tensions":[0,-1]})", "tensions[1] = -1: expected a number from 0 to"},
      {R"({"displacements":[0]})", "displacements: 1 given: expected 2"},
      {R"({"tensions":[0,0],"displacements":[0,0]})",
       "displacements: are given together with tensions: expected either displacements or tensions"},
      {R"({"tip_force":[1,2]})", "tip_force is an array of 2: expected an array of 3"},
      {R"({"gravity":[1,2,-1e300]})", "gravity[2] = -1e+300: expected a number from"},
      {R"({"at":[0.1]})", "at"},
  };
  for (const auto& [line, error] : lines) {
    EXPECT_THAT(answers.answer(line), HasSubstr(error)) << line;
    EXPECT_THAT(answers.answer(line), ::testing::StartsWith("{\"error\":")) << line;
  }
}

TEST(Linearise, SaysNothingOfWhatItDoesNotFind) {
  LineariseAnswers answers = linearise_answers(two_soft_sections);
  const std::string answer = answers.answer(R"({"tip_force":[1e9,3e8,-1e9],"tip_moment":[1e9,-1e9,1e9]})");
  EXPECT_THAT(answer, ::testing::StartsWith(R"({"converged":false,"reason":")"));
  EXPECT_THAT(answer, ::testing::Not(HasSubstr("null")));
}

TEST(LineariseCommand, AnswersEveryLineAndRefusesAnArmWithoutMass) {
  const std::string file = checkout_file("examples/12_hanging_tentacle/experiment.toml");
  std::istringstream in("{}\nrubbish\n{}");
  std::ostringstream out;
  EXPECT_EQ(linearise_command(file, in, out), exit_done);
  std::istringstream lines(out.str());
  std::vector<std::string> given;
  for (std::string line; std::getline(lines, line);) given.push_back(line);
  ASSERT_EQ(given.size(), 3U);
  EXPECT_THAT(given[0], HasSubstr("\"frequencies_hz\""));
  EXPECT_THAT(given[1], HasSubstr("\"error\""));
  EXPECT_EQ(given[2], given[0]);

  const auto refused = [&](const std::string& example) {
    const std::string name = checkout_file(example);
    std::istringstream none;
    try {
      (void)linearise_command(name, none, out);
    } catch (const InputError& error) {
      return std::string(error.what()).substr(name.size());
    }
    return std::string("no error");
  };
  EXPECT_EQ(refused("examples/09_tendon_statics/experiment.toml"),
            ": section 1: a rod in motion must have a density or a mass per length");
  EXPECT_THAT(refused("examples/01_paper_arm/experiment.toml"), HasSubstr("has no material"));
}

}  // namespace
}  // namespace flexura
