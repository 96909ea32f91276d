#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "flexura/experiment/experiment.h"
#include "flexura/experiment/run.h"
#include "flexura/store/json.h"
#include "tests/support/checkout.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

// With a drive, with an elastic arm, and with a servo.
TEST(RunWithoutFiles, HasTheSummaryOfARunWithFiles) {
  for (const char* example : {"02_laboratory_arm", "09_tendon_statics", "19_campaign"}) {
    const std::string file = checkout_file("examples/" + std::string(example) + "/experiment.toml");
    const Experiment experiment = load_experiment(file, {{"record.cameras=false"}, {}});
    const TemporaryFolder folder;
    NoProgress progress;
    const auto before = std::filesystem::current_path();
    std::filesystem::current_path(folder.path());
    const RunResult without = run_experiment(experiment, {}, progress);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << example;
    std::filesystem::current_path(before);
    const RunResult with = run_experiment(experiment, folder.path(), progress);
    EXPECT_FALSE(std::filesystem::is_empty(folder.path())) << example;
    EXPECT_EQ(write_json(without.summary), write_json(with.summary)) << example;
    EXPECT_EQ(without.headline, with.headline);
  }
}

}  // namespace
}  // namespace flexura
