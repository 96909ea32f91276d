#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/equipment/aravis_camera.h"
#include "flexura/equipment/cia402_config.h"
#include "flexura/equipment/grbl_config.h"
#include "flexura/equipment/gstreamer_camera.h"
#include "flexura/equipment/onvif_config.h"
#include "flexura/equipment/v4l2_camera.h"
#include "flexura/equipment/v4l2_head.h"
#include "flexura/equipment/visca_config.h"

namespace flexura {

/// Devices of one camera, `[[rig.camera]]`: one source of pictures and at most one head.
struct CameraEquipment {
  std::string name;                          ///< Name of the camera in the experiment.
  std::optional<GStreamerConfig> gstreamer;  ///< Pictures from a GStreamer pipeline.
  std::optional<AravisConfig> aravis;        ///< Pictures from a GigE Vision or USB3 Vision camera.
  std::optional<V4l2Config> v4l2;            ///< Pictures from a Video4Linux2 camera, such as a USB camera.
  std::optional<ViscaConfig> visca;          ///< Head that is moved by VISCA commands.
  std::optional<OnvifConfig> onvif;          ///< Head of an ONVIF network camera.
  std::optional<V4l2HeadConfig> v4l2_head;   ///< Pan, tilt and zoom controls of a USB camera.
};

/// How the program determines the motor positions at the start of a run.
enum class StartPositions {
  /// The arm has its initial shape, and the motors are at the positions that the model computes for this
  /// shape.
  declared,
  /// The axes move to their limit switches, whose positions are known, and then slowly to the initial shape.
  homed,
  /// As `homed`, but tendons that are tighter than in the initial shape are let out first. Finally all
  /// tendons are pulled in together, which removes their backlash.
  pretensioned,
};

/// The table [rig]: the equipment that runs the experiment.
struct RigEquipment {
  /// Longest time without a sign of life of the program while the arm moves, s. After this time a second
  /// process stops all devices.
  double watchdog = 0.5;
  StartPositions start = StartPositions::declared;
  /// Motor positions at the limit switches, microsteps, one per axis; not for `declared`.
  std::vector<double> home = {};
  double pretension_speed = 0.002;           ///< Largest speed of the tendons while they are pulled in, m/s.
  std::vector<GrblConfig> grbl = {};         ///< Grbl controllers, in the order of their axes.
  std::optional<Cia402Config> cia402 = {};   ///< Drives on a CAN bus; not together with `grbl`.
  std::vector<CameraEquipment> camera = {};  ///< Devices of the experiment's cameras, matched by name.
};

const std::vector<std::string>& names_of(const StartPositions*);
const Table<CameraEquipment>& fields_of(const CameraEquipment*);
const Table<RigEquipment>& fields_of(const RigEquipment*);

/// Reports to `reader` the reasons why the equipment does not fit an experiment with these cameras and this
/// number of axes (0: no drive).
void check_equipment(const RigEquipment& equipment, const std::vector<std::string>& cameras, std::size_t axes,
                     Reader& reader);

}  // namespace flexura
