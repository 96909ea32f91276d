#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>

#include "flexura/control/contour_images.h"
#include "flexura/servo/measured_places.h"
#include "tests/support/observation_keeper.h"
#include "tests/support/random_cases.h"
#include "tests/support/servo_bench.h"

namespace flexura {
namespace {

// Compares the edges in pictures with the contours of the true arm in the true cameras.
TEST(MeasuredEdges, AreTheTrueContours) {
  ServoSetup rig;
  rig.sensor = "read_noise = 1, delay = 0, exposure = 0";
  ServoBench bench(servo_file("camera_prior = { rotation_std = 0, focal_std = 0 }\n" + servo_target, rig));
  ObservationKeeper keeper(bench);
  const RigModel model = bench.nominal();
  (void)servo_in_session(bench.ports(), model, bench.config(), keeper);
  ContourImages contours(bench.experiment().arm.arm(), {0.1, 0.3, 0.5, 0.7, 0.9});
  double squares = 0;
  int places = 0, moved = 0;
  for (std::size_t n = 0; n < keeper.observations.size(); ++n) {
    contours.set(keeper.truth[n]);
    for (std::size_t i = 0; i < 2; ++i) {
      const Observation& seen = keeper.observations[n].seen[i];
      ContourImage truth;
      ASSERT_TRUE(contours.see(bench.rig().camera(i).view(keeper.observations[n].time), truth));
      Eigen::Matrix2Xd pixels(2, contours.count());
      measured_edges(truth, seen, pixels);
      for (Eigen::Index k = 0; k < contours.count(); ++k) {
        if (!truth.has(k)) continue;
        const double off = truth.normals.col(k).dot(pixels.col(k) - truth.pixels.col(k));
        squares += std::min(off * off, 1.0), ++places;
        if (off != 0) ++moved;
      }
    }
  }
  const double rms = std::sqrt(squares / std::max(1, places));
  std::printf("%d places, %d measured, %.3f px from the true contours\n", places, moved, rms);
  EXPECT_GT(moved, places / 2);
  EXPECT_LT(rms, 0.15);
}

// From straight to random targets, by pictures: edges must bring the arm wherever points do.
TEST(Servo, ComesBySilhouettesFromWhereverItComesByPoints) {
  int by_points = 0, by_edges = 0;
  for_random_cases(8, [&](TestRandom& random) {
    ArmState target = ArmState::straight(3);
    for (Eigen::Vector2d& bend : target.bends) bend = random.vector<2>(-1.2, 1.2);
    for (const ServoLawKind law : {ServoLawKind::points, ServoLawKind::silhouettes}) {
      ServoBench bench(servo_file("tolerance = 0.003\nsettle = 1\ntimeout = 8\n" + servo_target));
      ServoConfig config = bench.config();
      config.law = law, config.goals = {{0, target}};
      ServoNotes notes;
      const RigModel model = bench.nominal();
      const ServoResult result = servo_in_session(bench.ports(), model, config, notes);
      const double left = bench.truth(target).rms;
      const bool is_edges = law == ServoLawKind::silhouettes;
      std::printf("%s: %s in %.2f s, %.4f %% of the length left\n", is_edges ? "silhouettes" : "points",
                  result.is_done ? "there" : result.reason.c_str(), result.settled.value_or(-1), 100 * left);
      (is_edges ? by_edges : by_points) += result.is_done && left < 0.005 ? 1 : 0;
    }
  });
  EXPECT_GE(by_edges, by_points);
  EXPECT_GT(by_points, 0);
}

}  // namespace
}  // namespace flexura
