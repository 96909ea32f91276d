#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "flexura/camera/view.h"
#include "flexura/estimate/shape_tracker.h"
#include "flexura/model/arm.h"
#include "flexura/port/rig_model.h"
#include "flexura/servo/rig_reader.h"
#include "flexura/servo/servo_config.h"
#include "flexura/servo/servo_observation.h"

namespace flexura {

/// State observer of the arm. The observer estimates the shape from measured pictures and from the motion of
/// the drives since these pictures. The observer also measures how long there has been no observation.
class ShapeObserver {
 public:
  /// `rig` reports the drives' motion. `rig` and `nominal` must outlive this object.
  ShapeObserver(const RigReader& rig, const RigModel& nominal, const ServoConfig& config);

  /// Starts to measure the time without observations at `time`, s of the rig's clock.
  void begin(double time) { seen_since_ = time; }
  /// Estimates the arm's shape at the observation's time. `now`: current time, s of the rig's clock. If the
  /// shape is found, returns true, corrects the observation's views by the estimated camera errors, and
  /// last() becomes this observation. Returns false if it finds no shape, for example if a picture shows no
  /// arm.
  bool observe(const std::shared_ptr<ServoObservation>& observed, double now);
  /// Estimates the shape from only these pictures, without a prediction. Resets the tracker before and after
  /// the estimate.
  void estimate_alone(ServoObservation& observed);
  /// Returns the shape estimated from the observation's measurements under the assumption that `views` are
  /// exact.
  [[nodiscard]] ShapeEstimate with_nominal_views(const ServoObservation& observed,
                                                 const std::array<View, 2>& views) const;

  /// Returns the first observation with a shape; null before there is one.
  [[nodiscard]] const std::shared_ptr<const ServoObservation>& first() const { return first_; }
  /// Returns the newest observation with a shape; null before there is one.
  [[nodiscard]] const std::shared_ptr<const ServoObservation>& last() const { return last_; }
  /// Returns the time since the last observation with a shape, s.
  [[nodiscard]] double blind_for(double now) const { return now - seen_since_; }
  [[nodiscard]] double seen_since() const { return seen_since_; }

  /// Returns the predicted shape at `time`, s, with a covariance that bounds the search in pictures. Before
  /// the first observation, it is the model's shape for the drives' position.
  [[nodiscard]] ShapePrediction prediction(double time) const;
  /// Returns the predicted shape at `time`, s; std::nullopt before the first observation, and for an arm
  /// whose oscillation is tracked: its pictures are searched without a prediction, so that disturbances are
  /// found.
  [[nodiscard]] std::optional<Shape> predicted_shape(double time) const;
  /// Returns the expected equilibrium shape of the arm: the last estimate without oscillation, changed by the
  /// drives' motion since then. `driven`: the model's shape for the drives' position.
  [[nodiscard]] ArmState expected(ArmState driven) const;
  /// Returns the oscillation of the arm at the last observation. Oscillation is not tracked for an arm
  /// without dynamics.
  [[nodiscard]] const SwingFilter& swing() const { return tracker_.swing(); }
  /// Returns the motion of the drives from the last observation until `time`, s, according to their readings.
  /// The result includes the excitation of the oscillation modes by the motion.
  [[nodiscard]] SwingPath path_until(double time, const std::vector<SwingMode>& modes) const;
  /// Returns the standard deviation of the last shape due to the pictures' noise: root mean square along the
  /// arm, share of its length. The value does not include errors of cameras without a prior, because these
  /// errors are equal in every picture.
  [[nodiscard]] double sigma() const;
  /// Returns the standard deviation of the last shape if only the last pictures are used. The filter behind
  /// sigma() assumes independent errors in successive pictures. For an arm at rest, the errors are equal in
  /// all pictures and do not average out. In this case, if camera errors are estimated, sigma() is several
  /// times too small, but sigma_of_last() is correct.
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
