#pragma once

#include <optional>

namespace flexura {

/// Estimates the remaining time of a job from its progress so far.
class TimeLeft {
 public:
  /// Returns the remaining time, s, given that `fraction` in [0, 1] is done `elapsed` seconds after the
  /// start. Returns std::nullopt while too little of the job is done for an estimate. A fraction below the
  /// previous one starts a new part of the job.
  std::optional<double> at(double fraction, double elapsed);

 private:
  double begin_elapsed_ = 0;
  double begin_fraction_ = 0;
  double last_fraction_ = 0;
};

}  // namespace flexura
