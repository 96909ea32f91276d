#pragma once

#include <string>

#include "flexura/experiment/experiment.h"
#include "flexura/rig/rehearsal.h"

namespace flexura {

// Returns the experiment as a laboratory has it: on the devices of a rehearsal, and without the truth. All
// waits are long: a busy machine must not fail a test.
inline Experiment on_devices_of(const Rehearsal& rehearsal, Experiment experiment) {
  constexpr double patience = 30;  // s
  experiment.truth.reset();
  RigEquipment& rig = experiment.equipment.emplace(rehearsal.equipment());
  rig.watchdog = patience;
  for (GrblConfig& grbl : rig.grbl) grbl.answer_timeout = 10, grbl.connect_timeout = patience;
  for (CameraEquipment& camera : rig.camera) {
    camera.gstreamer.value().silence = patience;
    ViscaConfig& head = camera.visca.value();
    head.bus.reply_timeout = 10, head.stall_time = patience;
  }
  return experiment;
}

}  // namespace flexura
