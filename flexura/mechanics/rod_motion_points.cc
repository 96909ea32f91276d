#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "flexura/mechanics/rod_motion.h"
#include "flexura/mechanics/rod_numbers.h"

namespace flexura {
namespace {

// Slightly more than the accumulated rounding.
constexpr double a_little_more = 1 + 1e-9;

// Change of a wrench by a point's motion.
Screw<double> wrench_change_of(const Matrix6d&, const Matrix6d&, const Placement<double>&,
                               const Screw<double>&) {
  return {};
}
Screw<Dual<Lanes>> wrench_change_of(const Matrix6d& by_pose, const Matrix6d& by_twist,
                                    const Placement<Dual<Lanes>>& X, const Screw<Dual<Lanes>>& V) {
  Screw<Dual<Lanes>> result{};
  for (std::size_t lane = 0; lane < lanes_of<Lanes>; ++lane) {
    const auto slope = [&](const Triple<Dual<Lanes>>& a) {
      return Eigen::Vector3d(a.x.slope[lane], a.y.slope[lane], a.z.slope[lane]);
    };
    Eigen::Matrix3d R, turned;
    R << plain(X.x).transpose(), plain(X.y).transpose(), plain(X.z).transpose();
    turned << slope(X.x).transpose(), slope(X.y).transpose(), slope(X.z).transpose();
    const Eigen::Matrix3d turning = turned * R.transpose();
    const Eigen::Vector3d angular(turning(2, 1), turning(0, 2), turning(1, 0));
    Vector6d moved, faster;
    moved << slope(X.position) - angular.cross(plain(X.position)), angular;
    faster << slope(V.linear), slope(V.angular);
    const Vector6d change = by_pose * moved + by_twist * faster;
    for (std::size_t c = 0; c < 6; ++c)
      component(result, c).slope[lane] = change[static_cast<Eigen::Index>(c)];
  }
  return result;
}

template <typename S>
Screw<S> constant_wrench(const Vector6d& a) {
  return {constant<S>(Eigen::Vector3d(a.head<3>())), constant<S>(Eigen::Vector3d(a.tail<3>()))};
}

template <typename S>
void set_motion(NodeMotion& motion, const Placement<S>& X, const Screw<S>& V) {
  motion.pose.rotation << plain(X.x).transpose(), plain(X.y).transpose(), plain(X.z).transpose();
  motion.pose.position = plain(X.position);
  motion.twist = plain(V);
}

double number_of(const Lanes& value, std::size_t lane) { return value[lane]; }
Dual<Lanes> number_of(const Dual<Lanes>& value, std::size_t) { return value; }

// Returns one of several numbers side by side.
template <typename N>
auto lane_of(const Triple<N>& a, std::size_t lane) {
  return Triple<decltype(number_of(a.x, lane))>{number_of(a.x, lane), number_of(a.y, lane),
                                                number_of(a.z, lane)};
}
template <typename N>
auto lane_of(const Screw<N>& a, std::size_t lane) {
  return Screw<decltype(number_of(a.linear.x, lane))>{lane_of(a.linear, lane), lane_of(a.angular, lane)};
}
template <typename N>
auto lane_of(const Placement<N>& a, std::size_t lane) {
  return Placement<decltype(number_of(a.x.x, lane))>{lane_of(a.x, lane), lane_of(a.y, lane),
                                                     lane_of(a.z, lane), lane_of(a.position, lane)};
}

void set_lane(Lanes& to, double value, std::size_t lane) { to[lane] = value; }
void set_lane(Dual<Lanes>& to, const Dual<Lanes>& value, std::size_t) { to = value; }
template <typename N, typename S>
void set_lane(Screw<N>& to, const Screw<S>& value, std::size_t lane) {
  for (std::size_t c = 0; c < 6; ++c) set_lane(component(to, c), component(value, c), lane);
}

}  // namespace

template <typename S>
void RodMotion<S>::set_points(const RodPoints* points) {
  points_ = points;
  chosen_.clear();
  const std::size_t count = points != nullptr ? points->points.size() : 0;
  constexpr std::size_t width = lanes_of<Number>;
  chosen_.reserve(count);
  parts_.resize((count + width - 1) / width);
  point_X_.resize(count);
  point_V_.resize(count);
  point_W_.resize(count);
  point_motions_.resize(count);
  point_pulls_.resize(count);
  lengths_.resize(layout_.intervals);
}

// Upper bounds of the rod's lengths in the intervals: each mode of a strain is at most its absolute value.
template <typename S>
void RodMotion<S>::bound_lengths() {
  constexpr std::size_t linear = 3, stretch = 2;
  for (const RodLayout::Section& section : layout_.sections) {
    double most = 0;
    for (std::size_t j = 0; j < section.modes; ++j)
      if (section.strain[j] < linear) most += std::abs(plain(q_[section.first_mode + j]));
    for (std::size_t i = 0; i < section.intervals; ++i) {
      const double at_rest = std::abs(layout_.rest[stretch * layout_.padded + section.first_interval + i]);
      lengths_[section.first_interval + i] =
          a_little_more * (at_rest + most * (section.grid.t[i + 1] - section.grid.t[i]) * section.length);
    }
  }
}

template <typename S>
void RodMotion<S>::place_points() {
  constexpr std::size_t width = lanes_of<Number>, stretch = 2;
  for (std::size_t first = 0; first < chosen_.size(); first += width) {
    std::array<Screw<Number>, 3> moment{}, rate{};
    for (std::size_t lane = 0; lane < width && first + lane < chosen_.size(); ++lane) {
      const RodPoints::Point& point = points_->points[chosen_[first + lane]];
      if (point.is_node) continue;
      const RodLayout::Section& section = layout_.sections[point.section];
      const double* of_mode = points_->moments.data() + point.first_moment;
      const double* at_rest = of_mode + 3 * section.modes;
      for (std::size_t m = 0; m < 3; ++m, of_mode += section.modes, at_rest += 6) {
        std::array<S, 6> sum{}, faster{};
        for (std::size_t c = 0; c < 6; ++c) sum[c] = at_rest[c] + S{};
        if (m == 0)
          sum[stretch] =
              point.part * layout_.rest[stretch * layout_.padded + section.first_interval + point.interval] +
              S{};
        for (std::size_t j = 0; j < section.modes; ++j) {
          sum[section.strain[j]] += of_mode[j] * q_[section.first_mode + j];
          faster[section.strain[j]] += of_mode[j] * v_[section.first_mode + j];
        }
        for (std::size_t c = 0; c < 6; ++c) {
          set_lane(component(moment[m], c), sum[c], lane);
          set_lane(component(rate[m], c), faster[c], lane);
        }
      }
    }
    RodInterval<Dual<Number>>& part = parts_[first / width];
    part = RodInterval<Dual<Number>>(dual_of(moment[0], rate[0]), dual_of(moment[1], rate[1]),
                                     dual_of(moment[2], rate[2]));
    const RodInterval<Number> now = still(part);
    const Placement<Number> step = now.placement();
    const Screw<Number> speed = now.moved(slope_of(part.twist()));
    for (std::size_t lane = 0; lane < width && first + lane < chosen_.size(); ++lane) {
      const std::size_t i = first + lane;
      const RodPoints::Point& point = points_->points[chosen_[i]];
      const Placement<S>& X = X_[point.node];
      point_X_[i] = X;
      point_V_[i] = V_[point.node];
      if (!point.is_node) {
        point_V_[i] += X.carry(lane_of(speed, lane));
        point_X_[i] = X * lane_of(step, lane);
      }
      set_motion(point_motions_[i], point_X_[i], point_V_[i]);
    }
  }
}

template <typename S>
void RodMotion<S>::ask_surroundings(const RodSurroundings& surroundings) {
  for (std::size_t k = 0; k < layout_.nodes; ++k) set_motion(motions_[k], X_[k], V_[k]);
  surroundings.pull(motions_, layout_.run, pulls_);
  touching_ = &surroundings;
  couplings_.clear();
  if (points_ == nullptr) return;
  bound_lengths();
  surroundings.choose(motions_, lengths_, chosen_);
  if (chosen_.empty()) return;
  place_points();
  const std::span<NodePull> pulls(point_pulls_.data(), chosen_.size());
  surroundings.pull_points(chosen_, point_motions(), pulls);
  is_coupled_ = std::ranges::any_of(pulls, &NodePull::is_coupled);
  if (!std::is_same_v<S, double> && is_coupled_) surroundings.couple(chosen_, point_motions(), couplings_);
}

template <typename S>
void RodMotion<S>::add_surroundings(const RodSurroundings& surroundings) {
  constexpr bool has_slopes = !std::is_same_v<S, double>;
  if (!keeps_surroundings_)
    ask_surroundings(surroundings);
  else if (!chosen_.empty())
    place_points();
  for (std::size_t k = 0; k < layout_.nodes; ++k) {
    const NodePull& pull = pulls_[k];
    if (pull.is_idle) continue;
    W_[k] += constant_wrench<S>(pull.wrench);
    if constexpr (has_slopes) W_[k] += wrench_change_of(pull.by_pose, pull.by_twist, X_[k], V_[k]);
  }
  for (std::size_t i = 0; i < chosen_.size(); ++i) {
    const NodePull& pull = point_pulls_[i];
    if (pull.is_idle) continue;
    point_W_[i] = constant_wrench<S>(pull.wrench);
    if constexpr (has_slopes)
      point_W_[i] += wrench_change_of(pull.by_pose, pull.by_twist, point_X_[i], point_V_[i]);
  }
  for (const PointCoupling& each : couplings_)
    point_W_[each.at] += wrench_change_of(each.by_pose, each.by_twist, point_X_[each.of], point_V_[each.of]);
  // Proximal of the interval the wrench acts as if at the interval's beginning.
  for (std::size_t i = 0; i < chosen_.size(); ++i)
    if (!point_pulls_[i].is_idle) W_[points_->points[chosen_[i]].node] += point_W_[i];
}

// Projects wrenches at points on the strains of the interval before them.
template <typename S>
void RodMotion<S>::add_point_forces(S* force) const {
  constexpr std::size_t width = lanes_of<Number>;
  for (std::size_t first = 0; first < chosen_.size(); first += width) {
    Screw<Number> seed{};
    bool is_pulled = false;
    const std::size_t count = std::min(width, chosen_.size() - first);
    const auto pulls = [&](std::size_t lane) {
      return !point_pulls_[first + lane].is_idle && !points_->points[chosen_[first + lane]].is_node;
    };
    for (std::size_t lane = 0; lane < count; ++lane) {
      if (!pulls(lane)) continue;
      is_pulled = true;
      set_lane(seed, X_[points_->points[chosen_[first + lane]].node].fetch(point_W_[first + lane]), lane);
    }
    if (!is_pulled) continue;
    const auto along = still(parts_[first / width]).along_moments(seed);
    for (std::size_t lane = 0; lane < count; ++lane) {
      if (!pulls(lane)) continue;
      const RodPoints::Point& point = points_->points[chosen_[first + lane]];
      const RodLayout::Section& section = layout_.sections[point.section];
      const double* of_mode = points_->moments.data() + point.first_moment;
      for (std::size_t m = 0; m < 3; ++m, of_mode += section.modes) {
        const Screw<S> one = lane_of(along[m], lane);
        for (std::size_t j = 0; j < section.modes; ++j)
          force[section.first_mode + j] += of_mode[j] * component(one, section.strain[j]);
      }
    }
  }
}

template <typename S>
std::vector<NodeMotion> RodMotion<S>::all_point_motions() {
  chosen_.clear();
  is_coupled_ = false;
  if (points_ == nullptr) return {};
  for (std::size_t i = 0; i < points_->points.size(); ++i) chosen_.push_back(i);
  place_points();
  std::vector<NodeMotion> motions = point_motions_;
  chosen_.clear();
  return motions;
}

template void RodMotion<double>::set_points(const RodPoints*);
template void RodMotion<Dual<Lanes>>::set_points(const RodPoints*);
template void RodMotion<double>::add_surroundings(const RodSurroundings&);
template void RodMotion<Dual<Lanes>>::add_surroundings(const RodSurroundings&);
template void RodMotion<double>::add_point_forces(double*) const;
template void RodMotion<Dual<Lanes>>::add_point_forces(Dual<Lanes>*) const;
template std::vector<NodeMotion> RodMotion<double>::all_point_motions();

}  // namespace flexura
