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
  std::optional<GStreamerConfig> gstreamer;  ///< Pictures through GStreamer.
  std::optional<AravisConfig> aravis;        ///< Pictures of a GigE Vision or USB3 Vision camera.
  std::optional<V4l2Config> v4l2;            ///< Pictures of a camera of the kernel's video interface.
  std::optional<ViscaConfig> visca;          ///< Head with VISCA commands.
  std::optional<OnvifConfig> onvif;          ///< Head of an ONVIF camera.
  std::optional<V4l2HeadConfig> v4l2_head;   ///< Head with the controls of a USB camera.
};

/// How the motor positions become known at the start of a run.
enum class StartPositions {
  declared,  ///< The arm has its initial shape, and the motors are where the model expects them.
  /// The axes move to their limit switches, whose positions are known, and then slowly to the initial shape.
  homed,
  /// As homed, but tendons that are tighter than at rest are let out first. So all tendons are pulled in
  /// together in the end, with their backlash taken up.
  pretensioned,
};

/// The table [rig]: the equipment that runs the experiment.
struct RigEquipment {
  /// Longest time, s, for which the program may be silent while the arm moves. Then a second process stops
  /// all devices.
  double watchdog = 0.5;
  StartPositions start = StartPositions::declared;
  /// Motor positions at the limit switches, microsteps, one per axis; not for `declared`.
  std::vector<double> home = {};
  double pretension_speed = 0.002;           ///< Largest speed of the tendons while they are pulled in, m/s.
  std::vector<GrblConfig> grbl = {};         ///< Controllers, in the order of the axes.
  std::optional<Cia402Config> cia402 = {};   ///< Drives on a CAN bus; not together with `grbl`.
  std::vector<CameraEquipment> camera = {};  ///< Devices of the experiment's cameras, matched by name.
};

const std::vector<std::string>& names_of(const StartPositions*);
const Table<CameraEquipment>& fields_of(const CameraEquipment*);
const Table<RigEquipment>& fields_of(const RigEquipment*);

/// Reports to `reader` why the equipment does not fit an experiment with these cameras and this number of
/// axes (0: no drive).
void check_equipment(const RigEquipment& equipment, const std::vector<std::string>& cameras, std::size_t axes,
                     Reader& reader);

}  // namespace flexura
