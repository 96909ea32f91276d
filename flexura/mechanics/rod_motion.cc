#include "flexura/mechanics/rod_motion.h"

#include <algorithm>

#include "flexura/mechanics/rod_numbers.h"

namespace flexura {
namespace {

// Reads six numbers with distance `stride`.
template <typename N, typename S>
Screw<N> load_screw(const S* from, std::size_t stride) {
  return {{load_lanes(from), load_lanes(from + stride), load_lanes(from + 2 * stride)},
          {load_lanes(from + 3 * stride), load_lanes(from + 4 * stride), load_lanes(from + 5 * stride)}};
}
template <typename N, typename S>
void store_triple(const Triple<N>& a, S* to, std::size_t stride) {
  store_lanes(a.x, to);
  store_lanes(a.y, to + stride);
  store_lanes(a.z, to + 2 * stride);
}
template <typename N, typename S>
void store_screw(const Screw<N>& a, S* to, std::size_t stride) {
  store_triple(a.linear, to, stride);
  store_triple(a.angular, to + 3 * stride, stride);
}
template <typename S>
Triple<S> read_triple(const S* from, std::size_t stride) {
  return {from[0], from[stride], from[2 * stride]};
}
template <typename S>
void write_screw(const Screw<S>& a, S* to, std::size_t stride) {
  to[0] = a.linear.x, to[stride] = a.linear.y, to[2 * stride] = a.linear.z;
  to[3 * stride] = a.angular.x, to[4 * stride] = a.angular.y, to[5 * stride] = a.angular.z;
}

}  // namespace

template <typename S>
RodMotion<S>::RodMotion(const RodLayout& layout) : layout_(layout) {
  const std::size_t padded = layout.padded;
  moments_.resize(18 * padded);
  rates_.resize(18 * padded);
  intervals_.resize(padded / lanes_of<Number>);
  steps_.resize(12 * padded);
  speeds_.resize(6 * padded);
  seeds_.resize(6 * padded);
  changes_.resize(6 * padded);
  collected_.resize(18 * padded);
  changed_.resize(18 * padded);
  X_.resize(layout.nodes);
  for (auto* screws : {&V_, &P_, &W_, &along_, &smooth_along_, &spare_}) screws->resize(layout.nodes);
  motions_.resize(layout.nodes);
  q_.resize(layout.modes);
  v_.resize(layout.modes);
  pulls_.resize(layout.nodes);
  is_anew_.assign(layout.sections.size(), 1);
  has_slopes_ = is_anew_;
  if (layout.rubbing.empty()) return;
  units_.resize(layout.pieces);
  for (auto* list : {&growth_, &slide_, &turned_, &turn_, &friction_, &left_}) list->resize(layout.pieces);
  spins_.resize(layout.pieces);
  smooth_.resize(layout.tendons);
}

template <typename S>
void RodMotion<S>::place(const S* q, const S* v) {
  std::copy(q, q + layout_.modes, q_.begin());
  std::copy(v, v + layout_.modes, v_.begin());
  const std::size_t padded = layout_.padded;
  choose_sections();
  if (are_all_anew_) {
    for (std::size_t i = 0; i < moments_.size(); ++i) moments_[i] = layout_.rest[i] + S{};
    std::fill(rates_.begin(), rates_.end(), S{});
  }
  if (layout_.is_driven) add_stretch_rates();
  for (std::size_t s = 0; s < layout_.sections.size(); ++s) {
    if (is_anew_[s] == 0) continue;
    const RodLayout::Section& section = layout_.sections[s];
    for (std::size_t row = 0; row < 18 && !are_all_anew_; ++row) {
      const std::size_t at = row * padded + section.first_interval;
      for (std::size_t i = 0; i < section.intervals; ++i) {
        moments_[at + i] = layout_.rest[at + i] + S{};
        rates_[at + i] = S{};
      }
    }
    for (std::size_t m = 0; m < 3; ++m) {
      const double* of_mode = layout_.moments[m].data() + section.first_moment;
      for (std::size_t j = 0; j < section.modes; ++j, of_mode += section.intervals) {
        const std::size_t at = (6 * m + section.strain[j]) * padded + section.first_interval;
        const S q_j = q[section.first_mode + j], v_j = v[section.first_mode + j];
        for (std::size_t i = 0; i < section.intervals; ++i) {
          moments_[at + i] += of_mode[i] * q_j;
          rates_[at + i] += of_mode[i] * v_j;
        }
      }
    }
  }
  const auto find_interval = [&](std::size_t i) {
    const std::size_t at = i * lanes_of<Number>;
    const auto moment = [&](std::size_t m) {
      return dual_of(load_screw<Number>(&moments_[6 * m * padded + at], padded),
                     load_screw<Number>(&rates_[6 * m * padded + at], padded));
    };
    intervals_[i] = RodInterval<Dual<Number>>(moment(0), moment(1), moment(2));
    const RodInterval<Number> now = still(intervals_[i]);
    const Placement<Number> step = now.placement();
    store_triple(step.x, &steps_[at], padded);
    store_triple(step.y, &steps_[3 * padded + at], padded);
    store_triple(step.z, &steps_[6 * padded + at], padded);
    store_triple(step.position, &steps_[9 * padded + at], padded);
    store_screw(now.moved(slope_of(intervals_[i].twist())), &speeds_[at], padded);
  };
  const auto find_nodes = [&](std::size_t s, Placement<S> X, Screw<S> V) {
    const RodLayout::Section& section = layout_.sections[s];
    std::size_t node = section.first_node;
    X_[node] = X;
    V_[node] = V;
    for (std::size_t i = 0; i < section.intervals; ++i) {
      const std::size_t at = section.first_interval + i;
      const Screw<S> speed = {read_triple(&speeds_[at], padded),
                              read_triple(&speeds_[3 * padded + at], padded)};
      V += X.carry(speed);
      const Placement<S> step = {
          read_triple(&steps_[at], padded), read_triple(&steps_[3 * padded + at], padded),
          read_triple(&steps_[6 * padded + at], padded), read_triple(&steps_[9 * padded + at], padded)};
      X = X * step;
      ++node;
      X_[node] = X;
      V_[node] = V;
    }
    for (std::size_t k = section.first_node; k <= node; ++k) P_[k] = momentum_of(k, V_[k]);
  };
  if (are_all_anew_)
    for (std::size_t i = 0; i < intervals_.size(); ++i) find_interval(i);
  const S zero{}, one = 1.0 + zero;
  const Placement<S> base = {
      .x = {one, zero, zero}, .y = {zero, one, zero}, .z = {zero, zero, one}, .position = {}};
  bool is_moved = false;
  for (std::size_t s = 0; s < layout_.sections.size(); ++s) {
    const RodLayout::Section& section = layout_.sections[s];
    if (!are_all_anew_ && is_anew_[s] != 0)
      for (std::size_t i = 0; i < section.intervals; ++i) find_interval(section.first_interval + i);
    is_moved = is_moved || is_anew_[s] != 0;
    if (!is_moved) continue;
    if (s > 0) {
      const std::size_t before = layout_.sections[s - 1].first_node + layout_.sections[s - 1].intervals;
      find_nodes(s, X_[before], V_[before]);
    } else {
      find_nodes(s, base, Screw<S>{});
    }
  }
}

// Chooses the sections whose intervals change: those with slopes now or before.
template <typename S>
void RodMotion<S>::choose_sections() {
  // Intervals of different sections are computed together where an instruction takes several.
  const bool keeps = keeps_values_ && lanes_of<Number> == 1 && !layout_.is_driven;
  are_all_anew_ = true;
  for (std::size_t s = 0; s < is_anew_.size(); ++s) {
    const bool is_varied = s >= first_varied_ && s <= last_varied_;
    is_anew_[s] = !keeps || is_varied || has_slopes_[s] != 0 ? 1 : 0;
    has_slopes_[s] = is_varied ? 1 : 0;
    are_all_anew_ = are_all_anew_ && is_anew_[s] != 0;
  }
}

// For driven sections: the first moment is an integral over arc length.
template <typename S>
void RodMotion<S>::add_stretch_rates() {
  constexpr std::size_t stretch = 2;
  for (std::size_t s = 0; s < layout_.sections.size(); ++s) {
    const RodLayout::Section& section = layout_.sections[s];
    const double part = layout_.stretches[s] / section.grid.rest.front()[stretch];
    const std::size_t at = stretch * layout_.padded + section.first_interval;
    for (std::size_t i = 0; i < section.intervals; ++i) rates_[at + i] += part * layout_.rest[at + i] + S{};
  }
}

template <typename S>
Screw<S> RodMotion<S>::momentum_of(std::size_t node, const Screw<S>& twist) const {
  const RodLayout::Body& body = layout_.bodies[node];
  const Placement<S>& at = X_[node];
  const Triple<S> centre = at.position + at.turn(constant<S>(body.centre));
  const Triple<S> push = body.mass * (twist.linear + cross(twist.angular, centre));
  const Triple<S> w = at.turn_back(twist.angular);
  const auto row = [&](const Triple<double>& r) { return r.x * w.x + r.y * w.y + r.z * w.z; };
  const Triple<S> spin = {row(body.inertia[0]), row(body.inertia[1]), row(body.inertia[2])};
  return {push, at.turn(spin) + cross(centre, push)};
}

template <typename S>
void RodMotion<S>::pull(const RodLoads& loads, const S* tensions, const RodSurroundings* surroundings) {
  if (!keeps_surroundings_) {
    chosen_.clear();
    is_coupled_ = false;
  }
  const Triple<double> gravity{loads.gravity.x(), loads.gravity.y(), loads.gravity.z()};
  const Triple<S> per_length = constant<S>(loads.per_length);
  const bool is_spread = !loads.per_length.isZero(0);
  for (std::size_t k = 0; k < layout_.nodes; ++k) {
    const RodLayout::Body& body = layout_.bodies[k];
    const Triple<S> weight = constant<S>(body.mass * gravity);
    W_[k] = wrench_at(X_[k].position + X_[k].turn(constant<S>(body.centre)), weight);
    if (is_spread) W_[k] += wrench_at(X_[k].position, layout_.run[k] * per_length);
  }
  for (const EndLoad& end : loads.ends) {
    const RodLayout::Section& section = layout_.sections[layout_.ends[end.section]];
    const std::size_t node = section.first_node + section.intervals;
    const Placement<S>& X = X_[node];
    Triple<S> force = constant<S>(end.force), moment = constant<S>(end.moment);
    if (end.following) {
      force = X.turn(force);
      moment = X.turn(moment);
    }
    W_[node] += {force, cross(X.position, force) + moment};
  }
  if (!layout_.rubbing.empty()) find_slides();
  add_tendons(tensions);
  if (surroundings != nullptr) add_surroundings(*surroundings);
}

template <typename S>
void RodMotion<S>::add_modes(const std::vector<S>& of_moments, S* sums) const {
  for (const RodLayout::Section& section : layout_.sections) {
    for (std::size_t m = 0; m < 3; ++m) {
      const double* of_mode = layout_.moments[m].data() + section.first_moment;
      for (std::size_t j = 0; j < section.modes; ++j, of_mode += section.intervals) {
        const S* from = &of_moments[(6 * m + section.strain[j]) * layout_.padded + section.first_interval];
        S sum{};
        for (std::size_t i = 0; i < section.intervals; ++i) sum += of_mode[i] * from[i];
        sums[section.first_mode + j] += sum;
      }
    }
  }
}

template <typename S>
void RodMotion<S>::balance(S* momentum, S* force) {
  const std::size_t padded = layout_.padded;
  Screw<S> P{}, W{};  // Sums over all distal nodes.
  for (std::size_t s = layout_.sections.size(); s-- > 0;) {
    const RodLayout::Section& section = layout_.sections[s];
    for (std::size_t i = section.intervals; i-- > 0;) {
      const std::size_t node = section.first_node + i, at = section.first_interval + i;
      P += P_[node + 1];
      W += W_[node + 1];
      // The columns of an interval move with its beginning.
      write_screw(X_[node].fetch(P), &seeds_[at], padded);
      write_screw(X_[node].fetch(W + transposed_bracket(V_[node], P)), &changes_[at], padded);
    }
    P += P_[section.first_node];
    W += W_[section.first_node];
  }
  for (std::size_t i = 0; i < intervals_.size(); ++i) {
    const std::size_t at = i * lanes_of<Number>;
    const auto along = intervals_[i].along_moments(
        dual_of(load_screw<Number>(&seeds_[at], padded), load_screw<Number>(&changes_[at], padded)));
    for (std::size_t m = 0; m < 3; ++m) {
      store_screw(value_of(along[m]), &collected_[6 * m * padded + at], padded);
      store_screw(slope_of(along[m]), &changed_[6 * m * padded + at], padded);
    }
  }
  std::fill(momentum, momentum + layout_.modes, S{});
  set_inner_forces(force);
  add_modes(collected_, momentum);
  add_modes(changed_, force);
  add_point_forces(force);
}

template <typename S>
void RodMotion<S>::set_inner_forces(S* force) const {
  for (const RodLayout::Section& section : layout_.sections) {
    S* part = force + section.first_mode;
    const S *q = q_.data() + section.first_mode, *v = v_.data() + section.first_mode;
    const RodGrid& grid = section.grid;
    for (std::size_t j = 0; j < section.modes; ++j) {
      const auto first = static_cast<std::size_t>(grid.first[section.strain[j]]),
                 count = static_cast<std::size_t>(grid.count[section.strain[j]]);
      const double *K = section.stiffness.data() + j * section.modes,
                   *D = section.damping.data() + j * section.modes;
      S sum{};
      for (std::size_t l = first; l < first + count; ++l) sum += K[l] * q[l] + D[l] * v[l];
      part[j] = S{} - sum;
    }
    if (!is_pulled_ || !section.disks.empty()) continue;
    for (std::size_t k = 0; k <= section.intervals; ++k) {
      const std::size_t node = section.first_node + k;
      if (layout_.run[node] != 0) add_strain_force(section, k, -layout_.run[node] * along_[node], force);
    }
  }
}

template <typename S>
void RodMotion<S>::find_acceleration_forces(S* force) {
  const std::size_t padded = layout_.padded;
  for (std::size_t i = 0; i < intervals_.size(); ++i)
    store_screw(drift_of(intervals_[i]), &changes_[i * lanes_of<Number>], padded);
  Screw<S> drift{};
  for (const RodLayout::Section& section : layout_.sections) {
    for (std::size_t i = 0; i <= section.intervals; ++i) {
      const std::size_t node = section.first_node + i, at = section.first_interval + i;
      spare_[node] = W_[node] + transposed_bracket(V_[node], P_[node]) - momentum_of(node, drift);
      if (i == section.intervals) continue;
      const auto read = [&](const std::vector<S>& from) {
        return Screw<S>{read_triple(&from[at], padded), read_triple(&from[3 * padded + at], padded)};
      };
      drift += bracket(V_[node], X_[node].carry(read(speeds_))) + X_[node].carry(read(changes_));
    }
  }
  set_inner_forces(force);
  collect(spare_, force);
  add_point_forces(force);
}

template <typename S>
void RodMotion<S>::collect(const std::vector<Screw<S>>& wrenches, S* force) {
  const std::size_t padded = layout_.padded;
  Screw<S> W{};
  for (std::size_t s = layout_.sections.size(); s-- > 0;) {
    const RodLayout::Section& section = layout_.sections[s];
    for (std::size_t i = section.intervals; i-- > 0;) {
      W += wrenches[section.first_node + i + 1];
      write_screw(X_[section.first_node + i].fetch(W), &seeds_[section.first_interval + i], padded);
    }
    W += wrenches[section.first_node];
  }
  for (std::size_t i = 0; i < intervals_.size(); ++i) {
    const std::size_t at = i * lanes_of<Number>;
    const auto along = still(intervals_[i]).along_moments(load_screw<Number>(&seeds_[at], padded));
    for (std::size_t m = 0; m < 3; ++m) store_screw(along[m], &collected_[6 * m * padded + at], padded);
  }
  add_modes(collected_, force);
}

template class RodMotion<double>;
template class RodMotion<Dual<Lanes>>;

}  // namespace flexura
