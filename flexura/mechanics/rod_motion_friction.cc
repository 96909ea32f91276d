// Tendon friction in motion: turning and sliding of tendons along their paths, and the remaining tension
// (docs/mechanics.md, "Tendon friction in motion").
#include <algorithm>
#include <cstddef>
#include <type_traits>

#include "flexura/mechanics/rod_motion.h"
#include "flexura/mechanics/rod_numbers.h"

namespace flexura {
namespace {

// Relative to a section's turning of a tendon: smaller turning is smoothed.
constexpr double least_turn = 1e-7;
// Turning times friction coefficient above which no tension remains.
constexpr double most_turn = 30;
// Sliding, in units of the bristles' deflection, after which friction is at its limit.
constexpr double let_go = 40;

inline double number_of(double value) { return value; }
inline double number_of(const Dual<double>& value) { return value.value; }
inline double number_of(const Dual<Lanes>& value) { return value.value[0]; }

// |a|, smooth at 0.
template <typename S>
S size_of(const Triple<S>& a, double least) {
  return square_root(least * least + dot(a, a)) - (least + S{});
}

template <typename S>
S turn_between(const Triple<S>& a, const Triple<S>& b) {
  return arc_tangent(size_of(cross(a, b), least_turn), dot(a, b));
}

template <typename S>
S at_most(const S& value, double most) {
  return number_of(value) > most ? most + S{} : value;
}

// Friction force where a tendon turns by `turn` (times the coefficient) after sliding by `slide` m towards
// the base, starting from `before`. P. R. Dahl's bristles: dF/ds = grip (1 -+ F / limit), so that it
// approaches the capstan's limit from any value and does not exceed it.
template <typename S>
S held_by(const S& tension, const S& turn, const S& slide, double grip, double before) {
  const S one = 1.0 + S{};
  const S inwards = tension * (one - exponential(S{} - turn)), outwards = tension * (exponential(turn) - one);
  const bool goes_in = number_of(slide) >= 0;
  const S limit = goes_in ? inwards : outwards;
  const S end = goes_in ? inwards : S{} - outwards;
  const S way = goes_in ? slide : S{} - slide;
  if (!(let_go * number_of(limit) > grip * number_of(way)) || !(number_of(limit) > 0)) return end;
  S from = before + S{};
  if (before > number_of(inwards)) from = inwards;
  if (before < -number_of(outwards)) from = S{} - outwards;
  return end + (from - end) * exponential(S{} - grip * way / limit);
}

}  // namespace

template <typename S>
Screw<S> RodMotion<S>::strain_rate_at(const RodLayout::Section& section, std::size_t node,
                                      std::size_t s) const {
  Screw<S> rate{};
  rate.linear.z = layout_.stretches[s] + S{};
  const auto modes = section.grid.at_node.col(static_cast<Eigen::Index>(node));
  for (std::size_t j = 0; j < section.modes; ++j)
    component(rate, section.strain[j]) += modes[static_cast<Eigen::Index>(j)] * v_[section.first_mode + j];
  return rate;
}

// Pieces of a section where the tendon runs in a channel. `direction`: of the tendon before, in the frame of
// the section's base; on return after it, in the frame of its end.
template <typename S>
void RodMotion<S>::follow_channel(const RodLayout::Rubbing& rub, std::size_t from, std::size_t to,
                                  Triple<S>& direction) {
  const std::size_t s = rub.pieces[from].section;
  const RodLayout::Section& section = layout_.sections[s];
  const auto index =
      static_cast<std::size_t>(std::ranges::find(section.tendons, rub.tendon) - section.tendons.begin());
  const RodLayout::Passage* passages = section.passages.data() + index * (section.intervals + 1);
  const auto turn_at_joint = [&] {
    return from == 0 ? S{} : turn_between(direction, units_[rub.first + from].linear);
  };
  if (is_anew_[s] == 0) {
    turned_[rub.first + from] = turn_at_joint();
    direction = units_[rub.first + to - 1].linear;
    return;
  }
  for (std::size_t p = from; p < to; ++p) {
    const std::size_t k = rub.pieces[p].at, at = rub.first + p;
    const RodLayout::Passage& passage = passages[k];
    const Screw<S> strain = strain_at(section, k);
    const Pull pull = pull_of(passage, strain);
    units_[at] = pull.along;
    const Screw<S> rate = strain_rate_at(section, k, s);
    growth_[at] =
        rub.pieces[p].run * (dot(pull.along.linear, rate.linear) + dot(pull.along.angular, rate.angular));
    // Derivative of the tangent by arc length, rotation of the cross-section included.
    Screw<S> slope{};
    const Vector6d& rest = section.grid.rest_slope[k];
    for (std::size_t c = 0; c < 6; ++c) component(slope, c) = rest[static_cast<Eigen::Index>(c)] + S{};
    const auto modes = section.grid.slope_at_node.col(static_cast<Eigen::Index>(k));
    for (std::size_t j = 0; j < section.modes; ++j)
      component(slope, section.strain[j]) += modes[static_cast<Eigen::Index>(j)] * q_[section.first_mode + j];
    const Triple<S> way = pull.length * pull.along.linear;
    const Triple<S> turning = cross(strain.angular, way + constant<S>(passage.slope)) + slope.linear +
                              cross(slope.angular, constant<S>(passage.offset)) + constant<S>(passage.second);
    spins_[p] = size_of(cross(way, turning), least_turn / section.length) / (pull.length * pull.length);
  }
  S before{};
  for (std::size_t p = from; p < to; ++p) {
    const auto row = section.grid.cumulative.row(static_cast<Eigen::Index>(rub.pieces[p].at));
    S sum{};
    for (std::size_t m = from; m < to; ++m)
      sum += section.length * row[static_cast<Eigen::Index>(rub.pieces[m].at)] * spins_[m];
    turned_[rub.first + p] = p == from ? turn_at_joint() : sum - before;
    before = sum;
  }
  direction = units_[rub.first + to - 1].linear;
}

// Pieces between disks.
template <typename S>
void RodMotion<S>::follow_chords(const RodLayout::Rubbing& rub, std::size_t from, std::size_t to,
                                 Triple<S>& direction) {
  const RodLayout::Section& section = layout_.sections[rub.pieces[from].section];
  const auto index =
      static_cast<std::size_t>(std::ranges::find(section.tendons, rub.tendon) - section.tendons.begin());
  direction = X_[section.first_node].turn(direction);
  const RodLayout::Passage* passages = section.passages.data() + index * (section.intervals + 1);
  for (std::size_t p = from; p < to; ++p) {
    const std::size_t piece = rub.pieces[p].at, at = rub.first + p;
    const std::size_t begin = section.disks[piece], end = section.disks[piece + 1];
    const Placement<S>&A = X_[section.first_node + begin], &B = X_[section.first_node + end];
    const Triple<S> a = A.position + A.turn(constant<S>(passages[begin].offset));
    const Triple<S> b = B.position + B.turn(constant<S>(passages[end].offset));
    const Triple<S> u = ((1.0 + S{}) / square_root(dot(b - a, b - a))) * (b - a);
    units_[at] = wrench_at(a, u);
    const Screw<S> apart = V_[section.first_node + end] - V_[section.first_node + begin];
    growth_[at] = dot(units_[at].linear, apart.linear) + dot(units_[at].angular, apart.angular);
    turned_[at] = p == 0 ? S{} : turn_between(direction, u);
    direction = u;
  }
  direction = X_[section.first_node + section.intervals].turn_back(direction);
}

template <typename S>
void RodMotion<S>::find_slides() {
  for (const RodLayout::Rubbing& rub : layout_.rubbing) {
    Triple<S> direction{};
    for (std::size_t from = 0; from < rub.pieces.size();) {
      std::size_t to = from;
      while (to < rub.pieces.size() && rub.pieces[to].section == rub.pieces[from].section) ++to;
      if (layout_.sections[rub.pieces[from].section].disks.empty())
        follow_channel(rub, from, to, direction);
      else
        follow_chords(rub, from, to, direction);
      from = to;
    }
    // It is fastened at its end. The part beyond a place becomes shorter by the sliding there towards the
    // base.
    S slide{};
    for (std::size_t p = rub.pieces.size(); p-- > 0;) {
      const std::size_t at = rub.first + p;
      slide -= growth_[at];
      slide_[at] = slide;
      // The quadrature may be negative between nodes where the tendon hardly turns.
      const S turned = number_of(turned_[at]) > 0 ? turned_[at] : S{};
      turn_[at] = at_most(rub.friction * turned, most_turn);
    }
  }
}

template <typename S>
void RodMotion<S>::rub(const RodLayout::Rubbing& rub, const S& tension) {
  S left = tension;
  for (std::size_t p = 0; p < rub.pieces.size(); ++p) {
    const std::size_t at = rub.first + p;
    if (p > 0) {
      friction_[at] = held_by(left, turn_[at], slide_time_ * slide_[at], grip_[at],
                              held_before_ != nullptr ? held_before_[at] : 0.0);
      left -= friction_[at];
    }
    left_[at] = left;
  }
}

template <typename S>
void RodMotion<S>::add_rubbing(const S* tensions) {
  for (const RodLayout::Rubbing& each : layout_.rubbing) {
    if (plain(tensions[each.tendon]) == 0) continue;
    rub(each, tensions[each.tendon]);
    for (std::size_t p = 0; p < each.pieces.size(); ++p) {
      const RodLayout::Piece& piece = each.pieces[p];
      const RodLayout::Section& section = layout_.sections[piece.section];
      const std::size_t at = each.first + p;
      const Screw<S> pull = left_[at] * units_[at];
      if (section.disks.empty()) {
        along_[section.first_node + piece.at] += pull;
      } else {
        W_[section.first_node + section.disks[piece.at]] += pull;
        W_[section.first_node + section.disks[piece.at + 1]] -= pull;
      }
    }
  }
}

template <typename S>
void RodMotion<S>::find_rubbing_slopes(const RodLayout::Rubbing& rub, const Dual<double>& tension,
                                       const Dual<double>& stiffness, double* slopes) {
  if constexpr (std::is_same_v<S, double>) {
    std::ranges::fill(spare_, Screw<double>{});
    bool has_chords = false;
    using Tension = Dual<double>;
    Tension left = tension;
    for (std::size_t p = 0; p < rub.pieces.size(); ++p) {
      const RodLayout::Piece& piece = rub.pieces[p];
      const RodLayout::Section& section = layout_.sections[piece.section];
      const std::size_t at = rub.first + p;
      // Stiffer bristles hold like those of a longer slide.
      if (p > 0)
        left -= held_by(left, turn_[at] + Tension{}, slide_time_ * slide_[at] * stiffness, grip_[at],
                        held_before_ != nullptr ? held_before_[at] : 0.0);
      if (section.disks.empty()) {
        add_strain_force(section, piece.at, piece.run * left.slope * units_[at], slopes);
        continue;
      }
      has_chords = true;
      spare_[section.first_node + section.disks[piece.at]] -= left.slope * units_[at];
      spare_[section.first_node + section.disks[piece.at + 1]] += left.slope * units_[at];
    }
    if (has_chords) collect(spare_, slopes);
  }
}

template <typename S>
void RodMotion<S>::find_pull_slopes(std::size_t tendon, double tension, double* slopes) {
  const auto found = std::ranges::find(layout_.rubbing, tendon, &RodLayout::Rubbing::tendon);
  if constexpr (std::is_same_v<S, double>) {
    if (found == layout_.rubbing.end()) {
      find_length_slopes(tendon, slopes);
      return;
    }
  }
  std::fill(slopes, slopes + layout_.modes, 0.0);
  find_rubbing_slopes(*found, {tension, 1}, {1, 0}, slopes);
}

template <typename S>
void RodMotion<S>::find_grip_slopes(std::size_t tendon, double tension, double* slopes) {
  std::fill(slopes, slopes + layout_.modes, 0.0);
  const auto found = std::ranges::find(layout_.rubbing, tendon, &RodLayout::Rubbing::tendon);
  if (found != layout_.rubbing.end() && tension > 0)
    find_rubbing_slopes(*found, {tension, 0}, {1, 1}, slopes);
}

template void RodMotion<double>::find_slides();
template void RodMotion<double>::add_rubbing(const double*);
template void RodMotion<double>::find_pull_slopes(std::size_t, double, double*);
template void RodMotion<double>::find_grip_slopes(std::size_t, double, double*);
template void RodMotion<Dual<Lanes>>::find_slides();
template void RodMotion<Dual<Lanes>>::add_rubbing(const Dual<Lanes>*);

}  // namespace flexura
