#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "flexura/math/lanes.h"
#include "flexura/math/screw.h"
#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_interval.h"
#include "flexura/mechanics/rod_layout.h"
#include "flexura/mechanics/rod_points.h"
#include "flexura/mechanics/rod_surroundings.h"

namespace flexura {

/// A rod in motion with modes q and rates v. Computes node motions, momenta p = dT/dv and generalized forces
/// dL/dq + Q. Lagrange's equations are dp/dt = dL/dq + Q. All quantities are in the frame of the base; twists
/// and wrenches are about its origin. S is double, or a dual number for derivatives. Allocates only in the
/// constructor.
template <typename S>
class RodMotion {
 public:
  using Number = typename Wide<S>::type;

  explicit RodMotion(const RodLayout& layout);

  /// Sets the points between nodes at which surroundings may act, by reference. Null: no such points.
  void set_points(const RodPoints* points);

  /// Computes poses and velocities of the nodes.
  void place(const S* q, const S* v);
  /// Declares that the slopes of q and v in the next calls of place() are 0 outside the modes of sections
  /// `first` to `last`. `keeps_values`: also declares that values, tensions and loads have not changed since
  /// the last calls of place() and pull(), and only slopes differ. Results that depend only on other sections
  /// are then reused.
  void vary(std::size_t first, std::size_t last, bool keeps_values) {
    first_varied_ = first, last_varied_ = last, keeps_values_ = keeps_values;
  }
  /// If true, pull() reuses the last wrenches of the surroundings. Shape and rates must not have changed, but
  /// slopes may.
  void keep_surroundings(bool keeps) { keeps_surroundings_ = keeps; }
  /// Sets the earlier friction state. `before`: friction force between each piece and the previous piece, N,
  /// for all pieces (RodLayout::pieces), by reference. Null: no friction. `time`: time since the earlier
  /// state, s, in which tendons are assumed to have slid at the present rate.
  void hold(const double* before, double time) {
    held_before_ = before;
    slide_time_ = time;
  }
  /// Sets the bristle stiffness of all pieces, N per metre of sliding, by reference.
  void set_grip(const std::vector<double>& grip) { grip_ = grip.data(); }
  /// Computes wrenches and tendon forces at the present placement. `tensions`: tensions of all tendons at the
  /// base, N.
  void pull(const RodLoads& loads, const S* tensions, const RodSurroundings* surroundings);
  /// Computes momenta and forces of all modes.
  void balance(S* momentum, S* force);
  /// Computes the generalized forces that accelerate the modes: the mass matrix times their accelerations
  /// (Newton-Euler).
  void find_acceleration_forces(S* force);
  /// Computes the lengths of the tendons, m.
  void find_lengths(S* lengths) const;

  [[nodiscard]] const std::vector<Placement<S>>& nodes() const { return X_; }
  [[nodiscard]] const std::vector<Screw<S>>& velocities() const { return V_; }
  /// Returns the momenta of the bodies at the nodes.
  [[nodiscard]] const std::vector<Screw<S>>& momenta() const { return P_; }
  /// Returns the last wrenches of the surroundings, with derivatives; empty without surroundings.
  [[nodiscard]] const std::vector<NodePull>& pulls() const { return pulls_; }
  /// Returns all points.
  [[nodiscard]] const RodPoints* points() const { return points_; }
  /// Returns the indices of the points that the surroundings chose last.
  [[nodiscard]] std::span<const std::size_t> chosen() const { return chosen_; }
  /// Returns the motions of the chosen points.
  [[nodiscard]] std::span<const NodeMotion> point_motions() const {
    return {point_motions_.data(), chosen_.size()};
  }
  /// Returns the wrenches on the chosen points.
  [[nodiscard]] std::span<const NodePull> point_pulls() const {
    return {point_pulls_.data(), chosen_.size()};
  }
  /// Returns the intervals from a node to each chosen point, in lanes; identity for points at nodes.
  [[nodiscard]] const std::vector<RodInterval<Dual<Number>>>& parts() const { return parts_; }
  /// Returns whether wrenches at points depend on the motion of other points.
  [[nodiscard]] bool is_coupled() const { return is_coupled_; }
  /// Sets `ties` to the couplings between points (PointTie).
  void find_ties(std::vector<PointTie>& ties) const {
    ties.clear();
    if (is_coupled_) touching_->tie(chosen_, point_motions(), ties);
  }
  /// Returns the motion of all points, after place(); allocates.
  [[nodiscard]] std::vector<NodeMotion> all_point_motions();
  /// Returns the intervals between nodes, in lanes.
  [[nodiscard]] const std::vector<RodInterval<Dual<Number>>>& intervals() const { return intervals_; }

  /// Computes the generalized forces of one wrench at each node; after place().
  void collect(const std::vector<Screw<S>>& wrenches, S* force);
  /// Computes the derivatives of a tendon's length with respect to all modes; after place().
  void find_length_slopes(std::size_t tendon, S* slopes);
  /// Computes minus the derivatives of the generalized forces with respect to a tendon's tension at the base.
  /// Without friction these are the derivatives of its length. `tension`: the tension at the base, N. Call
  /// after pull().
  void find_pull_slopes(std::size_t tendon, double tension, double* slopes);
  /// Computes minus the derivatives of the generalized forces with respect to the relative change of the
  /// bristle stiffness of a tendon; 0 without friction. `tension`: the tension at the base, N. Call after
  /// pull().
  void find_grip_slopes(std::size_t tendon, double tension, double* slopes);
  /// Returns for each piece the friction force at its junction with the previous piece, N. The force is the
  /// tension of the previous piece minus the tension of this piece. Call after pull().
  [[nodiscard]] const std::vector<S>& frictions() const { return friction_; }
  /// Returns for each piece the sliding speed towards the base at its junction with the previous piece, m/s.
  /// Call after pull().
  [[nodiscard]] const std::vector<S>& slides() const { return slide_; }

