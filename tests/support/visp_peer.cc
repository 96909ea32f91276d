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

struct VispServo::Kept {
  std::vector<vpFeaturePoint> features, goals;
  vpServo task;
};

VispServo::VispServo(const std::vector<VispPoint>& wanted, double gain) : kept_(std::make_unique<Kept>()) {
  for (const VispPoint& point : wanted) {
    kept_->features.push_back(feature_of(point));
    kept_->goals.push_back(feature_of(point));
  }
  kept_->task.setServo(vpServo::EYEINHAND_CAMERA);
  kept_->task.setInteractionMatrixType(vpServo::CURRENT);
  kept_->task.setLambda(gain);
  for (std::size_t i = 0; i < wanted.size(); ++i) kept_->task.addFeature(kept_->features[i], kept_->goals[i]);
}

VispServo::~VispServo() = default;

std::array<double, 6> VispServo::velocity(const std::vector<VispPoint>& now) {
  for (std::size_t i = 0; i < now.size(); ++i) kept_->features[i].buildFrom(now[i].x, now[i].y, now[i].Z);
  const vpColVector velocity = kept_->task.computeControlLaw();
  std::array<double, 6> numbers{};
  for (unsigned int i = 0; i < 6; ++i) numbers[i] = velocity[i];
  return numbers;
}

std::array<double, 6> visp_velocity(const std::vector<VispPoint>& now, const std::vector<VispPoint>& wanted,
                                    double gain) {
  return VispServo(wanted, gain).velocity(now);
}

}  // namespace flexura
