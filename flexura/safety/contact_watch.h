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

/// Penetrations up to this depth do not count as contacts. Computed distances have an error of at most half
/// this depth.
inline constexpr double contact_tolerance = 1e-6;  // m.

/// Contacts may remain undecided between two samples if the arm moves by less than this between the samples.
inline constexpr double contact_motion = 1e-4;  // m.

/// Smallest clearance, and where it is.
struct Contact {
  double clearance = no_distance;  ///< Clearance, m; a negative clearance is a penetration depth.
  std::size_t section = 0;         ///< Index of the section; 0 at the base.
  std::optional<std::size_t>
      other_section{};  ///< Index of the other section of a self-contact. It may equal `section`.
};

/// Computes clearances and contacts of the arm with one object: the arm itself or an obstacle.
///
/// For self-contact, a pair of backbone points is considered if the backbone between them turns by pi or
/// more. Further pairs are considered if a section of the pair, or between the pair, is thinner than the
/// pair's mean radius. In these pairs, the backbone between the points is longer than half a circle of the
/// mean radius. All other pairs cannot touch, or are neighbours (docs/safety.md).
class ContactWatch {
 public:
  explicit ContactWatch(Arm arm);
  ContactWatch(Arm arm, Obstacle obstacle);

  [[nodiscard]] Hazard hazard() const { return obstacle_ ? Hazard::obstacle : Hazard::self_contact; }
  [[nodiscard]] std::string obstacle_name() const { return obstacle_ ? obstacle_->name : ""; }
  /// Returns the smallest clearance in a possible state, or `cap` if the clearance is not below `cap`, m.
  [[nodiscard]] Contact contact(const ArmState& state, double cap = no_distance) const;
  /// Returns all sections, or pairs of sections, that are in contact in a state: the penetration depth
  /// exceeds `contact_tolerance`.
  [[nodiscard]] std::vector<Contact> contacts(const ArmState& state) const;

  /// Calls `visit` for every section that may touch the obstacle, or for every pair of sections that may
  /// touch each other. The arguments are the ends of a chain of sections: the base and the section, or the
  /// two sections of the pair.
  void for_each_chain(const std::function<void(std::size_t first, std::size_t last)>& visit) const;
  /// Returns the contact for a chain from section `first` to `last`. The clearance of the result is not set.
  [[nodiscard]] Contact place_of(std::size_t first, std::size_t last) const;
  /// Returns the smallest possible clearance of the chain's last section during the chain's Swing, m, as
  /// precisely as `query` requires. For an arm at rest, this is the clearance.
  [[nodiscard]] double clearance(const Chain& chain, const DistanceQuery& query) const;
  /// Returns bounds on the depth of the contact during the chain's Swing, m, or `contact_tolerance` if there
  /// is no deeper contact. The bounds only distinguish three cases: certainly free, certainly in contact, and
  /// undecided. If undecided, the upper bound is `contact_tolerance` plus the section's possible motion.
  [[nodiscard]] QuantityBounds bounds(const Chain& chain) const;

 private:
  [[nodiscard]] static QuantityBounds self_bounds(const Chain& chain);
  [[nodiscard]] QuantityBounds obstacle_bounds(const Chain& chain) const;
  template <class Visit>
  void for_each_chain_of(const ArmState& state, const Visit& visit) const;

  Arm arm_;
  std::optional<Obstacle> obstacle_;
  std::vector<double> ignored_;  // Fraction of each section, from its base, that may touch the obstacle.
  double share_ = 1;             // Fraction of the arm's motion that can change its distance to the obstacle.
};

/// Depths of the contacts of every section, or pair of sections, with each watched object, m, or
/// `contact_tolerance` if there is no deeper contact. The motion must have known bounds on its rates. A
/// search over many quantities only needs to know whether there is a contact. Hence `find_values` returns any
/// existing depth above the tolerance, which is much faster to compute than the largest depth.
class ContactDepths : public WatchedQuantities {
 public:
  /// Quantity of the watch with index `watch`, for the chain from section `first` to `last`.
  struct Part {
    std::size_t watch = 0;
    std::size_t first = 0;
    std::size_t last = 0;
  };

  /// All arguments must outlive this object.
  ContactDepths(const Arm& arm, const std::vector<ContactWatch>& watches, const Motion& motion);

  [[nodiscard]] std::size_t count() const override { return parts_.size(); }
  [[nodiscard]] const Part& part(std::size_t i) const { return parts_[i]; }
  void find_values(double time, std::span<const std::size_t> which, std::span<double> values) const override;
  void find_bounds(const Span& span, std::span<const std::size_t> which,
                   std::span<QuantityBounds> bounds) const override;
  /// Returns quantity number i as a single quantity, whose value is the largest depth.
  [[nodiscard]] WatchedQuantity depth(std::size_t i) const;

 private:
  const Arm& arm_;
  const std::vector<ContactWatch>& watches_;
  const Motion& motion_;
  std::vector<Part> parts_;
};

}  // namespace flexura
