#pragma once

#include "flexura/model/actuation.h"
#include "flexura/model/arm.h"
#include "flexura/model/backbone.h"

namespace flexura {

/// An arm as somebody describes it: what its drives bend, and the chain of arcs that this makes of it.
///
/// Commands are states of driven(), shapes are states of shaped(). Laws and estimates vary one or the other
/// as they stand; actuation() says what one makes of the other. Where every section is one arc the two are
/// the same arm.
class ArmModel {
 public:
  /// As Actuation says of `driven`, and its errors.
  explicit ArmModel(const Arm& driven)
      : driven_(driven), actuation_(driven), shaped_(shaped_arm(driven, actuation_)) {}
  /// Of an arm whose arcs are known otherwise: one section of `shaped` an arc.
  ArmModel(const Arm& driven, const Actuation& actuation, const Arm& shaped)
      : driven_(driven), actuation_(actuation), shaped_(shaped) {}

  /// The arm as its drives see it: one bend a section.
  [[nodiscard]] const Arm& driven() const { return driven_; }
  /// The same arm with one section an arc.
  [[nodiscard]] const Arm& shaped() const { return shaped_; }
  [[nodiscard]] const Actuation& actuation() const { return actuation_; }

  /// The backbone that a command makes: its arcs say which of driven()'s sections they belong to.
  /// std::invalid_argument: of another arm.
  [[nodiscard]] Backbone backbone(const ArmState& command) const {
    return backbone_of_shape(actuation_.shape(command));
  }
  /// The same of a shape.
  [[nodiscard]] Backbone backbone_of_shape(const ArmState& shape) const {
    return {shaped_, shape, actuation_.section_of()};
  }

 private:
  Arm driven_;
  Actuation actuation_;
  Arm shaped_;
};

}  // namespace flexura
