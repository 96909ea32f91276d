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
  double s = 0;  ///< Along the unstretched arm, m.
  Pose X_WS;
};

/// How a camera stands.
struct CameraSample {
  Pose X_WC;
  HeadState head;                                   ///< As it truly is.
  Eigen::Vector3d stage = Eigen::Vector3d::Zero();  ///< Likewise, m.
  double fx = 0, fy = 0, cx = 0, cy = 0;            ///< px
  /// What head and stage are commanded to, or report: what commands and the model count in.
  HeadState commanded_head = {};
  Eigen::Vector3d commanded_stage = Eigen::Vector3d::Zero();  ///< m
};

/// Something that a client can move by itself, as it is: a tendon that is pulled in.
struct ActuatorSample {
  double value = 0;  ///< How far it is, as commanded, m.
  double force = 0;  ///< By which it pulls, N; 0: it hangs slack.
  double lost = 0;   ///< Steps that its motor has lost.
};

/// What pushes the arm at one of its points.
struct PushSample {
  double s = 0;  ///< The point: along the unstretched arm, m.
  /// Where the spring draws it; without a spring the point itself, m.
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< On the arm, N.
};

/// Where the arm touches something.
struct ContactSample {
  /// What is known of how it touches there.
  enum class Slip : std::uint8_t { unknown, slides, sticks };
  int obstacle = -1;                                ///< Its place in the scene; -1: the arm itself.
  double s = 0;                                     ///< Along the unstretched arm, m.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< On the arm, N.
  double normal_force = 0;                          ///< Across the surface, N.
  Slip slip = Slip::unknown;
};

/// What moves, at one time.
struct StateMessage {
  bool is_moving = false;
  bool is_running = false;  ///< A run of tasks is going on.
  bool is_recording = false;
  bool is_unsafe = false;
  bool is_weightless = false;  ///< Weight and loads are switched off.
  /// How often everything was put elsewhere, with no way between: counts up when it is, and wraps.
  std::uint16_t leaps = 0;
  std::uint32_t sequence = 0;
  double time = 0;  ///< s
  ArmState arm;
  std::vector<ArmSample> samples;  ///< Base first, the tip last.
  std::vector<CameraSample> cameras;
  std::vector<double> displacements;  ///< m, of the tendons.
  std::vector<ActuatorSample> actuators;
  std::optional<RodEnergy> energy;  ///< Of an arm in motion.
  std::optional<PushSample> push;
  std::optional<double> pace;  ///< Where it is slower than real time: of that.
  std::vector<ContactSample> contacts;
};

/// The samples of a state message: the ends of every arc, and so many points between that from one to the
/// next the backbone is one arc that turns by a right angle at most.
[[nodiscard]] std::vector<ArmSample> arm_samples(const Backbone& backbone);
/// The same of arcs that lead from the base to the tip's frame.
[[nodiscard]] std::vector<ArmSample> arm_samples(std::span<const Arc> arcs, const Pose& tip);

/// std::length_error for more than 65535 of anything.
[[nodiscard]] std::string state_message(const StateMessage& state);
/// The message that these bytes are, in single precision; none when they are none.
[[nodiscard]] std::optional<StateMessage> read_state_message(std::string_view bytes);

/// The formats of images.
enum class ImageFormat : std::uint16_t { jpeg = 0, png = 1 };

/// An image for a client: the message's head and the file.
[[nodiscard]] std::string image_message(std::uint8_t camera, ImageFormat format, std::uint32_t number,
                                        double time, std::string_view file);

}  // namespace flexura
