#pragma once

#include <array>
#include <memory>
#include <optional>

#include "flexura/camera/view.h"
#include "flexura/estimate/shape_tracker.h"
#include "flexura/model/arm.h"
#include "flexura/port/rig_model.h"
#include "flexura/servo/rig_reader.h"
#include "flexura/servo/servo_config.h"
#include "flexura/servo/servo_sight.h"

namespace flexura {

/// What is believed of the arm: in which shape it is, by what was measured of it and by what its drives did
/// since (a state observer), and since when that is not known.
class ShapeObserver {
 public:
  /// `rig`, which says what the drives did, outlives this.
  ShapeObserver(const RigReader& rig, const RigModel& believed, const ServoConfig& config);

  /// Until then, s of the rig's clock, nobody was blind.
  void begin(double time) { seen_since_ = time; }
  /// Fills in the shape in which the arm was at the sight's time, at `now`, s of the rig's clock. Whether it
  /// is found: `last` is this sight then. Where a picture shows no arm it is not. Where it is, the sightings'
  /// views are without the errors that were found with it.
  bool observe(const std::shared_ptr<ServoSight>& sight, double now);
  /// The same of pictures by themselves, of an arm that may have stood anyhow; nothing of it is kept.
  void estimate_alone(ServoSight& sight);
  /// The shape of what was measured, if nothing were wrong with these views.
  [[nodiscard]] ShapeEstimate as_believed(const ServoSight& sight, const std::array<View, 2>& views) const;

  /// The first of all, and the newest that told a shape; null before.
  [[nodiscard]] const std::shared_ptr<const ServoSight>& first() const { return first_; }
  [[nodiscard]] const std::shared_ptr<const ServoSight>& last() const { return last_; }
  /// For how long no picture has told a shape, s.
  [[nodiscard]] double blind_for(double now) const { return now - seen_since_; }
  [[nodiscard]] double seen_since() const { return seen_since_; }

  /// The shape in which the arm is expected where the model makes `driven` of its drives: as it was seen
  /// last, moved by what they did since.
  [[nodiscard]] ArmState expected(ArmState driven) const;
  /// How well the pictures' noise lets the last shape be known, root mean square along the arm, share of its
  /// length. What cameras that are wrong and not doubted add to it is there in every picture alike.
  [[nodiscard]] double sigma() const;

 private:
  void estimate(ServoSight& sight, const std::optional<ArmState>& expected);
  [[nodiscard]] ShapeEstimate shape_of(const ServoSight& sight, const std::optional<ArmState>& expected);

  void forget() { tracker_.forget(), is_believing_ = false; }

  const RigReader& rig_;
  double length_;  // m
  ViewDoubt doubt_;
  ShapePrior prior_;
  ShapeTracker tracker_;
  bool is_believing_ = false;
  double seen_since_ = 0;
  std::shared_ptr<const ServoSight> first_, last_;
};

}  // namespace flexura
