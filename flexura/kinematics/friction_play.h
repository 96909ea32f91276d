#pragma once

#include <vector>

#include "flexura/model/arm.h"
#include "flexura/model/drive.h"

namespace flexura {

/// Shape of an arm of arcs whose tendons lose travel by friction (docs/drives.md). A tendon follows its spool
/// within half of the lost travel to either side. The lost travel grows with the tendon's wrap, and so with
/// the shape. Without friction_travel, the tendons follow their spools exactly.
class FrictionPlay {
 public:
  /// Starts with the arm in the shape `start`. Throws the exceptions of tendon_displacements().
  FrictionPlay(const Arm& arm, const Drive& drive, const ArmState& start);

  /// Returns the displacement of the cable at each spool that has just pulled its tendon to the present
  /// shape, m: the tendon's displacement plus half of the lost travel.
  [[nodiscard]] std::vector<double> spools() const;
  /// Returns the shape after the spools have moved, without reversal, to the cable displacements `spools`, m.
  /// Throws std::invalid_argument unless there is one displacement per axis.
  const ArmState& follow(const std::vector<double>& spools);
  /// Returns the present shape.
  [[nodiscard]] const ArmState& state() const { return state_; }

 private:
  [[nodiscard]] double half_travel(std::size_t axis, const std::vector<double>& wraps) const;

  Arm arm_;
  Drive drive_;
  bool is_exact_;  // Friction takes no travel.
  TendonDisplacements now_;
  ArmState state_;
};

}  // namespace flexura
