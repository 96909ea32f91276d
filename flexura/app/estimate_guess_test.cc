// `flexura estimate --guess`: the arm is fitted near a guessed shape.
#include "flexura/app/estimate_guess.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <utility>

#include "flexura/base/source.h"
#include "tests/support/estimate_bench.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

class EstimateGuess : public EstimateBench {
 protected:
  void SetUp() override {
    EstimateBench::SetUp();
    arguments_.arm = (folder_.path() / "arm.toml").string();
    arguments_.guess = (folder_.path() / "guess.json").string();
  }
  void guess(const std::string& text) { write_new_file(arguments_.guess, text); }
  std::string refusal() {
    std::ostringstream out;
    try {
      estimate_command(arguments_, out);
    } catch (const InputError& error) {
      return error.what();
    }
    return out.str();
  }
};

TEST_F(EstimateGuess, FindsTheArmNearIt) {
  guess(R"({"bends": [[0.7, 0.35], [-1.05, 0.8], [0.8, -0.7]]})");
  const Node found = answer(exit_done);
  EXPECT_LT(error(found), 1e-3) << write_json(found);
  EXPECT_LT(*found.find("rms_px")->as<double>(), 0.2);
}

TEST_F(EstimateGuess, TakesAnEarlierAnswer) {
  const std::string file = arguments_.guess;
  arguments_.guess.clear();
  const Node first = answer(exit_done);
  arguments_.guess = file;
  guess(write_json(first, 2));
  arguments_.guess_std = 0.02;
  const Node again = answer(exit_done);
  EXPECT_LT(error(again), 1e-3);
  EXPECT_EQ(*again.find("trusted")->as<bool>(), true) << write_json(again);
}

TEST_F(EstimateGuess, FlagsAWrongOne) {
  guess(R"({"bends": [[-1.2, -0.9], [1.5, 0.9], [0.5, 1.2]]})");
  std::ostringstream out;
  (void)estimate_command(arguments_, out);
  const Node found = parse_json(out.str(), "answer");
  EXPECT_EQ(*found.find("trusted")->as<bool>(), false) << out.str();
}

TEST_F(EstimateGuess, RefusesBadInputInOneLine) {
  EXPECT_THAT(refusal(), HasSubstr("guess.json"));
  guess("{\"bends\": [[0, 0]]}");
  EXPECT_THAT(refusal(), HasSubstr("guess.json:1:1: bends: 1 bends for 3 sections"));
  for (const auto& [text, words] : {
           std::pair<std::string, std::string>{"[]", "expected an object with the key \"bends\""},
           {"{}", "expected an object with the key \"bends\""},
           {"{\"bends\": [[0, 0], [0], [0, 0]]}", "bends[1]: expected two numbers"},
           {"{\"bends\": [[0, 0], [0, \"a\"], [0, 0]]}", "bends[1]: expected two numbers"},
           {"{\"bends\": [[0, 0], [0, 1e9], [0, 0]]}", "bends[1]: expected two numbers"},
           {"{\"bends\": [[0, 0], ", "guess.json"},
       }) {
    replace_file(arguments_.guess, text);
    EXPECT_THAT(refusal(), HasSubstr(words)) << text;
  }
  replace_file(arguments_.guess, "{\"bends\": [[0, 0], [0, 0], [0, 0]]}");
  arguments_.guess_std = 0;
  EXPECT_THAT(refusal(), HasSubstr("--guess-std: 0 rad: expected a number above 0"));
  arguments_.guess_std.reset();
  arguments_.markers = {"0.5"};
  EXPECT_THAT(refusal(), HasSubstr("--guess: --markers is not used"));
  arguments_.markers.clear();
  arguments_.threshold.level = 100;
  EXPECT_THAT(refusal(), HasSubstr("--guess: no threshold is used"));
  arguments_.threshold.level.reset();
  arguments_.arm.clear();
  EXPECT_THAT(refusal(), HasSubstr("--guess: expected also --arm"));
  arguments_.guess.clear();
  arguments_.guess_std = 0.1;
  EXPECT_THAT(refusal(), HasSubstr("--guess-std: expected --guess"));
}

}  // namespace
}  // namespace flexura
