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

/// A rod in motion, by its modes q and their rates v: where its nodes are, the momenta p = dT/dv of the modes
/// and the generalized forces dL/dq + Q, so that dp/dt = force (Lagrange). In the frame of the base; twists
/// and wrenches are about its origin. S is double, or numbers with slopes, for derivatives. Nothing is
/// allocated after the constructor.
template <typename S>
class RodMotion {
 public:
  using Number = typename Wide<S>::type;

  explicit RodMotion(const RodLayout& layout);

  /// Where surroundings may pull beside the nodes; is kept by reference. Null: nowhere.
  void set_points(const RodPoints* points);

  /// Where the nodes are, and how fast.
  void place(const S* q, const S* v);
  /// Whether pull() takes what surroundings did last: the same shape and rates, with other slopes.
  void keep_surroundings(bool keeps) { keeps_surroundings_ = keeps; }
  /// How tendons that rub are held from now on: by `before` N between a piece and the one before it, of all
  /// pieces (RodLayout::pieces), and since then they slide for `time` s as fast as the rod moves where it is
  /// placed. Null: by nothing. `before` is kept by reference.
  void hold(const double* before, double time) {
    held_before_ = before;
    slide_time_ = time;
  }
  /// How many newtons friction gives way to for each metre that a tendon slides before it lets go, of all
  /// pieces; is kept by reference.
  void set_grip(const std::vector<double>& grip) { grip_ = grip.data(); }
  /// What pulls at them, there. `tensions`: of all tendons at the base, N.
  void pull(const RodLoads& loads, const S* tensions, const RodSurroundings* surroundings);
  /// The momenta and the forces, of all modes.
  void balance(S* momentum, S* force);
  /// What is left of the forces when the rates stay as they are: the mass matrix times the modes'
  /// accelerations (Newton, Euler).
  void find_acceleration_forces(S* force);
  /// How long the tendons are, m.
  void find_lengths(S* lengths) const;

  [[nodiscard]] const std::vector<Placement<S>>& nodes() const { return X_; }
  [[nodiscard]] const std::vector<Screw<S>>& velocities() const { return V_; }
  /// Of the bodies at the nodes.
  [[nodiscard]] const std::vector<Screw<S>>& momenta() const { return P_; }
  /// The slopes of the last surroundings' wrenches; none without.
  [[nodiscard]] const std::vector<NodePull>& pulls() const { return pulls_; }
  /// The points that the last surroundings chose, and the same of them.
  [[nodiscard]] const RodPoints* points() const { return points_; }
  [[nodiscard]] std::span<const std::size_t> chosen() const { return chosen_; }
  [[nodiscard]] std::span<const NodeMotion> point_motions() const {
    return {point_motions_.data(), chosen_.size()};
  }
  [[nodiscard]] std::span<const NodePull> point_pulls() const {
    return {point_pulls_.data(), chosen_.size()};
  }
  /// The parts of their intervals up to them, side by side; of points that are nodes, nothing.
  [[nodiscard]] const std::vector<RodInterval<Dual<Number>>>& parts() const { return parts_; }
  /// Whether points are pulled at that are tied to others.
  [[nodiscard]] bool is_coupled() const { return is_coupled_; }
  /// What holds them, emptied first.
  void find_ties(std::vector<PointTie>& ties) const {
    ties.clear();
    if (is_coupled_) touching_->tie(chosen_, point_motions(), ties);
  }
  /// How all points move, after place(); allocates.
  [[nodiscard]] std::vector<NodeMotion> all_point_motions();
  /// Of the intervals, side by side.
  [[nodiscard]] const std::vector<RodInterval<Dual<Number>>>& intervals() const { return intervals_; }

