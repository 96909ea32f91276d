#pragma once

#include <array>
#include <memory>
#include <vector>

// Results of ViSP as plain numbers, because its headers are not valid C++20.
namespace flexura {

/// Normalised coordinates and depth of a point.
struct VispPoint {
  double x, y, Z;
};

/// A vpServo of a freely moving camera, with the current interaction matrix; it keeps its state between
/// steps.
class VispServo {
 public:
  VispServo(const std::vector<VispPoint>& desired, double gain);
  ~VispServo();
  VispServo(const VispServo&) = delete;
  VispServo& operator=(const VispServo&) = delete;
  /// Returns the commanded velocity [v; w] in C for the observed points, as many as there are targets.
  std::array<double, 6> velocity(const std::vector<VispPoint>& now);

 private:
  struct Kept;
  std::unique_ptr<Kept> kept_;
};

}  // namespace flexura
