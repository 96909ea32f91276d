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

/// Depth up to which the arm may touch something without a contact. Distances are right to half of it.
inline constexpr double contact_tolerance = 1e-6;  // m.

/// Largest motion of the arm between two samples where a contact is undecided.
inline constexpr double contact_motion = 1e-4;  // m.

/// Point of least clearance.
struct Contact {
  double clearance = no_distance;              ///< In m; negative: depth.
  std::size_t section = 0;                     ///< From 0.
  std::optional<std::size_t> other_section{};  ///< Other section of a self-contact, possibly the same one.
};

/// Watches one object that the arm may touch: itself or an obstacle.
///
/// For self-contact, all pairs of backbone points count between which the backbone turns by half a turn (pi)
/// or more. If a section of the pair or between them is thinner than the two on average, other pairs count.
/// These have more than half a circle of their mean radius between them. All other pairs cannot meet, or are
/// neighbours (docs/safety.md).
class ContactWatch {
 public:
  explicit ContactWatch(Arm arm);
  ContactWatch(Arm arm, Obstacle obstacle);

  [[nodiscard]] Hazard hazard() const { return obstacle_ ? Hazard::obstacle : Hazard::self_contact; }
  [[nodiscard]] std::string obstacle_name() const { return obstacle_ ? obstacle_->name : ""; }
  /// Returns the least clearance in a possible state, or `cap` if it is not below that.
  [[nodiscard]] Contact contact(const ArmState& state, double cap = no_distance) const;
  /// Returns all sections, or pairs of sections, in contact in a state: deeper than `contact_tolerance`.
  [[nodiscard]] std::vector<Contact> contacts(const ArmState& state) const;

  /// Visits every section that may touch the obstacle, or every pair of sections that may touch each other,
  /// in the order of chains. A chain is from the base to the section, or from the pair's first section to the
  /// other.
  void for_each_chain(const std::function<void(std::size_t first, std::size_t last)>& visit) const;
  /// Returns the contact of a chain's last section, without clearance.
  [[nodiscard]] Contact place_of(std::size_t first, std::size_t last) const;
  /// Returns the least possible clearance of the last section in the chain's swing, m, as precisely as
  /// `query` requires. For an arm at rest it is the clearance.
  [[nodiscard]] double clearance(const Chain& chain, const DistanceQuery& query) const;
  /// Returns bounds on the depth of the contact in the chain's swing, m (`contact_tolerance` without a deeper
  /// one). They only distinguish surely free, surely in contact and undecided. If undecided, the upper bound
  /// exceeds `contact_tolerance` by the section's possible motion.
  [[nodiscard]] QuantityBounds bounds(const Chain& chain) const;

 private:
  [[nodiscard]] static QuantityBounds self_bounds(const Chain& chain);
  [[nodiscard]] QuantityBounds obstacle_bounds(const Chain& chain) const;
  template <class Visit>
  void for_each_chain_of(const ArmState& state, const Visit& visit) const;

  Arm arm_;
  std::optional<Obstacle> obstacle_;
  std::vector<double> ignored_;  // Fraction of each section that is ignored for the obstacle.
  double share_ = 1;             // Share of the arm's motion that changes its distance to the obstacle.
};

/// Depths of the contacts of every section, or pair of sections, with each watched object, m
/// (`contact_tolerance` if none is deeper). For motions with known rates. For many quantities together
/// only contact or no contact matters. So `find_values` returns any depth that occurs above the tolerance,
/// which is much faster than finding the largest one.
class ContactDepths : public WatchedQuantities {
 public:
  /// Watch number `watch`, and the chain from section `first` to `last`.
  struct Part {
    std::size_t watch = 0;
    std::size_t first = 0;
    std::size_t last = 0;
  };

  /// The arguments must outlive this object.
  ContactDepths(const Arm& arm, const std::vector<ContactWatch>& watches, const Motion& motion);

  [[nodiscard]] std::size_t count() const override { return parts_.size(); }
  [[nodiscard]] const Part& part(std::size_t i) const { return parts_[i]; }
  void find_values(double time, std::span<const std::size_t> which, std::span<double> values) const override;
  void find_bounds(const Span& span, std::span<const std::size_t> which,
                   std::span<QuantityBounds> bounds) const override;
  /// Returns one of the quantities, with bounds on its depth.
  [[nodiscard]] WatchedQuantity depth(std::size_t i) const;

 private:
  const Arm& arm_;
  const std::vector<ContactWatch>& watches_;
  const Motion& motion_;
  std::vector<Part> parts_;
};

}  // namespace flexura
