#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>

#include "flexura/base/progress.h"
#include "flexura/experiment/calibrate_results.h"
#include "flexura/experiment/run.h"
#include "flexura/store/text_file.h"
#include "tests/support/quiet.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

constexpr double degree = std::numbers::pi / 180;

double number_at(const Node& node, const char* key) { return *node.find(key)->as<double>(); }

TEST(CalibrateTaskFully, BringsTheExamplesWrongCamerasToOrthogonalAxesWithinTheirHeadsSteps) {
  const std::filesystem::path file =
      std::filesystem::path(FLEXURA_SOURCE_DIR) / "examples/05_calibration/experiment.toml";
  const TemporaryFolder folder, again;
  Quiet quiet;
  const RunResult result = run_experiment(load_experiment(file), folder.path(), quiet);
  ASSERT_EQ(result.outcome, RunOutcome::done) << result.reasons.front();
  const Node& calibration = result.summary.find("calibrations")->as<Node::Array>()->front();
  const double sigma = number_at(*calibration.find("sigma"), "angle");
  EXPECT_LT(sigma, 0.05 * degree);
  const Node &found = *calibration.find("remainder"), &truth = *calibration.find("remainder_in_truth");
  // Half a step of each of two heads' axes, and what is not known.
  EXPECT_LT(std::abs(number_at(truth, "angle_from_square")), 0.1 * degree);
  EXPECT_LT(std::abs(number_at(truth, "angle_from_square") - number_at(found, "angle_from_square")),
            5 * sigma);
  EXPECT_NEAR(number_at(truth, "zoom_ratio"), 1, 0.01);
  // The same bytes again.
  (void)run_experiment(load_experiment(file), again.path(), quiet);
  for (const char* name : {"log.mcap", "summary.json", "rig.toml", "report.html"})
    EXPECT_EQ(read_text_file(folder.path() / name, 1U << 30), read_text_file(again.path() / name, 1U << 30))
        << name;
}

}  // namespace
}  // namespace flexura
