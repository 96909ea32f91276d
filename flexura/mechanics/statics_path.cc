// Load path from zero to full load.
#include <algorithm>
#include <cmath>
#include <vector>

#include "flexura/mechanics/statics.h"

namespace flexura {
namespace {

constexpr double first_stride = 0.2, longest_stride = 1, shortest_stride = 1e-7;
constexpr double shortest_at_branch = 1e-3;
constexpr int max_strides = 2000, max_correction = 8;
constexpr int max_iterations = 1500;  // Linear systems of one search.
constexpr double longest_path = 400;  // Sections turn around many times.
constexpr double least_share = -0.5;  // Share of the load at which a reversed path ends.

}  // namespace

// Pseudo-arclength continuation (H. Keller, 1977): load and shape change together along the path, which turns
// where the load has an extremum.
bool RodStatics::follow(Equilibrium& result, Unknowns& at, Unknowns& last_stable) {
  const double a_section = 1.0 / static_cast<double>(chain_.elements().size());
  const auto dot = [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    return a_section * a.cwiseProduct(chain_.scales()).dot(b.cwiseProduct(chain_.scales()));
  };
  double share = 0, stride = first_stride, way = 0;
  Unknowns direction{Eigen::VectorXd::Zero(at.q.size()), Eigen::VectorXd::Zero(at.tensions.size())};
  double rise = 1;  // Component of the direction along the load share.
  int negative = 0;
  bool is_stable = true;  // So far.
  result.end = StaticsEnd::out_of_steps;
  for (int step = 0; step < max_strides; ++step) {
    if (iterations_ > max_iterations || !linearize(at, share) || chain_.disks_meet()) return false;
    const double norm = std::sqrt(1 + dot(tangent_.q, tangent_.q));
    const double sense = dot(tangent_.q, direction.q) + rise < 0 ? -1 : 1;
    direction.q = sense / norm * tangent_.q;
    direction.tensions = sense / norm * tangent_.tensions;
    const double risen = sense / norm;
    const bool turned = risen * rise < 0;
    rise = risen;
    if (turned) result.snapped = result.ambiguous = true;
    if (negative_ != negative && !turned && step > 0) result.ambiguous = true;
    negative = negative_;
    is_stable = is_stable && negative == 0 && !turned;
    if (is_stable) last_stable = at;

    const std::vector<char> taut = taut_;
    double afterwards = 0;  // The stride before it was reduced at a branch point.
    for (;; stride *= 0.5) {
      if (stride < shortest_stride) return false;
      taut_ = taut;
      Unknowns next{at.q + stride * direction.q, at.tensions + stride * direction.tensions};
      double next_share = share + stride * rise, before = 0;
      bool settled = false;
      int correction = 0;
      for (; correction < max_correction && !settled; ++correction) {
        if (!linearize(next, next_share)) break;
        const double change = -dot(direction.q, newton_.q) / (dot(direction.q, tangent_.q) + rise);
        newton_.q += change * tangent_.q;
        newton_.tensions += change * tangent_.tensions;
        const double size = std::max(measure(newton_), std::abs(change));
        if (!(size <= (correction == 0 ? 0.5 * stride : contraction * before)) && size > settled_step) break;
        next.q += newton_.q;
        next.tensions += newton_.tensions;
        next_share += change;
        before = size;
        settled = size < 1e-6;
      }
      if (!settled) continue;
      // A change of stability without a turn: a branch leaves the path here, or was jumped over. Only the
      // former remains at small strides.
      const bool turns = dot(tangent_.q, direction.q) + rise < 0;
      if (negative_ != negative && !turns) {
        afterwards = std::max(afterwards, stride);
        if (stride > shortest_at_branch) continue;
      }
      if ((share < 1) == (next_share >= 1)) {
        const double part = (1 - share) / (next_share - share);
        Unknowns there{at.q + part * (next.q - at.q), at.tensions + part * (next.tensions - at.tensions)};
        const Eigen::VectorXd started = there.q;
        const Descent descent = descend(there, 1);
        const Eigen::VectorXd moved = there.q - started;
        if (!descent.settled || std::sqrt(dot(moved, moved)) > stride) continue;
        at = there;
        if (descent.negative != negative) result.ambiguous = true;
        negative_ = descent.negative;
        return true;
      }
      way += stride;
      at = next;
      share = next_share;
      if (correction <= 3) stride = std::min(longest_stride, 1.6 * stride);
      if (negative_ != negative && !turns) stride = std::max(stride, afterwards);
      break;
    }
    if (way > longest_path || share < least_share) {
      result.end = StaticsEnd::no_equilibrium;
      return false;
    }
  }
  return false;
}

}  // namespace flexura
