#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace flexura {

/// Resolution and limits of a controller's axes.
struct GrblAxes {
  std::vector<double> per_mm;         ///< Steps per mm ($100 and following).
  std::vector<double> rates;          ///< Highest speeds, mm/s ($110).
  std::vector<double> accelerations;  ///< Largest accelerations, mm/s^2 ($120).
};

/// Commanded path of a controller: straight lines between positions, in steps. The path contains only the
/// part that the controller has not yet reported as completed. Estimates the remaining duration, and checks
/// whether a reported position is plausible.
class GrblPath {
 public:
  explicit GrblPath(GrblAxes axes) : axes_(std::move(axes)), end_(axes_.per_mm.size(), 0) {}

  /// Sets the path to a position, steps, at which the controller is at rest at time `now`, s.
  void rest(std::vector<std::int64_t> position, double now);
  /// Sets the path to a position, steps, at which the controller was stopped at time `now`, s. The function
  /// ends a stream of commands.
  void stop(std::vector<std::int64_t> position, double now);
  /// Returns the last target, steps.
  [[nodiscard]] const std::vector<std::int64_t>& end() const { return end_; }
  /// Returns the speed, mm/min, of a motion to `target`, within the limits of the axes. The motion ends at
  /// now + duration, s. If the controller still moves, or has stopped less than `lead` s ago, the motion ends
  /// `lead` s later. So the controller follows a stream of commands with the delay `lead`.
  [[nodiscard]] double feed_to(std::span<const std::int64_t> target, double duration, double lead,
                               double now) const;
  /// Adds a motion that the controller has accepted, with a feed in mm/min.
  void add(std::vector<std::int64_t> target, double feed, double now);
  /// Returns the estimated time until the last target is reached, s; 0 at rest. The additional time for
  /// braking is not included.
  [[nodiscard]] double lag(double now) const;
  /// Returns true if a moving controller can be at this position, steps, at time `now`, s. The position must
  /// be within `tolerance` steps of the path, not behind an earlier report, and reachable by this time.
  [[nodiscard]] bool can_be_at(std::span<const std::int64_t> position, double tolerance, double now) const;
  /// Returns the number of straight lines that the controller has not yet reported as completed; at most
  /// 1000.
  [[nodiscard]] std::size_t legs() const { return legs_.size(); }
  /// Stores a plausible position, steps, in a report that was requested at time `asked` and received at time
  /// `received`, s.
  void report(std::span<const std::int64_t> position, double asked, double received);

 private:
  /// Largest number of lines in the queue of a controller: that of grblHAL.
  static constexpr std::size_t most_legs = 1000;
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
  [[nodiscard]] Place place_on(std::size_t leg, std::span<const std::int64_t> position) const;
  [[nodiscard]] std::vector<Place> places_of(std::span<const std::int64_t> position, double tolerance,
                                             double now) const;
  [[nodiscard]] double way_to(const Place& place) const;
  [[nodiscard]] double time_from(const Place& place) const;
  void forget_passed_legs();
  [[nodiscard]] double margin_of(double tolerance) const;

  GrblAxes axes_;
  std::deque<Leg> legs_;
  std::vector<std::int64_t> end_;
  double passed_ = 0;  // Share of the first leg at the last report.
  // Legs may cover each other, so a report may fit several places: passed_ is the first of them, and the last
  // is this way behind it, mm.
  double spread_ = 0;
  double reported_at_ = 0;                                      // Time of the last report or rest.
  double ends_at_ = 0;                                          // When the end is passed, without braking.
  double rests_at_ = -std::numeric_limits<double>::infinity();  // When the end is reached, with braking.
};

}  // namespace flexura
