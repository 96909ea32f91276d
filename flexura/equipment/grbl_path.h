#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace flexura {

/// What a controller's axes can do, and how finely they are counted.
struct GrblAxes {
  std::vector<double> per_mm;         ///< Steps per mm ($100 and following).
  std::vector<double> rates;          ///< mm/s ($110)
  std::vector<double> accelerations;  ///< mm/s^2 ($120)
};

/// The way that a controller has been commanded and has not yet reported to have passed: straight legs
/// between positions in steps. Estimates how long it will be under way, and says whether a report can be
/// true.
class GrblPath {
 public:
  explicit GrblPath(GrblAxes axes) : axes_(std::move(axes)), end_(axes_.per_mm.size(), 0) {}

  /// The controller rests at a position, steps, at time `now`, s.
  void rest(std::vector<std::int64_t> position, double now);
  /// The controller was stopped at a position, steps, at time `now`, s: a stream of commands has ended.
  void stop(std::vector<std::int64_t> position, double now);
  /// Returns the last target, steps.
  [[nodiscard]] const std::vector<std::int64_t>& end() const { return end_; }
  /// Returns the speed, mm/min, of a motion to `target` that lasts until `duration` s after `now`. If the
  /// controller still moves, or has stopped less than `lead` s ago, it lasts until `lead` s later: a stream
  /// of commands is followed with this delay. The motion is limited by its axes.
  [[nodiscard]] double feed_to(std::span<const std::int64_t> target, double duration, double lead,
                               double now) const;
  /// Adds a motion that the controller has accepted, with a feed in mm/min.
  void add(std::vector<std::int64_t> target, double feed, double now);
  /// Returns the estimated time until the last target is reached, without the time of braking, s; 0 at rest.
  [[nodiscard]] double lag(double now) const;
  /// Returns true if a controller that moves may be at this position, steps, at time `now`. The position must
  /// be within `tolerance` steps of the way, not behind an earlier report, and not further than it can go.
  [[nodiscard]] bool can_be_at(std::span<const std::int64_t> position, double tolerance, double now) const;
  /// Takes a position that can be, as reported at time `now` or later.
  void report(std::span<const std::int64_t> position, double now);

 private:
  struct Leg {
    std::vector<std::int64_t> from, to;
    double length = 0, speed = 0, acceleration = 0;  // mm, mm/s, mm/s^2
  };
  struct Place {
    std::size_t leg = 0;
    double share = 0;  // Of the leg's length.
    double error = 0;  // Largest distance from the leg, steps.
  };
  [[nodiscard]] Leg leg_to(std::span<const std::int64_t> target) const;
  [[nodiscard]] Place place_of(std::span<const std::int64_t> position, double tolerance) const;
  [[nodiscard]] double way_to(const Place& place) const;
  [[nodiscard]] double margin_of(double tolerance) const;

  GrblAxes axes_;
  std::deque<Leg> legs_;
  std::vector<std::int64_t> end_;
  double passed_ = 0;                                           // Share of the first leg at the last report.
  double reported_at_ = 0;                                      // Time of the last report or rest.
  double ends_at_ = 0;                                          // When the end is passed, without braking.
  double rests_at_ = -std::numeric_limits<double>::infinity();  // When the end is reached, with braking.
};

}  // namespace flexura
