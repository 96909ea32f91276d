#include "tests/support/visp_peer.h"

#include <visp3/core/vpColVector.h>
#include <visp3/core/vpMatrix.h>
#include <visp3/visual_features/vpFeaturePoint.h>
#include <visp3/vs/vpServo.h>

namespace flexura {
namespace {

vpFeaturePoint feature_of(const VispPoint& point) {
  vpFeaturePoint feature;
  feature.buildFrom(point.x, point.y, point.Z);
  return feature;
}

}  // namespace

std::array<double, 12> visp_interaction(const VispPoint& point) {
  const vpMatrix L = feature_of(point).interaction();
  std::array<double, 12> numbers{};
  for (unsigned int i = 0; i < 12; ++i) numbers[i] = L[i / 6][i % 6];
  return numbers;
}

std::array<double, 6> visp_velocity(const std::vector<VispPoint>& now, const std::vector<VispPoint>& wanted,
                                    double gain) {
  std::vector<vpFeaturePoint> features, goals;
  for (const VispPoint& point : now) features.push_back(feature_of(point));
  for (const VispPoint& point : wanted) goals.push_back(feature_of(point));
  vpServo task;
  task.setServo(vpServo::EYEINHAND_CAMERA);
  task.setInteractionMatrixType(vpServo::CURRENT);
  task.setLambda(gain);
  for (std::size_t i = 0; i < features.size(); ++i) task.addFeature(features[i], goals[i]);
  const vpColVector velocity = task.computeControlLaw();
  std::array<double, 6> numbers{};
  for (unsigned int i = 0; i < 6; ++i) numbers[i] = velocity[i];
  return numbers;
}

}  // namespace flexura
