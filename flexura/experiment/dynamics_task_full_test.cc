#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "flexura/experiment/experiment.h"
#include "flexura/experiment/run.h"
#include "flexura/experiment/schedule.h"
#include "flexura/log/results.h"
#include "tests/support/dynamics_files.h"
#include "tests/support/quiet.h"
#include "tests/support/servo_files.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

using testing::Contains;
using testing::HasSubstr;

std::string nine_tendons() {
  std::string text = "[drive]\n";
  for (int i = 0; i < 9; ++i)
    text += fmt::format("[[drive.tendon]]\nsection = {}\nangle_deg = {}\n", i / 3 + 1,
                        40 * (i / 3) + 120 * (i % 3));
  return text;
}

// After a servo it starts wherever that ended: violations that the check could not know must be reported when
// known.
TEST(DynamicsFully, WhatBreaksALimitAfterAServoIsUnsafe) {
  for (const bool is_fast : {true, false}) {
    SCOPED_TRACE(is_fast);
    ServoSetup rig;
    rig.rest = nine_tendons();
    const std::string file =
        servo_file("[[task.target]]\nbends = [[0.4, 0.3], [-0.3, 0.4], [0.5, -0.3]]\n", rig) +
        dynamics_task(is_fast ? "law.stiffness = 60\ntarget.bends = [[-0.8, 0.3], [0.5, 0.2], [0.3, -0.4]]\n"
                              : "target.bends = [[0.4, 0.3], [-0.3, 0.4], [0.5, -0.2]]\nlaw.damping = [[40, "
                                "0], [0, 40]]\nduration = 20\n");
    Quiet quiet;
    const Experiment experiment = parse_experiment(file, "x.toml", {{"record.report=false"}, {}});
    const SafetyReport report = check_experiment_safety(experiment, quiet);
    EXPECT_TRUE(report.is_safe());
    EXPECT_THAT(report.caveats, Contains(HasSubstr("only a straight path to the target is checked")));
    const TemporaryFolder folder;
    const RunResult result = run_experiment(experiment, make_new_folder(folder.path() / "results"), quiet);
    EXPECT_EQ(result.outcome, is_fast ? RunOutcome::unsafe : RunOutcome::done)
        << testing::PrintToString(result.reasons);
    if (is_fast) {
      EXPECT_THAT(result.reasons, Contains(HasSubstr("bend rate")));
    }
    EXPECT_EQ(std::filesystem::exists(result.folder / commands_file_name), !is_fast);
  }
}

}  // namespace
}  // namespace flexura
