#pragma once

#include <array>
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

}  // namespace flexura
