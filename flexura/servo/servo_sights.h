#pragma once

#include <optional>
#include <string>

#include "flexura/estimate/shape_estimator.h"
#include "flexura/model/arm.h"
#include "flexura/port/rig_model.h"
#include "flexura/servo/servo_config.h"
#include "flexura/servo/servo_eyes.h"
#include "flexura/servo/servo_goals.h"
#include "flexura/servo/servo_rig.h"
#include "flexura/servo/servo_watcher.h"

namespace flexura {

/// What a servo has seen of its arm, and since when it does not: newest pictures to shapes, with a word to
/// the watcher where the arm is lost and where it is found again. It refers to all that it is made of.
class ServoSights {
 public:
  ServoSights(ServoRig& rig, const RigModel& believed, const ServoConfig& config, ServoWatcher& watcher);

  [[nodiscard]] ServoEyes& eyes() { return eyes_; }
  /// The servo starts at `time`, s of the rig's clock: until then it was not blind.
  void begin(double time);

  /// Measures the newest pair of pictures, if there is one, at `now`, s of the rig's clock; what is wanted at
  /// its time goes with it. Whether it told a shape: `last` is that then.
  bool look(double now, const ServoGoals& goals);

  /// The first of all, and the newest that told a shape.
  [[nodiscard]] const std::optional<ServoSight>& first() const { return first_; }
  [[nodiscard]] const std::optional<ServoSight>& last() const { return last_; }
  /// For how long no picture has told a shape, s.
  [[nodiscard]] double blind_for(double now) const { return now - seen_since_; }
  /// Why none does.
  [[nodiscard]] std::string unseen_because() const;

  /// The shape in which the arm is expected when its drives stand for `state`: as it was seen last, moved by
  /// what they did since.
  [[nodiscard]] ArmState expected(ArmState state) const;
  /// How well the pictures' noise lets a shape be known, root mean square along the arm, share of its length.
  /// What cameras that are wrong and not doubted add to it is there in every picture alike.
  [[nodiscard]] double sigma_of(const ShapeEstimate& estimate) const;

 private:
  [[nodiscard]] std::string no_pictures() const;
  [[nodiscard]] std::string no_shape(const ServoSight& sight) const;
  void tell_unseen(double now, const std::string& why);

  ServoRig& rig_;
  const RigModel& model_;
  const ServoConfig& config_;
  ServoWatcher& watcher_;
  ServoEyes eyes_;
  double start_ = 0, seen_since_ = 0;
  std::string unseen_because_;
  std::optional<ServoSight> first_, last_;
};

}  // namespace flexura
