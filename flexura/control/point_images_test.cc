#include "flexura/control/point_images.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>
#include <vector>

#include "flexura/kinematics/jacobian.h"
#include "flexura/kinematics/spatial.h"
#include "tests/support/arms.h"
#include "tests/support/servo_views.h"

namespace flexura {
namespace {

// Returns the product of the positions' derivatives and the lens's.
Eigen::MatrixXd multiplied_out(const Arm& arm, const ArmState& state, const View& view,
                               const std::vector<double>& shares) {
  const BackboneJacobian backbone(arm, state);
  const auto columns = 3 * static_cast<Eigen::Index>(arm.sections.size());
  Eigen::MatrixXd by_state(2 * static_cast<Eigen::Index>(shares.size()), columns);
  Jacobian J(6, columns);
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const MaterialPoint point = material_point(arm, shares[i] * arm.length());
    backbone.at(point, J);
    const auto projection =
        view.lens.project_with_derivatives(view.X_WC.inverse() * backbone.pose(point).position);
    by_state.middleRows<2>(2 * static_cast<Eigen::Index>(i)) =
        projection.value().by_point * view.X_WC.rotation.transpose() * J.topRows<3>();
  }
  return by_state;
}

// Bends of all sizes: around the switch to the series, and far below.
TEST(PointImages, AreThoseOfTheBackbonesJacobian) {
  const std::vector<double> shares = {0, 1e-6, 0.01, 0.2, 0.5, 1.0 / 3, 0.77, 1};
  double worst = 0;
  for_random_cases(300, [&](TestRandom& random) {
    Arm arm = random_arm(random);
    arm.X_WB = servo_arm().X_WB;
    for (Section& section : arm.sections) section.length = 0.6 / static_cast<double>(arm.sections.size());
    ArmState state = random_state(random, arm);
    const double size = std::pow(10, random.uniform(-12, 0));
    for (Eigen::Vector2d& bend : state.bends) bend *= random.integer(0, 9) == 0 ? 0 : size;
    const View view = servo_views()[static_cast<std::size_t>(random.integer(0, 1))];
    PointImages images(arm, shares);
    images.set(state);
    Eigen::Matrix2Xd pixels, alone;
    Eigen::MatrixXd by_state(2 * images.count(), images.columns());
    ASSERT_TRUE(images.see(view, pixels, by_state));
    ASSERT_TRUE(images.see(view, alone));
    const Eigen::MatrixXd desired = multiplied_out(arm, state, view, shares);
    worst = std::max(worst, (by_state - desired).cwiseAbs().maxCoeff());
    EXPECT_LE((by_state - desired).cwiseAbs().maxCoeff(), 1e-12 * desired.cwiseAbs().maxCoeff());
    EXPECT_LE((pixels - alone).cwiseAbs().maxCoeff(), 1e-11);
    const BackboneJacobian backbone(arm, state);
    for (Eigen::Index i = 0; i < images.count(); ++i) {
      const Pose X_WP =
          backbone.pose(material_point(arm, shares[static_cast<std::size_t>(i)] * arm.length()));
      EXPECT_LE((images.place(i) - X_WP.position).norm(), 1e-14);
      EXPECT_LE((pixels.col(i) - view.project(X_WP.position).value()).norm(), 1e-11);
    }
  });
  std::printf("largest difference of a derivative: %.1e px/rad\n", worst);
}

TEST(PointImages, AreNoneBehindTheCamera) {
  const Arm arm = servo_arm();
  PointImages images(arm, {0.5, 1});
  images.set(ArmState::straight(3));
  View view = servo_views()[0];
  view.X_WC.position.z() = -2;
  Eigen::Matrix2Xd pixels;
  Eigen::MatrixXd by_state(4, 9);
  EXPECT_FALSE(images.see(view, pixels));
  EXPECT_FALSE(images.see(view, pixels, by_state));
  EXPECT_THROW(PointImages(arm, {1.1}), std::invalid_argument);
  EXPECT_THROW(images.set(ArmState::straight(2)), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
