#pragma once

#include "flexura/model/actuation.h"
#include "flexura/model/arm.h"
#include "flexura/model/backbone.h"

namespace flexura {

/// Model of an arm: the sections that the drives bend, and the resulting chain of arcs.
///
/// Commands are states of driven(); shapes are states of shaped(). actuation() converts between commands and
/// shapes. If every section is one arc, driven() and shaped() are the same arm.
class ArmModel {
 public:
  /// Uses Actuation(driven). Throws the exceptions of this constructor of Actuation.
  explicit ArmModel(const Arm& driven)
      : driven_(driven), actuation_(driven), shaped_(shaped_arm(driven, actuation_)) {}
  /// Uses the given actuation; `shaped` has one section for each arc.
  ArmModel(const Arm& driven, const Actuation& actuation, const Arm& shaped)
      : driven_(driven), actuation_(actuation), shaped_(shaped) {}

  /// Returns the arm in terms of the sections that the drives bend. The states of this arm are the commands,
  /// which have one bend per section.
  [[nodiscard]] const Arm& driven() const { return driven_; }
  /// Returns the arm with one section per arc. Its states are shapes.
  [[nodiscard]] const Arm& shaped() const { return shaped_; }
  [[nodiscard]] const Actuation& actuation() const { return actuation_; }

  /// Returns the backbone for a command. Arc::section refers to the sections of driven(). Throws
  /// std::invalid_argument if the command does not have one bend and one stretch per section.
  [[nodiscard]] Backbone backbone(const ArmState& command) const {
    return backbone_of_shape(actuation_.shape(command));
  }
  /// Returns the backbone of a shape. Throws std::invalid_argument if the shape does not have one bend and
  /// one stretch per arc.
  [[nodiscard]] Backbone backbone_of_shape(const ArmState& shape) const {
    return {shaped_, shape, actuation_.section_of()};
  }

 private:
  Arm driven_;
  Actuation actuation_;
  Arm shaped_;
};

}  // namespace flexura
