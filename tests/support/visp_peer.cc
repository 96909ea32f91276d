#include "tests/support/visp_peer.h"

#include <visp3/core/vpColVector.h>
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

struct VispServo::Kept {
  std::vector<vpFeaturePoint> features, goals;
  vpServo task;
};

VispServo::VispServo(const std::vector<VispPoint>& desired, double gain) : kept_(std::make_unique<Kept>()) {
  for (const VispPoint& point : desired) {
    kept_->features.push_back(feature_of(point));
    kept_->goals.push_back(feature_of(point));
  }
  kept_->task.setServo(vpServo::EYEINHAND_CAMERA);
  kept_->task.setInteractionMatrixType(vpServo::CURRENT);
  kept_->task.setLambda(gain);
  for (std::size_t i = 0; i < desired.size(); ++i)
    kept_->task.addFeature(kept_->features[i], kept_->goals[i]);
}

VispServo::~VispServo() = default;

std::array<double, 6> VispServo::velocity(const std::vector<VispPoint>& now) {
  for (std::size_t i = 0; i < now.size(); ++i) kept_->features[i].buildFrom(now[i].x, now[i].y, now[i].Z);
  const vpColVector velocity = kept_->task.computeControlLaw();
  std::array<double, 6> numbers{};
  for (unsigned int i = 0; i < 6; ++i) numbers[i] = velocity[i];
  return numbers;
}

}  // namespace flexura
