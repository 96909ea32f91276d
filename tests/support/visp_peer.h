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

/// A vpServo of a camera that moves freely, with the current interaction matrix, kept from step to step.
class VispServo {
 public:
  VispServo(const std::vector<VispPoint>& desired, double gain);
  ~VispServo();
  VispServo(const VispServo&) = delete;
  VispServo& operator=(const VispServo&) = delete;
  /// The velocity [v; w] in C that it asks for where these, as many as are wanted, are seen.
  std::array<double, 6> velocity(const std::vector<VispPoint>& now);

 private:
  struct Kept;
  std::unique_ptr<Kept> kept_;
};

}  // namespace flexura
