#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "flexura/kinematics/motion.h"
#include "flexura/model/arm.h"
#include "flexura/safety/spans.h"
#include "flexura/safety/swing.h"
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

  /// For every section that may touch the obstacle, or every pair of sections that may touch each other, in
  /// the order of chains: from the base to the section, or from the pair's first section to its other.
  void for_each_chain(const std::function<void(std::size_t first, std::size_t last)>& visit) const;
  /// Whose contact the last section of a chain is.
  [[nodiscard]] Contact place_of(std::size_t first, std::size_t last) const;
  /// The least clearance that the last section may have anywhere in the chain's swing, m, as it is wished
  /// for. Of an arm at rest: the one that it has.
  [[nodiscard]] double clearance(const Chain& chain, const DistanceWish& wish) const;
  /// Bounds on how deep the contact is in the chain's swing, m (`contact_tolerance` where there is none
  /// deeper). They say no more than whether it is surely free of contact or surely in contact; elsewhere the
  /// upper one is above `contact_tolerance` by what the section may move.
  [[nodiscard]] QuantityBounds bounds(const Chain& chain) const;

 private:
  [[nodiscard]] static QuantityBounds self_bounds(const Chain& chain);
  [[nodiscard]] QuantityBounds obstacle_bounds(const Chain& chain) const;
  template <class Visit>
  void for_each_chain_of(const ArmState& state, const Visit& visit) const;

  Arm arm_;
  std::optional<Obstacle> obstacle_;
  std::vector<double> ignored_;  // the fraction of each section that the obstacle does not count
  double share_ = 1;             // of the arm's motion that changes its distance to the obstacle
};

/// How deep every section, or pair of sections, is in contact with each of the things watched, m
/// (`contact_tolerance` where there is no contact deeper), in a motion that knows its rates. Of many together
/// only whether they are in contact counts: `find_values` gives any depth that occurs above the tolerance,
/// which takes far less than to find the largest one.
class ContactDepths : public WatchedQuantities {
 public:
  /// Watch number `watch`, and the chain from section `first` to `last`.
  struct Part {
    std::size_t watch = 0;
    std::size_t first = 0;
    std::size_t last = 0;
  };

  /// All of these must outlive it.
  ContactDepths(const Arm& arm, const std::vector<ContactWatch>& watches, const Motion& motion);

  [[nodiscard]] std::size_t count() const override { return parts_.size(); }
  [[nodiscard]] const Part& part(std::size_t i) const { return parts_[i]; }
  void find_values(double time, std::span<const std::size_t> which, std::span<double> values) const override;
  void find_bounds(const Span& span, std::span<const std::size_t> which,
                   std::span<QuantityBounds> bounds) const override;
  /// One of them by itself, with bounds that say how deep it may be.
  [[nodiscard]] WatchedQuantity depth(std::size_t i) const;

 private:
  const Arm& arm_;
  const std::vector<ContactWatch>& watches_;
  const Motion& motion_;
  std::vector<Part> parts_;
};

}  // namespace flexura
