#include <algorithm>

#include "flexura/math/so3.h"
#include "flexura/mechanics/rod_motion.h"
#include "flexura/mechanics/rod_numbers.h"

namespace flexura {

template <typename S>
Screw<S> RodMotion<S>::strain_at(const RodLayout::Section& section, std::size_t node) const {
  const Vector6d& rest = section.grid.rest[node];
  Screw<S> strain{};
  for (std::size_t c = 0; c < 6; ++c) component(strain, c) = rest[static_cast<Eigen::Index>(c)] + S{};
  const auto modes = section.grid.at_node.col(static_cast<Eigen::Index>(node));
  for (std::size_t j = 0; j < section.modes; ++j)
    component(strain, section.strain[j]) += modes[static_cast<Eigen::Index>(j)] * q_[section.first_mode + j];
  return strain;
}

template <typename S>
typename RodMotion<S>::Pull RodMotion<S>::pull_of(const RodLayout::Passage& passage, const Screw<S>& strain) {
  const Triple<S> offset = constant<S>(passage.offset);
  const Triple<S> way = strain.linear + cross(strain.angular, offset) + constant<S>(passage.slope);
  const S length = square_root(dot(way, way));
  const Triple<S> u = ((1.0 + S{}) / length) * way;
  return {.along = {u, cross(offset, u)}, .length = length};
}

// Calls add(from, to, along, length) for the straight pieces of a tendon, from node to node; `along` is the
// wrench of a unit tension.
template <typename S>
template <typename Add>
void RodMotion<S>::for_chords(const RodLayout::Section& section, std::size_t tendon, Add&& add) const {
  const RodLayout::Passage* passages = section.passages.data() + tendon * (section.intervals + 1);
  for (std::size_t piece = 0; piece + 1 < section.disks.size(); ++piece) {
    const std::size_t from = section.disks[piece], to = section.disks[piece + 1];
    const Placement<S>&A = X_[section.first_node + from], &B = X_[section.first_node + to];
    const Triple<S> a = A.position + A.turn(constant<S>(passages[from].offset));
    const Triple<S> b = B.position + B.turn(constant<S>(passages[to].offset));
    const S length = square_root(dot(b - a, b - a));
    add(section.first_node + from, section.first_node + to, wrench_at(a, ((1.0 + S{}) / length) * (b - a)),
        length);
  }
}

template <typename S>
void RodMotion<S>::add_tendons(const S* tensions) {
  is_pulled_ = false;
  for (std::size_t i = 0; i < layout_.tendons; ++i) is_pulled_ = is_pulled_ || plain(tensions[i]) != 0;
  std::fill(friction_.begin(), friction_.end(), S{});
  if (!is_pulled_) return;
  const S* const all = tensions;
  if (!layout_.rubbing.empty()) {
    std::copy(tensions, tensions + layout_.tendons, smooth_.begin());
    for (const RodLayout::Rubbing& each : layout_.rubbing) smooth_[each.tendon] = S{};
    tensions = smooth_.data();
  }
  for (std::size_t s = 0; s < layout_.sections.size(); ++s) {
    const RodLayout::Section& section = layout_.sections[s];
    for (std::size_t k = 0; k <= section.intervals && section.disks.empty() && is_anew_[s] != 0; ++k) {
      Screw<S>& along = smooth_along_[section.first_node + k];
      along = Screw<S>{};
      if (layout_.run[section.first_node + k] == 0) continue;
      const Screw<S> strain = strain_at(section, k);
      for (std::size_t i = 0; i < section.tendons.size(); ++i) {
        const S& tension = tensions[section.tendons[i]];
        if (plain(tension) == 0) continue;
        along += tension * pull_of(section.passages[i * (section.intervals + 1) + k], strain).along;
      }
    }
    for (std::size_t k = 0; k <= section.intervals && section.disks.empty(); ++k)
      along_[section.first_node + k] = smooth_along_[section.first_node + k];
    for (std::size_t i = 0; i < section.tendons.size(); ++i) {
      const S& tension = tensions[section.tendons[i]];
      for_chords(section, i, [&](std::size_t from, std::size_t to, const Screw<S>& unit, const S&) {
        W_[from] += tension * unit;
        W_[to] -= tension * unit;
      });
    }
  }
  if (!layout_.rubbing.empty()) add_rubbing(all);
}

template <typename S>
void RodMotion<S>::add_strain_force(const RodLayout::Section& section, std::size_t node,
                                    const Screw<S>& along, S* force) const {
  const auto modes = section.grid.at_node.col(static_cast<Eigen::Index>(node));
  for (std::size_t j = 0; j < section.modes; ++j)
    force[section.first_mode + j] +=
        modes[static_cast<Eigen::Index>(j)] * component(along, section.strain[j]);
}

template <typename S>
void RodMotion<S>::find_lengths(S* lengths) const {
  std::fill(lengths, lengths + layout_.tendons, S{});
  for (const RodLayout::Section& section : layout_.sections) {
    for (std::size_t k = 0; k <= section.intervals && section.disks.empty(); ++k) {
      const double run = layout_.run[section.first_node + k];
      if (run == 0 || section.tendons.empty()) continue;
      const Screw<S> strain = strain_at(section, k);
      for (std::size_t i = 0; i < section.tendons.size(); ++i)
        lengths[section.tendons[i]] +=
            run * pull_of(section.passages[i * (section.intervals + 1) + k], strain).length;
    }
    for (std::size_t i = 0; i < section.tendons.size(); ++i)
      for_chords(section, i, [&](std::size_t, std::size_t, const Screw<S>&, const S& length) {
        lengths[section.tendons[i]] += length;
      });
  }
}

template <typename S>
void RodMotion<S>::find_length_slopes(std::size_t tendon, S* slopes) {
  std::fill(slopes, slopes + layout_.modes, S{});
  bool has_chords = false;
  for (const RodLayout::Section& section : layout_.sections) {
    const auto found = std::ranges::find(section.tendons, tendon);
    if (found == section.tendons.end()) break;
    const auto i = static_cast<std::size_t>(found - section.tendons.begin());
    for (std::size_t k = 0; k <= section.intervals && section.disks.empty(); ++k) {
      const double run = layout_.run[section.first_node + k];
      if (run == 0) continue;
      const Pull pull = pull_of(section.passages[i * (section.intervals + 1) + k], strain_at(section, k));
      add_strain_force(section, k, run * pull.along, slopes);
    }
    if (section.disks.empty()) continue;
    if (!has_chords) std::fill(spare_.begin(), spare_.end(), Screw<S>{});
    has_chords = true;
    for_chords(section, i, [&](std::size_t from, std::size_t to, const Screw<S>& unit, const S&) {
      spare_[from] -= unit;
      spare_[to] += unit;
    });
  }
  if (has_chords) collect(spare_, slopes);
}

template <typename S>
Matrix6d RodMotion<S>::tendon_stiffness(const RodLayout::Section& section, std::size_t node,
                                        const double* tensions) const {
  Matrix6d sum = Matrix6d::Zero();
  const Screw<S> strain = strain_at(section, node);
  for (std::size_t i = 0; i < section.tendons.size(); ++i) {
    const double tension = tensions[section.tendons[i]];
    if (tension == 0) continue;
    const RodLayout::Passage& passage = section.passages[i * (section.intervals + 1) + node];
    const Pull pull = pull_of(passage, strain);
    const Eigen::Vector3d u = plain(pull.along.linear);
    const Eigen::Matrix3d across =
        tension / plain(pull.length) * (Eigen::Matrix3d::Identity() - u * u.transpose());
    const Eigen::Matrix3d offset = skew(plain(constant<S>(passage.offset))), mixed = across * offset;
    sum.topLeftCorner<3, 3>() += across;
    sum.topRightCorner<3, 3>() -= mixed;
    sum.bottomLeftCorner<3, 3>() -= mixed.transpose();
    sum.bottomRightCorner<3, 3>() -= offset * mixed;
  }
  return sum;
}

template Screw<double> RodMotion<double>::strain_at(const RodLayout::Section&, std::size_t) const;
template void RodMotion<double>::add_strain_force(const RodLayout::Section&, std::size_t,
                                                  const Screw<double>&, double*) const;
template RodMotion<double>::Pull RodMotion<double>::pull_of(const RodLayout::Passage&, const Screw<double>&);
template void RodMotion<double>::add_tendons(const double*);
template void RodMotion<double>::find_lengths(double*) const;
template void RodMotion<double>::find_length_slopes(std::size_t, double*);
template Matrix6d RodMotion<double>::tendon_stiffness(const RodLayout::Section&, std::size_t,
                                                      const double*) const;

template Screw<Dual<Lanes>> RodMotion<Dual<Lanes>>::strain_at(const RodLayout::Section&, std::size_t) const;
template void RodMotion<Dual<Lanes>>::add_strain_force(const RodLayout::Section&, std::size_t,
                                                       const Screw<Dual<Lanes>>&, Dual<Lanes>*) const;
template RodMotion<Dual<Lanes>>::Pull RodMotion<Dual<Lanes>>::pull_of(const RodLayout::Passage&,
                                                                      const Screw<Dual<Lanes>>&);
template void RodMotion<Dual<Lanes>>::add_tendons(const Dual<Lanes>*);
template void RodMotion<Dual<Lanes>>::find_lengths(Dual<Lanes>*) const;
template void RodMotion<Dual<Lanes>>::find_length_slopes(std::size_t, Dual<Lanes>*);
template Matrix6d RodMotion<Dual<Lanes>>::tendon_stiffness(const RodLayout::Section&, std::size_t,
                                                           const double*) const;

}  // namespace flexura
