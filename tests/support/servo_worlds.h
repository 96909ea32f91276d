#pragma once

#include <fmt/format.h>

#include <array>
#include <string>

#include "tests/support/loop_files.h"

namespace flexura {

/// Returns the rig of the servo study. Time steps are one frame; sensors have the latency and short exposure
/// of real cameras.
inline LoopRig study_rig(const std::array<WrongStart, 2>& wrong) {
  LoopRig rig = arcs_cameras(wrong);
  rig.sensor = ", delay = 0.06, exposure = 0.002", rig.frame_rate = 30;
  return rig;
}

/// The true arm and its model.
struct ServoWorld {
  int arcs = 1;  ///< Arcs per section in the model.
  bool sags =
      false;  ///< True arm of elastic rods under tendon forces and weight; otherwise one arc per section.
  bool knows = false;  ///< The model has elastic rods too, 20 % stiffer; otherwise arcs.
};

/// Turns the sections of the table `arm` or `truth.arm` of a file into a steel wire of 2 mm radius with 0.2
/// kg/m, with three tendons to the end of each section.
inline void let_sag(const std::string& table, double youngs_modulus, std::string& text) {
  const std::string section = fmt::format("\n[[{}.section]]\n", table);
  for (std::size_t at = text.find(section); at != std::string::npos; at = text.find(section, at + 1))
    text.insert(at + section.size(),
                fmt::format("material = {{ youngs_modulus = {}, radius_mm = 2, mass_per_length = 0.2 }}\n",
                            youngs_modulus));
  if (table == "arm") {
    const std::string head = "[arm]\n";
    text.insert(text.find(head) + head.size(), "model = \"static\"\ngravity = [0, -9.81, 0]\n");
  } else {
    text += fmt::format("\n[{}]\nmodel = \"static\"\ngravity = [0, -9.81, 0]\n", table);
  }
  for (int i = 0; i < 9; ++i)
    text += fmt::format("[[{}.tendon]]\nsection = {}\nradius_mm = 15\nangle_deg = {}\n", table, i / 3 + 1,
                        120 * (i % 3) + 40 * (i / 3));
}

/// Returns the file of such a rig: in colour with bands for the calibration, or in gray without bands.
inline std::string servo_world_file(const LoopRig& rig, bool is_colored, const ServoWorld& world = {}) {
  std::string text = arcs_rig("method = \"bundle\"\n", rig);
  if (!is_colored) {
    const std::size_t look = text.find("[arm.look]");
    text.erase(look, text.find("\n[", look) + 1 - look);
    // There are no bands to calibrate with, so the calibration task is replaced.
    text = text.substr(0, text.find("[[task]]")) + "[[task]]\nkind = \"hold\"\nduration = 1\n";
    const std::string color = "\"color\"";
    for (std::size_t at = text.find(color); at != std::string::npos; at = text.find(color))
      text.replace(at, color.size(), "\"gray\"");
  }
  const std::string limit = "max_bend_deg = 120\n";
  for (std::size_t at = text.find(limit); at != std::string::npos; at = text.find(limit, at + 1))
    text.insert(at + limit.size(), world.arcs == 1 ? "max_bend_rate_deg = 90\n"
                                                   : "max_bend_rate_deg = 90\nbend_profile = [1, 1, 1]\n");
  if (world.sags) let_sag("truth.arm", 200e9, text);
  if (world.knows) let_sag("arm", 240e9, text);
  return text;
}

}  // namespace flexura
