#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>

#include "flexura/camera/view.h"
#include "flexura/estimate/shape_tracker.h"
#include "flexura/model/arm.h"
#include "flexura/port/rig_model.h"
#include "flexura/servo/rig_reader.h"
#include "flexura/servo/servo_config.h"
#include "flexura/servo/servo_observation.h"

namespace flexura {

/// State observer of the arm: estimates its shape from measurements and the drives' motion since, and counts
/// the time without observations.
class ShapeObserver {
 public:
  /// `rig`, which gives the drives' motion, and `nominal` must outlive this object.
  ShapeObserver(const RigReader& rig, const RigModel& nominal, const ServoConfig& config);

  /// The time without observations counts from `time`, s of the rig's clock.
  void begin(double time) { seen_since_ = time; }
  /// Estimates the arm's shape at the observation's time, at `now`, s of the rig's clock. Returns true and
  /// sets `last` to this observation if the shape is found. Returns false if a picture shows no arm. The
  /// views of a found observation are corrected by the errors estimated with it.
  bool observe(const std::shared_ptr<ServoObservation>& observed, double now);
  /// Estimates the shape from these pictures alone, of an arm in any shape. Keeps nothing of it.
  void estimate_alone(ServoObservation& observed);
  /// Returns the shape estimated from the measurements with these views taken as exact.
  [[nodiscard]] ShapeEstimate with_nominal_views(const ServoObservation& observed,
                                                 const std::array<View, 2>& views) const;

  /// First observation, and newest one with a shape; null before.
  [[nodiscard]] const std::shared_ptr<const ServoObservation>& first() const { return first_; }
  [[nodiscard]] const std::shared_ptr<const ServoObservation>& last() const { return last_; }
  /// Returns the time since an observation last gave a shape, s.
  [[nodiscard]] double blind_for(double now) const { return now - seen_since_; }
  [[nodiscard]] double seen_since() const { return seen_since_; }

  /// Returns the expected shape of the arm at rest if the model gives `driven` for the drives: the last
  /// estimate, without its swing, plus the drives' motion since.
  [[nodiscard]] ArmState expected(ArmState driven) const;
  /// Returns the swing of the arm at the last observation; not tracked for an arm that does not swing.
  [[nodiscard]] const SwingFilter& swing() const { return tracker_.swing(); }
  /// Returns the motion of the drives from the last observation until `time`, s, by their readings.
  [[nodiscard]] SwingPath path_until(double time) const;
  /// Returns the standard deviation of the last shape from the pictures' noise, root mean square along the
  /// arm, share of its length. Errors of cameras without a prior are equal in every picture and are not
  /// included.
  [[nodiscard]] double sigma() const;
  /// The same by the last pictures alone, without earlier ones. The filter takes the errors of
  /// successive pictures as independent. Those of an arm at rest are not, and do not average: its `sigma()`
  /// is then too small, several times so if camera errors are estimated. This one holds there.
  [[nodiscard]] double sigma_of_last() const;

 private:
  // Standard deviation of the shape along the arm, share of its length.
  [[nodiscard]] double relative_sigma(const ShapeEstimate& estimate) const;
  void estimate(ServoObservation& observed, const std::optional<ArmState>& expected, const SwingPath& path);
  [[nodiscard]] ShapeEstimate shape_of(const ServoObservation& observed,
                                       const std::optional<ArmState>& expected, const SwingPath& path);

  void forget() { tracker_.forget(), uses_nominal_views_ = false; }
  // Returns the predicted shape at the time of an observation, without the change of the swing.
  [[nodiscard]] ArmState predicted(double time) const;

  const RigReader& rig_;
  const RigModel& nominal_;
  double length_;  // m
  ViewPrior view_prior_;
  ShapePrior prior_;
  ShapeTracker tracker_;
  bool uses_nominal_views_ = false;
  double seen_since_ = 0;
  std::shared_ptr<const ServoObservation> first_, last_;
  Eigen::VectorXd rate_;  // Of the drives' motion at the last observation, (bends, stretch) a section, 1/s.
};

}  // namespace flexura
