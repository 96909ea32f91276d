#pragma once

#include "flexura/model/actuation.h"
#include "flexura/model/arm.h"
#include "flexura/model/backbone.h"

namespace flexura {

/// Model of an arm: the sections that its drives bend, and the resulting chain of arcs.
///
/// Commands are states of driven(), shapes are states of shaped(). Laws and estimates vary one of them;
/// actuation() converts between them. If every section is one arc, both are the same arm.
class ArmModel {
 public:
  /// Uses the Actuation of `driven`. Throws its errors.
  explicit ArmModel(const Arm& driven)
      : driven_(driven), actuation_(driven), shaped_(shaped_arm(driven, actuation_)) {}
  /// For an arm whose arcs are given: one section of `shaped` per arc.
  ArmModel(const Arm& driven, const Actuation& actuation, const Arm& shaped)
      : driven_(driven), actuation_(actuation), shaped_(shaped) {}

  /// Returns the arm as its drives see it: one bend per section.
  [[nodiscard]] const Arm& driven() const { return driven_; }
  /// Returns the arm with one section per arc.
  [[nodiscard]] const Arm& shaped() const { return shaped_; }
  [[nodiscard]] const Actuation& actuation() const { return actuation_; }

  /// Returns the backbone for a command; its arcs have the numbers of driven()'s sections. Throws
  /// std::invalid_argument for a command of another arm.
  [[nodiscard]] Backbone backbone(const ArmState& command) const {
    return backbone_of_shape(actuation_.shape(command));
  }
  /// Returns the backbone of a shape. Throws std::invalid_argument for a shape of another arm.
  [[nodiscard]] Backbone backbone_of_shape(const ArmState& shape) const {
    return {shaped_, shape, actuation_.section_of()};
  }

 private:
  Arm driven_;
  Actuation actuation_;
  Arm shaped_;
};

}  // namespace flexura
