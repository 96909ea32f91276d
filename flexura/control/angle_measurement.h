#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <deque>

namespace flexura {

/// Quantities that are measured to determine the angles.
enum class AngleReading : std::uint8_t {
  angles,  ///< theta and q at each node.
  /// Angles of the arm's direction in two parallel projections, at each point of the arm (PlaneObserver).
  planes,
};

/// Measurement of a distributed arm's angles, for a law that does not know the exact angles.
struct AngleMeasurement {
  double step = 0.02;  ///< Time between measurements, s; > 0.
  double delay = 0;    ///< Delay of each measurement, s; >= 0.
  /// Standard deviations of the noise of theta and q at each node, or of alpha_1 and alpha_2 at each point,
  /// rad; >= 0.
  std::array<double, 2> noise = {0, 0};
  std::uint64_t seed = 1;  ///< Seed of the random noise; equal seeds give equal noise.
  AngleReading reading = AngleReading::angles;
};

/// Measures the coordinates of a DistributedArm at the times 0, step, 2 step, ..., with a delay. Angles at
/// the nodes have normally distributed noise, independent from node to node and from time to time. Before
/// time 0, the state is assumed to equal the state at time 0.
class MeasuredCoordinates {
 public:
  /// `nodes`: number of coordinates of each angle of the arm. Throws std::invalid_argument for numbers out of
  /// their range or not finite.
  MeasuredCoordinates(const AngleMeasurement& measurement, Eigen::Index nodes);

  /// Returns the time of the next measurement, s.
  [[nodiscard]] double next() const { return static_cast<double>(count_) * measurement_.step; }
  /// Measures the arm's state (x, dx/dt), which must be the state at the time next().
  void take(const Eigen::VectorXd& x, const Eigen::VectorXd& v);
  /// Returns the coordinates of the newest measurement; empty before the first measurement.
  [[nodiscard]] const Eigen::VectorXd& seen() const { return seen_; }
  /// Returns a random number with variance 1: the noise of number `which` in the newest measurement.
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
  std::deque<Moment> moments_;  // The last moment that is as old as the delay, and all later ones.
  Eigen::VectorXd seen_;
};

}  // namespace flexura
