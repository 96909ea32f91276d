#pragma once

#include <array>
#include <memory>
#include <vector>

// ViSP's own answers, as plain numbers: its headers are no C++20.
namespace flexura {

/// A point's normalized coordinates and depth.
struct VispPoint {
  double x, y, Z;
};

/// vpFeaturePoint's interaction matrix, row by row.
std::array<double, 12> visp_interaction(const VispPoint& point);

/// vpServo's velocity [v; w] in C for a camera that moves freely, with the current interaction matrix.
std::array<double, 6> visp_velocity(const std::vector<VispPoint>& now, const std::vector<VispPoint>& wanted,
                                    double gain);

/// A vpServo that is kept from step to step, as a program that uses it would: likewise a free camera's.
class VispServo {
 public:
  VispServo(const std::vector<VispPoint>& wanted, double gain);
  ~VispServo();
  VispServo(const VispServo&) = delete;
  VispServo& operator=(const VispServo&) = delete;
  /// The velocity that it asks for where these, as many as are wanted, are seen.
  std::array<double, 6> velocity(const std::vector<VispPoint>& now);

 private:
  struct Kept;
  std::unique_ptr<Kept> kept_;
};

}  // namespace flexura
