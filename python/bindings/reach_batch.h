#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "flexura/experiment/experiment.h"
#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/statics.h"
#include "flexura/rig/photographer.h"
#include "flexura/sim/thread_pool.h"
#include "python/bindings/arm.h"
#include "python/bindings/rod.h"

namespace flexura::python {

/// Settings of the task: to bring the tip, or the whole backbone, to a target.
struct ReachConfig {
  bool is_shape = false;  ///< Whether the target is a shape; otherwise it is the tip's position.
  bool is_elastic =
      false;  ///< Whether actions are tensions of an elastic arm; otherwise they are rates of the bends.
  double time_step = 0.05;    ///< Time of one action, s.
  int substeps = 5;           ///< Steps of the dynamics in this time.
  int max_steps = 200;        ///< Actions after which an episode is truncated.
  double tolerance = 0.02;    ///< Error at which the target is reached, as part of the arm's length.
  double max_tension = 5;     ///< Tension of the action 1, N; the action -1 is no tension.
  double max_rate = 1;        ///< Rate of the bends of the action 1, rad/s.
  bool has_pictures = false;  ///< Whether observations are pictures by the first two cameras.
};

/// Many arms that each reach for a target, advanced on several threads. Results do not depend on the number
/// of threads.
class ReachBatch {
 public:
  /// `experiment`: the cameras and the surroundings for pictures; may be null without pictures. Throws
  /// std::invalid_argument for settings out of range and arms without material or tendons, if elastic.
  ReachBatch(std::shared_ptr<const DescribedArm> arm, const Experiment* experiment, const ReachConfig& config,
             std::size_t count, std::size_t threads);
  ~ReachBatch();

  [[nodiscard]] std::size_t count() const { return arms_.size(); }
  /// Returns the number of actions, from -1 to 1, of an arm.
  [[nodiscard]] std::size_t actions() const;
  /// Returns the number of values of a state observation: the coordinates (strain modes as angles and
  /// strains, and their rates; or bends), the observed points relative to the base, and those of the target,
  /// m.
  [[nodiscard]] std::size_t observations() const;
  /// Returns width and height of the pictures.
  [[nodiscard]] std::array<int, 2> picture_size() const;

  /// Sets the random streams of the arms: arm i of the seed has a stream of its own.
  void seed(std::uint64_t seed);
  /// Starts an episode of an arm.
  void reset(std::span<const bool> chosen);
  /// Where the results of a step are written; one entry per arm.
  struct Results {
    double *rewards, *errors;
    bool *terminated, *truncated;
  };
  /// Applies actions (count x actions). An arm whose episode has ended is reset instead.
  void step(const double* actions, const Results& results);
  /// Writes the state observations, count x observations().
  void observe(float* to);
  /// Writes pictures of the arm by two cameras, and then of the arm in the target shape: count x 4 x height x
  /// width.
  void photograph(std::uint8_t* to);
  /// Returns the shape of an arm, and of its target.
  [[nodiscard]] Backbone backbone(std::size_t i) const;
  [[nodiscard]] const Backbone& target(std::size_t i) const { return *arms_[i].target; }

 private:
  struct Worker;
  // Random numbers of SplitMix64 (G. Steele, D. Lea, C. Flood, 2014).
  struct Random {
    std::uint64_t state = 0;
    double uniform(double low, double high);
  };
  struct ReachArm {
    RodState rod;    // If elastic.
    ArmState bends;  // Otherwise.
    Random random;
    std::optional<Backbone> target;
    Eigen::Matrix3Xd target_points;
    int steps = 0;
    std::int64_t frames = 0;
    bool has_ended = true;
  };

  template <class Work>
  void for_arms(const Work& work);
  void begin(Worker& worker, ReachArm& arm) const;
  [[nodiscard]] std::optional<Eigen::VectorXd> random_tensions(Worker& worker, Random& random) const;
  [[nodiscard]] Backbone random_target(Worker& worker, Random& random) const;
  [[nodiscard]] bool apply(Worker& worker, ReachArm& arm, const double* actions) const;
  [[nodiscard]] Eigen::Matrix3Xd points_of(const Backbone& backbone) const;
  [[nodiscard]] static Backbone backbone_of_modes(const Worker& worker, const Eigen::VectorXd& q);
  [[nodiscard]] Backbone backbone_of(const Worker& worker, const ReachArm& arm) const;
  [[nodiscard]] Eigen::Matrix3Xd points_of(Worker& worker, const ReachArm& arm) const;
  [[nodiscard]] double error_of(Worker& worker, const ReachArm& arm) const;

  std::shared_ptr<const DescribedArm> arm_;
  ReachConfig config_;
  std::optional<ArmsRod> rod_;
  RodState rest_;
  std::vector<View> views_;
  std::vector<SensorConfig> sensors_;
  std::vector<std::unique_ptr<Worker>> workers_;
  std::vector<ReachArm> arms_;
  std::uint64_t seed_ = 0;
  ThreadPool pool_;
};

}  // namespace flexura::python