  /// The generalized forces of wrenches at the nodes, of one for each; after place().
  void collect(const std::vector<Screw<S>>& wrenches, S* force);
  /// The change of a tendon's length by the modes, all of them; after place().
  void find_length_slopes(std::size_t tendon, S* slopes);
  /// The generalized forces by a tendon's tension at the base, with the opposite sign: where it does not rub,
  /// its length slopes. `tension`: of the tendon; after pull().
  void find_pull_slopes(std::size_t tendon, double tension, double* slopes);
  /// By how much friction holds each piece of the tendons that rub against the one before, N: the tension
  /// before less that after it. And how fast it slides there, towards the base, m/s. After pull().
  [[nodiscard]] const std::vector<S>& frictions() const { return friction_; }
  [[nodiscard]] const std::vector<S>& slides() const { return slide_; }

  /// At a node, under tensions in channels: the second derivative by its strains of what is for each metre
  /// the sum of the tensions times the tendons' lengths.
  [[nodiscard]] Matrix6d tendon_stiffness(const RodLayout::Section& section, std::size_t node,
                                          const double* tensions) const;

 private:
  struct Pull {
    Screw<S> along;  // What a unit of tension does to the strains of a node.
    S length;        // Of the tendon, for each metre of the rod.
  };
  [[nodiscard]] Screw<S> strain_at(const RodLayout::Section& section, std::size_t node) const;
  [[nodiscard]] static Pull pull_of(const RodLayout::Passage& passage, const Screw<S>& strain);
  [[nodiscard]] Screw<S> strain_rate_at(const RodLayout::Section& section, std::size_t node,
                                        std::size_t s) const;
  void add_stretch_rates();
  void add_tendons(const S* tensions);
  // How its tendons that rub turn and slide; then what friction leaves of a tension.
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
  // Of stiffness, damping, and tendons along the strains.
  void set_inner_forces(S* force) const;
  void add_modes(const std::vector<S>& of_moments, S* sums) const;

  const RodLayout& layout_;
  std::vector<S> q_, v_;            // As it was placed last.
  std::vector<S> moments_, rates_;  // 18 x padded.
  std::vector<RodInterval<Dual<Number>>> intervals_;
  std::vector<S> steps_, speeds_;       // Of the intervals: 12 x padded, 6 x padded.
  std::vector<S> seeds_, changes_;      // 6 x padded: wrenches beyond, in the intervals' frames.
  std::vector<S> collected_, changed_;  // 18 x padded.
  std::vector<Placement<S>> X_;         // Of the nodes.
  std::vector<Screw<S>> V_, P_, W_;
  std::vector<Screw<S>> along_;  // Of the tendons, of the nodes: forces on the strains.
  std::vector<Screw<S>> spare_;
  bool is_pulled_ = false;  // By tendons along its strains.
  // Of the pieces of tendons that rub: what a unit of tension does there; how fast the piece becomes longer,
  // how the tendon slides before it, its turning there times the friction coefficient, what holds it, and the
  // tension.
  std::vector<Screw<S>> units_;
  std::vector<S> growth_, slide_, turn_, friction_, left_;
  std::vector<S> spins_, smooth_;  // Space.
  const double* held_before_ = nullptr;
  const double* grip_ = nullptr;
  double slide_time_ = 0;
  std::vector<NodeMotion> motions_;
  std::vector<NodePull> pulls_;
  const RodPoints* points_ = nullptr;
  bool is_coupled_ = false, keeps_surroundings_ = false;
  const RodSurroundings* touching_ = nullptr;  // The last ones.
  std::vector<double> lengths_;                // Of the intervals, at most.
  std::vector<std::size_t> chosen_;            // Of the points; all below is of these.
  std::vector<RodInterval<Dual<Number>>> parts_;
  std::vector<Placement<S>> point_X_;
  std::vector<Screw<S>> point_V_, point_W_;
  std::vector<NodeMotion> point_motions_;
  std::vector<NodePull> point_pulls_;
  std::vector<PointCoupling> couplings_;
};

// Instantiated for double and Dual<Lanes> in its sources.

}  // namespace flexura
