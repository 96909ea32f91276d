#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "flexura/control/plane_errors.h"
#include "flexura/kinematics/jacobian.h"
#include "flexura/kinematics/spatial.h"
#include "flexura/math/direction.h"
#include "flexura/model/backbone.h"
#include "flexura/servo/measured_places.h"
#include "flexura/servo/servo_features.h"

namespace flexura {
namespace {

// Returns alpha_1 of every chord in the front view, then alpha_2 of every chord in the side view.
Eigen::VectorXd plane_angles_of(const std::array<View, 2>& views,
                                const std::array<Eigen::Matrix2Xd, 2>& pixels) {
  const Eigen::Index chords = pixels[0].cols() - 1;
  Eigen::VectorXd angles(2 * chords);
  for (Eigen::Index k = 0; k < chords; ++k) {
    const Eigen::Vector3d front = views[0].parallel_way(pixels[0].col(k + 1) - pixels[0].col(k)),
                          side = views[1].parallel_way(pixels[1].col(k + 1) - pixels[1].col(k));
    angles[k] = std::atan2(front.x(), front.y());
    angles[chords + k] = std::atan2(side.z(), side.y());
  }
  return angles;
}

// alpha_1 and alpha_2 of each chord as observed in both planes, then theta and q of the estimated shape.
class PlaneFeatures : public ChordFeatures {
 public:
  PlaneFeatures(Arm arm, int points) : arm_(std::move(arm)), shares_(equal_shares(points)) {}

  [[nodiscard]] bool measured(const ArmState& estimate, const std::array<Observation, 2>& seen,
                              Eigen::VectorXd& values) override {
    std::array<Eigen::Matrix2Xd, 2> pixels;
    for (std::size_t i = 0; i < 2; ++i) {
      const auto measured = measured_pixels(arm_, estimate, seen[i], shares_);
      if (!measured) return false;
      pixels[i] = *measured;
    }
    return of_pixels(pixels, estimate, {seen[0].view, seen[1].view}, values);
  }
  [[nodiscard]] const std::vector<double>& shares() const override { return shares_; }
  [[nodiscard]] bool of_pixels(const std::array<Eigen::Matrix2Xd, 2>& pixels, const ArmState& estimate,
                               const std::array<View, 2>& views, Eigen::VectorXd& values) override {
    values = with_chords(plane_angles_of(views, pixels), estimate);
    return true;
  }
  [[nodiscard]] bool predict(const ArmState& state, const std::array<View, 2>& views,
                             Eigen::VectorXd& values) override {
    return measured(state, {Observation{views[0], {}, {}, {}}, Observation{views[1], {}, {}, {}}}, values);
  }
  [[nodiscard]] bool error(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                           const ArmState& estimate, const std::array<View, 2>&,
                           FeatureError& result) override {
    const Eigen::Index chords = seen.size() / 4;
    const double share = 1 / std::sqrt(static_cast<double>(chords));
    result.error.resize(2 * chords);
    result.by_state = chord_derivatives(estimate);
    for (Eigen::Index k = 0; k < chords; ++k) {
      const PlaneError error = chord_error(seen, desired, k);
      const double across = share * std::cos(error.q);
      result.error[2 * k] = across * error.e_theta, result.error[2 * k + 1] = share * error.e_q;
      result.by_state.row(2 * k) *= across, result.by_state.row(2 * k + 1) *= share;
    }
    return true;
  }

 private:
  [[nodiscard]] Eigen::VectorXd with_chords(const Eigen::VectorXd& plane, const ArmState& state) const {
    const Eigen::Index chords = plane.size() / 2;
    Eigen::VectorXd values(2 * plane.size());
    values.head(2 * chords) = plane;
    const Backbone backbone(arm_, state);
    Eigen::Vector3d before = Eigen::Vector3d::Zero();
    for (Eigen::Index k = 0; k <= chords; ++k) {
      const MaterialPoint point = material_point(arm_, shares_[static_cast<std::size_t>(k)] * arm_.length());
      const double s = std::min(arc_length_of(arm_, state, point), backbone.length());
      const Eigen::Vector3d p = backbone.pose(s).position, c = p - before;
      if (k > 0) {
        values[2 * chords + k - 1] = std::atan2(c.x(), c.y());
        values[3 * chords + k - 1] = std::atan2(c.z(), c.head<2>().norm());
      }
      before = p;
    }
    return values;
  }

  // Returns the error observed in the planes, or that of the shape where the planes give little information
  // or no derivative. That is near a quarter turn of theta or of q, and on the way across one.
  [[nodiscard]] static PlaneError chord_error(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                                              Eigen::Index k) {
    const Eigen::Index chords = seen.size() / 4;
    const double theta = seen[2 * chords + k], q = seen[3 * chords + k];
    const double theta_d = desired[2 * chords + k], q_d = desired[3 * chords + k];
    const PlaneView view{seen[k], seen[chords + k]};
    if (!planes_contradict(view) && planes_determine({theta, q}, {nearest_turn(theta_d, theta), q_d}))
      return plane_error(
          view, {nearest_turn(desired[k], seen[k]), nearest_turn(desired[chords + k], seen[chords + k])});
    PlaneError error;
    error.theta = theta, error.q = q;
    error.e_theta = theta - nearest_turn(theta_d, theta), error.e_q = q - q_d;
    return error;
  }

  // Returns the derivatives of theta and q of each chord by the state; rad.
  [[nodiscard]] Eigen::MatrixXd chord_derivatives(const ArmState& state) const {
    const BackboneJacobian backbone(arm_, state);
    const auto columns = 3 * static_cast<Eigen::Index>(arm_.sections.size());
    const auto chords = static_cast<Eigen::Index>(shares_.size()) - 1;
    Eigen::MatrixXd by_state(2 * chords, columns);
    Jacobian before(6, columns), here(6, columns);
    Eigen::Vector3d p_before = Eigen::Vector3d::Zero();
    for (Eigen::Index k = 0; k <= chords; ++k) {
      const MaterialPoint point = material_point(arm_, shares_[static_cast<std::size_t>(k)] * arm_.length());
      backbone.at(point, here);
      const Eigen::Vector3d p = backbone.pose(point).position, c = p - p_before;
      if (k > 0) {
        const Eigen::MatrixXd dc = here.topRows<3>() - before.topRows<3>();
        // A vertical chord has no azimuth: only its q counts, and the theta derivative is zero.
        constexpr double least = 1e-9;
        const double h = std::max(c.head<2>().norm(), least);
        const Eigen::RowVectorXd dh = (c.x() * dc.row(0) + c.y() * dc.row(1)) / h;
        by_state.row(2 * (k - 1)) = (c.y() * dc.row(0) - c.x() * dc.row(1)) / (h * h);
        by_state.row(2 * k - 1) = (h * dc.row(2) - c.z() * dh) / std::max(c.squaredNorm(), least * least);
      }
      p_before = p, before = here;
    }
    return by_state;
  }

  Arm arm_;
  std::vector<double> shares_;
};

}  // namespace

std::unique_ptr<ChordFeatures> plane_features(const Arm& arm, int points) {
  return std::make_unique<PlaneFeatures>(arm, points);
}

}  // namespace flexura
