#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <deque>

namespace flexura {

/// By what a law gets to know the angles.
enum class AngleReading : std::uint8_t {
  angles,  ///< theta and q at each node.
  planes,  ///< What two parallel views show of each point of the arm (PlaneSight).
};

/// How a law gets to know a distributed arm's angles when it does not have them exactly.
struct AngleMeasurement {
  double step = 0.02;  ///< s from one measurement to the next; > 0.
  double delay = 0;    ///< s by which each is late; >= 0.
  /// Standard deviations, rad; >= 0: of theta and of q at each node, or of alpha_1 and alpha_2 at each point.
  std::array<double, 2> noise = {0, 0};
  std::uint64_t seed = 1;  ///< Of the noise; the same one gives the same numbers.
  AngleReading reading = AngleReading::angles;
};

/// Measures the coordinates of a DistributedArm at the times 0, step, 2 step, ...: late, and, where the
/// angles are read at the nodes, with normally distributed noise, independent from node to node and from time
/// to time. Of what was before the first measurement it has that one.
class MeasuredCoordinates {
 public:
  /// Of an arm whose angles have `nodes` numbers each. std::invalid_argument: numbers out of their range or
  /// not finite.
  MeasuredCoordinates(const AngleMeasurement& measurement, Eigen::Index nodes);

  /// When the next measurement is due, s.
  [[nodiscard]] double next() const { return static_cast<double>(count_) * measurement_.step; }
  /// The state (x, dx/dt) at next().
  void take(const Eigen::VectorXd& x, const Eigen::VectorXd& v);
  /// The coordinates as the newest measurement has them; empty before the first one.
  [[nodiscard]] const Eigen::VectorXd& seen() const { return seen_; }
  /// Noise of variance 1 that the newest measurement has of its `which`-th number.
  [[nodiscard]] double deviate(std::uint64_t which) const;

 private:
  struct Moment {
    double time;
    Eigen::VectorXd x, v;
  };
  [[nodiscard]] Eigen::VectorXd at(double time) const;

  AngleMeasurement measurement_;
  Eigen::Index nodes_;
  std::uint64_t count_ = 0;
  std::deque<Moment> moments_;  // The last one that is as old as the delay, and all after it.
  Eigen::VectorXd seen_;
};

}  // namespace flexura