  /// Returns the geometric stiffness of tendons in channels at a node, per metre of rod. This stiffness is
  /// the second derivative of the sum of tensions times tendon lengths, with respect to the strains at the
  /// node.
  [[nodiscard]] Matrix6d tendon_stiffness(const RodLayout::Section& section, std::size_t node,
                                          const double* tensions) const;

 private:
  struct Pull {
    Screw<S> along;  // Generalized force of a unit tension on the strains of a node.
    S length;        // Of the tendon, per metre of rod.
  };
  [[nodiscard]] Screw<S> strain_at(const RodLayout::Section& section, std::size_t node) const;
  [[nodiscard]] static Pull pull_of(const RodLayout::Passage& passage, const Screw<S>& strain);
  [[nodiscard]] Screw<S> strain_rate_at(const RodLayout::Section& section, std::size_t node,
                                        std::size_t s) const;
  void choose_sections();
  void add_stretch_rates();
  void add_tendons(const S* tensions);
  // Computes turning and sliding of its tendons with friction; then the remaining tension.
  void find_slides();
  void follow_channel(const RodLayout::Rubbing& rub, std::size_t from, std::size_t to, Triple<S>& direction);
  void follow_chords(const RodLayout::Rubbing& rub, std::size_t from, std::size_t to, Triple<S>& direction);
  void rub(const RodLayout::Rubbing& rub, const S& tension);
  void add_rubbing(const S* tensions);
  void add_surroundings(const RodSurroundings& surroundings);
  void ask_surroundings(const RodSurroundings& surroundings);
  void bound_lengths();
  void place_points();
  void add_point_forces(S* force) const;
  template <typename Add>
  void for_chords(const RodLayout::Section& section, std::size_t tendon, Add&& add) const;
  void add_strain_force(const RodLayout::Section& section, std::size_t node, const Screw<S>& along,
                        S* force) const;
  [[nodiscard]] Screw<S> momentum_of(std::size_t node, const Screw<S>& twist) const;
  // Computes minus the derivatives of the generalized forces along a change of a tendon with friction: the
  // slopes of its tension at the base, and of the relative bristle stiffness.
  void find_rubbing_slopes(const RodLayout::Rubbing& rub, const Dual<double>& tension,
                           const Dual<double>& stiffness, double* slopes);
  // Computes the forces of stiffness, damping, and tendons on the strains.
  void set_inner_forces(S* force) const;
  void add_modes(const std::vector<S>& of_moments, S* sums) const;

  const RodLayout& layout_;
  std::vector<S> q_, v_;            // At the last placement.
  std::vector<S> moments_, rates_;  // 18 x padded.
  std::vector<RodInterval<Dual<Number>>> intervals_;
  std::vector<S> steps_, speeds_;       // For intervals: 12 x padded, 6 x padded.
  std::vector<S> seeds_, changes_;      // 6 x padded: distal wrenches, in the intervals' frames.
  std::vector<S> collected_, changed_;  // 18 x padded.
  std::vector<Placement<S>> X_;         // Of the nodes.
  std::vector<Screw<S>> V_, P_, W_;
  // For sections: whether the last place() computed their intervals anew, and with slopes.
  std::vector<char> is_anew_, has_slopes_;
  std::size_t first_varied_ = 0, last_varied_ = static_cast<std::size_t>(-1);
  bool keeps_values_ = false, are_all_anew_ = true;
  // For tendons and nodes: forces on the strains; those of tendons without friction alone.
  std::vector<Screw<S>> along_, smooth_along_;
  std::vector<Screw<S>> spare_;
  bool is_pulled_ = false;  // Tendons act on its strains.
  // For pieces of tendons with friction: force of a unit tension, rate of the piece's length, sliding speed
  // before it, turning there, this times the friction coefficient, friction force, and tension.
  std::vector<Screw<S>> units_;
  std::vector<S> growth_, slide_, turned_, turn_, friction_, left_;
  std::vector<S> spins_, smooth_;  // Work space.
  const double* held_before_ = nullptr;
  const double* grip_ = nullptr;
  double slide_time_ = 0;
  std::vector<NodeMotion> motions_;
  std::vector<NodePull> pulls_;
  const RodPoints* points_ = nullptr;
  bool is_coupled_ = false, keeps_surroundings_ = false;
  const RodSurroundings* touching_ = nullptr;  // Last surroundings.
  std::vector<double> lengths_;                // Upper bounds for the intervals.
  std::vector<std::size_t> chosen_;            // Chosen points, to which all below refers.
  std::vector<RodInterval<Dual<Number>>> parts_;
  std::vector<Placement<S>> point_X_;
  std::vector<Screw<S>> point_V_, point_W_;
  std::vector<NodeMotion> point_motions_;
  std::vector<NodePull> point_pulls_;
  std::vector<PointCoupling> couplings_;
};

// Instantiated for double and Dual<Lanes> in its sources.

}  // namespace flexura
