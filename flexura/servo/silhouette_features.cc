#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "flexura/control/contour_images.h"
#include "flexura/control/shape_features.h"
#include "flexura/servo/measured_places.h"
#include "flexura/servo/servo_features.h"

namespace flexura {
namespace {

// Values per camera: two pixels, right and left of each place, then a normal each.
class SilhouetteFeatures : public ServoFeatures {
 public:
  SilhouetteFeatures(const Arm& arm, int points) : contours_(arm, FeatureSet::of_points(points).points) {}

  [[nodiscard]] bool measured(const ArmState& estimate, const std::array<Observation, 2>& seen,
                              Eigen::VectorXd& values) override {
    if (!see(estimate, {seen[0].view, seen[1].view}, values)) return false;
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}})
      measured_edges(images_[i], seen[i], edges_in(values, i));
    return true;
  }
  [[nodiscard]] bool predict(const ArmState& state, const std::array<View, 2>& views,
                             Eigen::VectorXd& values) override {
    return see(state, views, values);
  }
  [[nodiscard]] bool error(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                           const ArmState& estimate, const std::array<View, 2>& views,
                           FeatureError& result) override {
    if (!see(estimate, views, own_)) return false;
    const Eigen::Index rows = contours_.count();
    result.error.resize(2 * rows), result.by_state.resize(2 * rows, contours_.columns());
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
      const auto first = static_cast<Eigen::Index>(i) * rows;
      contour_error(images_[i], edges_in(seen, i), edges_in(desired, i), normals_in(desired, i),
                    result.error.segment(first, rows));
      contours_.derive(views[i], images_[i], result.by_state.middleRows(first, rows));
      // Edges without an image of the target shape give no direction.
      for (Eigen::Index k = 0; k < rows; ++k)
        if (!edges_in(desired, i).col(k).allFinite()) result.by_state.row(first + k).setZero();
    }
    return true;
  }
  // If the arm half-way is outside the lens's view, the derivatives at the current shape remain.
  [[nodiscard]] bool secant(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                            const ShapeError& way, const std::array<View, 2>& views,
                            FeatureError& result) override {
    if (!error(seen, desired, way.seen, views, result)) return false;
    const Eigen::Index rows = contours_.count();
    contours_.set(way.halfway);
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
      directions_[i].resize(2, rows);
      halfway_normals(images_[i].normals, normals_in(desired, i), directions_[i]);
      if (!contours_.see(views[i], halfway_[i])) return true;
    }
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}})
      contours_.derive(views[i], halfway_[i], directions_[i],
                       result.by_state.middleRows(static_cast<Eigen::Index>(i) * rows, rows));
    return true;
  }

 private:
  using Edges = Eigen::Map<Eigen::Matrix2Xd>;
  using ConstEdges = Eigen::Map<const Eigen::Matrix2Xd>;
  [[nodiscard]] Eigen::Index place_of(std::size_t camera) const {
    return 4 * contours_.count() * static_cast<Eigen::Index>(camera);
  }
  [[nodiscard]] Edges edges_in(Eigen::VectorXd& values, std::size_t camera) const {
    return {values.data() + place_of(camera), 2, contours_.count()};
  }
  [[nodiscard]] ConstEdges edges_in(const Eigen::VectorXd& values, std::size_t camera) const {
    return {values.data() + place_of(camera), 2, contours_.count()};
  }
  [[nodiscard]] ConstEdges normals_in(const Eigen::VectorXd& values, std::size_t camera) const {
    return {values.data() + place_of(camera) + 2 * contours_.count(), 2, contours_.count()};
  }

  // Computes the contours of a state, in images_ and as values.
  [[nodiscard]] bool see(const ArmState& state, const std::array<View, 2>& views, Eigen::VectorXd& values) {
    contours_.set(state);
    values.resize(8 * contours_.count());
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
      if (!contours_.see(views[i], images_[i])) return false;
      edges_in(values, i) = images_[i].pixels;
      values.segment(place_of(i) + 2 * contours_.count(), 2 * contours_.count()) =
          images_[i].normals.reshaped();
    }
    return true;
  }

  ContourImages contours_;
  std::array<ContourImage, 2> images_, halfway_;
  std::array<Eigen::Matrix2Xd, 2> directions_;  // Directions of the errors.
  Eigen::VectorXd own_;
};

}  // namespace

std::unique_ptr<ServoFeatures> silhouette_features(const Arm& arm, int points) {
  return std::make_unique<SilhouetteFeatures>(arm, points);
}

}  // namespace flexura
