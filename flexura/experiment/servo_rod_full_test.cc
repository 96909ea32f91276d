// A servo whose arm is an elastic rod that sags, and that believes so.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <variant>

#include "tests/support/random_cases.h"
#include "tests/support/servo_bench.h"
#include "tests/support/servo_worlds.h"

namespace flexura {
namespace {

// The observed shape at the end is as far from the rod as the stated standard deviation allows. Pictures
// determine some six numbers of each pose, so that the mean square of twelve poses in units of sigma^2 is 1
// within 0.17 (one standard deviation). The bounds are four standard deviations below and ten above: the
// errors of an axis found in pictures have a systematic part, and three arcs a section are not quite a rod.
TEST(ServoOfARod, EndsWithinItsStatedSigma) {
  double square = 0, worst = 0;
  int poses = 0, done = 0;
  for_random_cases(12, [&](TestRandom& random) {
    std::string bends;
    for (int i = 0; i < 3; ++i)
      bends += fmt::format("{}[{:.3f}, {:.3f}]", i == 0 ? "" : ", ", random.uniform(-0.9, 0.9),
                           random.uniform(-0.9, 0.9));
    ServoSetup setup;
    setup.arm += "\nbend_profile = [1, 1, 1]";
    std::string text = servo_file(
        fmt::format("tolerance = 0.004\nsettle = 1\n[[task.target]]\nbends = [{}]\n", bends), setup);
    let_sag("arm", 200e9, text);
    ServoBench bench(text);
    const Experiment& experiment = bench.experiment();
    const RigModel nominal = rig_model(experiment.arm_model(), experiment.cameras());
    const ServoConfig config = servo_config(experiment, std::get<ServoTask>(experiment.task.front()), nominal,
                                            bench.ports().arm->read().value().state);
    ServoNotes notes;
    const ServoResult result = servo_in_session(bench.ports(), nominal, config, notes);
    ++poses;
    if (!result.is_done) {
      std::printf("[%s]: %s\n", bends.c_str(), result.reason.c_str());
      return;
    }
    ++done;
    // The arm rests: the last sight is of where it is now.
    const ServoStep& last = result.steps.back();
    ASSERT_TRUE(last.seen);
    ASSERT_TRUE(result.sigma && *result.sigma > 0);
    const Arm arm = experiment.arm_model().shaped();
    const ServoError off = servo_error(bench.rig().arm().backbone(bench.rig().clock().now()),
                                       Backbone(arm, *last.seen), arm.length());
    const double ratio = off.rms / *result.sigma;
    square += ratio * ratio, worst = std::max(worst, ratio);
  });
  ASSERT_GE(4 * done, 3 * poses);
  const double rms = std::sqrt(square / done);
  std::printf("%d of %d poses: %.2f times sigma, %.2f at most\n", done, poses, rms, worst);
  RecordProperty("times_sigma", fmt::format("{:.2f}, largest {:.2f}", rms, worst));
  if (one_case_of == 1) {
    EXPECT_GE(rms, 0.5);
    EXPECT_LE(rms, 2);
  }
  EXPECT_LE(worst, 4);
}

}  // namespace
}  // namespace flexura
