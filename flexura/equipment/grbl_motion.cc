#include "flexura/equipment/grbl_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <ranges>
#include <utility>

namespace flexura {
namespace {

double norm(const std::vector<double>& vector) {
  double sum = 0;
  for (const double one : vector) sum += one * one;
  return std::sqrt(sum);
}

// Returns how fast a vector of this direction may be until one axis reaches its limit.
double along(const std::vector<double>& direction, const std::vector<double>& limits) {
  double most = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < direction.size(); ++i)
    if (direction[i] != 0) most = std::min(most, limits[i] / std::abs(direction[i]));
  return most;
}

// Returns the speed at which the corner between two directions is passed.
double corner_speed(const std::vector<double>& before, const std::vector<double>& after,
                    const GrblLimits& limits) {
  double cosine = 0;
  std::vector<double> change(before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    cosine -= before[i] * after[i];
    change[i] = after[i] - before[i];
  }
  if (cosine > 0.999999) return 0;
  const double size = norm(change);
  if (cosine < -0.999999 || size == 0) return std::numeric_limits<double>::infinity();
  for (double& one : change) one /= size;
  const double half_sine = std::sqrt(0.5 * (1 - cosine));
  return std::sqrt(along(change, limits.accelerations) * limits.junction_deviation * half_sine /
                   (1 - half_sine));
}

}  // namespace

void GrblMotion::add(const std::vector<double>& target, double feed, const GrblLimits& limits) {
  std::vector<double> direction(target.size());
  for (std::size_t i = 0; i < target.size(); ++i) direction[i] = target[i] - last_[i];
  const double length = norm(direction);
  if (!(length > 0)) return;
  for (double& one : direction) one /= length;
  Block block{.from = last_,
              .to = target,
              .direction = direction,
              .length = length,
              .speed = std::min(feed, along(direction, limits.rates)),
              .acceleration = along(direction, limits.accelerations),
              .most_entry = 0};
  if (!blocks_.empty())
    block.most_entry = std::min(
        {block.speed, blocks_.back().speed, corner_speed(blocks_.back().direction, direction, limits)});
  if (blocks_.empty()) done_ = 0, planned_speed_ = 0;
  last_ = target;
  blocks_.push_back(std::move(block));
  plan();
}

void GrblMotion::plan() {
  double exit = 0;
  for (Block& block : blocks_ | std::views::reverse) {
    block.entry = std::min(block.most_entry, std::sqrt(exit * exit + 2 * block.acceleration * block.length));
    exit = block.entry;
  }
}

void GrblMotion::step() {
  const auto is_at_rest = [&] { return blocks_.empty() || (is_braking_ && planned_speed_ == 0); };
  while (prepared_.size() < most_prepared && !is_at_rest()) prepare();
  if (prepared_.empty()) return;
  position_ = std::move(prepared_.front().position);
  direction_ = std::move(prepared_.front().direction);
  speed_ = prepared_.front().speed;
  prepared_.pop_front();
  if (!prepared_.empty()) return;
  speed_ = 0;
  std::ranges::fill(direction_, 0);
}

void GrblMotion::prepare() {
  const std::vector<double> direction = blocks_.front().direction;
  double left = tick, way = 0;
  while (!blocks_.empty() && left > 0) {
    const Block& block = blocks_.front();
    const double exit = blocks_.size() > 1 ? blocks_[1].entry : 0;
    const double rest = block.length - done_;
    if (is_braking_) {
      planned_speed_ = std::max(0.0, planned_speed_ - block.acceleration * left);
      if (planned_speed_ == 0) break;
    } else {
      const double most = std::min(block.speed, std::sqrt(exit * exit + 2 * block.acceleration * rest));
      planned_speed_ = std::min(planned_speed_ + block.acceleration * left, most);
    }
    // The last bit of a block that ends at rest would take forever.
    const double least = 0.5 * block.acceleration * tick * tick;
    if (planned_speed_ * left < rest && rest > least) {
      done_ += planned_speed_ * left;
      way += planned_speed_ * left;
      for (std::size_t i = 0; i < planned_.size(); ++i)
        planned_[i] = block.from[i] + block.direction[i] * done_;
      break;
    }
    left = planned_speed_ > 0 ? left - std::min(left, rest / planned_speed_) : 0;
    way += rest;
    planned_ = block.to;
    done_ = 0;
    blocks_.pop_front();
    if (exit == 0) planned_speed_ = 0;
  }
  if (blocks_.empty()) planned_speed_ = 0;
  prepared_.push_back({planned_, direction, way / tick});
}

void GrblMotion::reset(const std::vector<double>& position) {
  blocks_.clear();
  prepared_.clear();
  position_ = position, last_ = position, planned_ = position;
  std::ranges::fill(direction_, 0);
  done_ = 0, speed_ = 0, planned_speed_ = 0;
  is_braking_ = false;
}

}  // namespace flexura
