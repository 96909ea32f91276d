#include "bench/dart_rod.h"

#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/dynamics/UniversalJoint.hpp>
#include <dart/simulation/World.hpp>
#include <string>

namespace flexura {

struct DartRod::Model {
  dart::simulation::WorldPtr world;
  dart::dynamics::SkeletonPtr skeleton;
  dart::dynamics::BodyNode* last = nullptr;
  double to_tip = 0;
};

DartRod::DartRod(const RodSection& section, const Eigen::Vector3d& gravity, int joints, double step)
    : model_(std::make_unique<Model>()) {
  using dart::dynamics::UniversalJoint;
  const double piece = section.length / joints;
  const double stiffness = section.stiffness_at(0)[3] / piece, damping = section.damping_at(0)[3] / piece;
  model_->skeleton = dart::dynamics::Skeleton::create("rod");
  dart::dynamics::BodyNode* parent = nullptr;
  for (int i = 0; i < joints; ++i) {
    // From the middle of a piece to that of the next one, or to the end.
    const double length = i + 1 < joints ? piece : piece / 2;
    const double mass = section.mass_per_length_at(0) * length, radius = section.radius[0];
    const double across = mass * (3 * radius * radius + length * length) / 12,
                 along = mass * radius * radius / 2;
    // Unique names avoid a warning from DART for each renamed joint.
    UniversalJoint::Properties of_joint;
    of_joint.mName = "joint " + std::to_string(i);
    const auto [joint, body] = model_->skeleton->createJointAndBodyNodePair<UniversalJoint>(
        parent, of_joint, dart::dynamics::BodyNode::AspectProperties("body " + std::to_string(i)));
    Eigen::Isometry3d at = Eigen::Isometry3d::Identity();
    at.translation().z() = i == 0 ? piece / 2 : piece;
    joint->setTransformFromParentBodyNode(at);
    joint->setAxis1(Eigen::Vector3d::UnitX());
    joint->setAxis2(Eigen::Vector3d::UnitY());
    for (std::size_t axis = 0; axis < 2; ++axis) {
      joint->setSpringStiffness(axis, stiffness);
      joint->setDampingCoefficient(axis, damping);
    }
    dart::dynamics::Inertia inertia;
    inertia.setMass(mass);
    inertia.setLocalCOM({0, 0, length / 2});
    inertia.setMoment(Eigen::Vector3d(across, across, along).asDiagonal());
    body->setInertia(inertia);
    parent = body;
  }
  model_->last = parent;
  model_->to_tip = piece / 2;
  model_->world = dart::simulation::World::create();
  model_->world->setGravity(gravity);
  model_->world->setTimeStep(step);
  model_->world->addSkeleton(model_->skeleton);
}

DartRod::~DartRod() = default;

void DartRod::reset() {
  model_->skeleton->resetPositions();
  model_->skeleton->resetVelocities();
  model_->world->reset();
}

void DartRod::step() { model_->world->step(); }

Eigen::Vector3d DartRod::tip() const {
  return model_->last->getWorldTransform() * Eigen::Vector3d(0, 0, model_->to_tip);
}

}  // namespace flexura
