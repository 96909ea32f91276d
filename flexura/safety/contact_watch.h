#pragma once

#include <optional>
#include <string>
#include <vector>

#include "flexura/kinematics/motion.h"
#include "flexura/model/arm.h"
#include "flexura/safety/spans.h"
#include "flexura/safety/tube.h"
#include "flexura/safety/violation.h"

namespace flexura {

/// Contact shallower than this is none: the arm may touch. (Distances are right to half of it.)
inline constexpr double contact_tolerance = 1e-6;  // m

/// Where it is undecided whether there is a contact, the arm moves at most this far between two looks.
inline constexpr double contact_motion = 1e-4;  // m

/// Where something is nearest.
struct Contact {
  double clearance = no_distance;              ///< m; negative: how deep.
  std::size_t section = 0;                     ///< From 0.
  std::optional<std::size_t> other_section{};  ///< Of the arm itself; may be the same section.
};

/// Watches one thing the arm may touch: itself or an obstacle.
///
/// Of itself, all pairs of backbone points count between which the backbone turns by half a turn (pi) or
/// more; and, where some section of theirs or between them is thinner than the two on average, those between
/// which it is longer than half a circle of their mean radius. Others cannot meet, or are neighbours
/// (docs/safety.md).
class ContactWatch {
 public:
  explicit ContactWatch(Arm arm);
  ContactWatch(Arm arm, Obstacle obstacle);

  [[nodiscard]] Hazard hazard() const { return obstacle_ ? Hazard::obstacle : Hazard::self_contact; }
  [[nodiscard]] std::string obstacle_name() const { return obstacle_ ? obstacle_->name : ""; }
  /// The least clearance in a state that is possible, where it is below `cap`; otherwise `cap` stands for it.
  [[nodiscard]] Contact contact(const ArmState& state, double cap = no_distance) const;
  /// Every section, or pair of them, that is in contact in a state: deeper than `contact_tolerance`.
  [[nodiscard]] std::vector<Contact> contacts(const ArmState& state) const;
  /// How deep the contact is, m (`contact_tolerance` where there is none deeper), in a motion that knows its
  /// rates. Its bounds say no more than whether an interval is surely free of contact or surely in contact;
  /// elsewhere the upper one is above `contact_tolerance` by what the arm may move in half the interval.
  [[nodiscard]] WatchedQuantity depth(const Motion& motion) const;

 private:
  struct Reach;
  [[nodiscard]] double ignored(std::size_t section) const;
  [[nodiscard]] QuantityBounds bounds(const Motion& motion, double start, double end) const;
  [[nodiscard]] static QuantityBounds self_bounds(const std::vector<TubeArc>& tubes, const Reach& reach);
  [[nodiscard]] QuantityBounds obstacle_bounds(const std::vector<TubeArc>& tubes, const Reach& reach) const;
  [[nodiscard]] double share_of_motion() const;
  [[nodiscard]] static std::vector<Contact> self_contacts(const std::vector<TubeArc>& tubes);
  [[nodiscard]] static Contact self_contact(const std::vector<TubeArc>& tubes, double cap);
  [[nodiscard]] Contact obstacle_contact(const std::vector<TubeArc>& tubes, double cap) const;

  Arm arm_;
  std::optional<Obstacle> obstacle_;
};

}  // namespace flexura
