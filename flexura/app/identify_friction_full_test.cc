// Friction of tendons, identified by the log of a run.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "flexura/app/identify.h"
#include "flexura/experiment/experiment.h"
#include "flexura/store/json.h"
#include "tests/support/checkout.h"
#include "tests/support/runs.h"

namespace flexura {
namespace {

class IdentifyFriction : public Runs, public testing::Test {};

TEST_F(IdentifyFriction, FindsThatOfTheTrueTendons) {
  constexpr double truth = 0.3;
  std::string text = read_text_file(checkout_file("examples/15_step_response/experiment.toml"), 1 << 20);
  text.resize(text.find("[[task]]"));
  for (int i = 0; i < 6; ++i) text += fmt::format("[[truth.arm.tendon]]\nfriction = {}\n", truth);
  text +=
      "[[task]]\nkind = 'sine'\nperiod = 1.5\nduration = 3\namplitude.bends_deg = [[60, 40], [-50, 60]]\n";
  const std::string file = (folder_.path() / "rubbing.toml").string();
  std::ofstream(file) << text;
  const std::vector<std::string> sets = {"record.report=false", "record.scene=false"};
  Quiet quiet;
  const std::string motion =
      run_experiment(load_experiment(file, {sets, {}}), make_new_folder(folder_.path() / "rubbing"), quiet)
          .folder.string();
  std::ostringstream out, err;
  ASSERT_EQ(
      identify_command(
          {.experiment = file, .motion = motion, .noise_mm = 0.2, .friction = true, .json = true}, out, err),
      0)
      << err.str();
  std::istringstream in(out.str());
  std::string line;
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(std::getline(in, line));
  const Node found = parse_json(line, "answer");
  const auto number = [&](const char* key) { return *found.find(key)->as<double>(); };
  EXPECT_EQ(*found.find("parameter")->as<std::string>(), "friction");
  ASSERT_TRUE(*found.find("observable")->as<bool>());
  EXPECT_EQ(number("nominal"), 0) << "the file's arm has no friction";
  EXPECT_NEAR(number("value"), truth, 3 * number("sigma"));
  EXPECT_LT(number("sigma"), 0.1 * truth);
}

}  // namespace
}  // namespace flexura
