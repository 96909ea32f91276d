#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/camera/head.h"
#include "flexura/math/pose.h"
#include "flexura/mechanics/rod_energy.h"
#include "flexura/model/arm.h"
#include "flexura/model/backbone.h"

// The binary messages of docs/viewer-protocol.md.
namespace flexura {

/// A point of the backbone.
struct ArmSample {
  double s = 0;  ///< Arc length along the unstretched arm, m.
  Pose X_WS;
};

/// Pose, axis positions and intrinsics of a camera.
struct CameraSample {
  Pose X_WC;
  HeadState head;                                   ///< True position of the head.
  Eigen::Vector3d stage = Eigen::Vector3d::Zero();  ///< True position of the stage, m.
  double fx = 0, fy = 0, cx = 0, cy = 0;            ///< Intrinsics, px.
  /// Commanded or reported position of the head, in the coordinates of commands and the model.
  HeadState commanded_head = {};
  Eigen::Vector3d commanded_stage = Eigen::Vector3d::Zero();  ///< Commanded or reported stage position, m.
};

/// State of an actuator that clients can move individually: a tendon.
struct ActuatorSample {
  double value = 0;  ///< Commanded displacement, m.
  double force = 0;  ///< Tension, N; 0 for a slack tendon.
  double lost = 0;   ///< Number of microsteps that the tendon's motor has lost.
};

/// A push at a point of the arm.
struct PushSample {
  double s = 0;  ///< Pushed point: arc length along the unstretched arm, m.
  /// Fixed end of the spring in W, m; without a spring, the pushed point.
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< Force on the arm, N.
};

/// A contact of the arm.
struct ContactSample {
  /// Whether the contact slides or sticks, if known.
  enum class Slip : std::uint8_t { unknown, slides, sticks };
  int obstacle = -1;  ///< Index of the obstacle in the scene; -1: the arm itself.
  double s = 0;       ///< Arc length along the unstretched arm, m.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< Contact point, m.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< Force on the arm, N.
  double normal_force = 0;                          ///< Force normal to the surface, N.
  Slip slip = Slip::unknown;
};

/// State of everything that moves, at one time.
struct StateMessage {
  bool is_moving = false;
  bool is_running = false;  ///< Whether a run of tasks is active.
  bool is_recording = false;
  bool is_unsafe = false;
  bool is_weightless = false;  ///< Whether weight and loads are switched off.
  /// Number of jumps of the whole state so far (for example by a reset), modulo 65536.
  std::uint16_t leaps = 0;
  std::uint32_t sequence = 0;
  double time = 0;  ///< Time, s.
  ArmState arm;
  std::vector<ArmSample> samples;  ///< Points of the backbone, from base to tip.
  std::vector<CameraSample> cameras;
  std::vector<double> displacements;  ///< Tendon displacements, m.
  std::vector<ActuatorSample> actuators;
  std::optional<RodEnergy> energy;  ///< Energies of an arm with inertia.
  std::optional<PushSample> push;
  std::optional<double>
      pace;  ///< Speed of the simulation relative to real time; missing if the simulation runs in real time.
  std::vector<ContactSample> contacts;
};

/// Returns the samples of a state message: the ends of every arc, and points between them. Each piece between
/// two samples is one arc with an angle of at most 90 degrees.
[[nodiscard]] std::vector<ArmSample> arm_samples(const Backbone& backbone);
/// Returns the samples of consecutive arcs from the base to the frame `tip`.
[[nodiscard]] std::vector<ArmSample> arm_samples(std::span<const Arc> arcs, const Pose& tip);

/// Returns the binary message. Throws std::length_error if there are more than 65535 items of a kind.
[[nodiscard]] std::string state_message(const StateMessage& state);
/// Parses a state message, in single precision. Returns std::nullopt if `bytes` is not a valid message.
[[nodiscard]] std::optional<StateMessage> read_state_message(std::string_view bytes);

/// Formats of images.
enum class ImageFormat : std::uint16_t { jpeg = 0, png = 1 };

/// Returns an image message for a client: a header, followed by the image file.
[[nodiscard]] std::string image_message(std::uint8_t camera, ImageFormat format, std::uint32_t number,
                                        double time, std::string_view file);

}  // namespace flexura
