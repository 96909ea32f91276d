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

/// A true arm of elastic rods with inertia, friction and a load, and the model of it. Both have a drive.
struct SwingingWorld {
  double stiffness = 1;              ///< True over nominal stiffness.
  double friction = 0.02;            ///< True friction coefficient of the tendons.
  double payload = 0.02;             ///< Mass at the tip that the model lacks, kg.
  double backlash_deg = 0.2;         ///< True backlash of the spools.
  double model_compliance = 2.5e-5;  ///< Of the tendons in the model, m/N; the true one is 3e-5.
  double model_backlash_deg = 0.15;  ///< Of the spools in the model.
  std::string model = "dynamic";     ///< `arm.model` of the model: "kinematic", "static" or "dynamic".
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

/// Inserts a line after the head of every entry of an array of tables.
inline void add_to_each(const std::string& table, const std::string& line, std::string& text) {
  const std::string head = fmt::format("\n[[{}]]\n", table);
  for (std::size_t at = text.find(head); at != std::string::npos; at = text.find(head, at + 1))
    text.insert(at + head.size(), line);
}

/// Replaces the colours and bands of a rig's file by gray pictures of a plain arm, and its task by a hold.
inline void make_gray(std::string& text) {
  const std::size_t look = text.find("[arm.look]");
  text.erase(look, text.find("\n[", look) + 1 - look);
  text = text.substr(0, text.find("[[task]]")) + "[[task]]\nkind = \"hold\"\nduration = 1\n";
  const std::string color = "\"color\"";
  for (std::size_t at = text.find(color); at != std::string::npos; at = text.find(color))
    text.replace(at, color.size(), "\"gray\"");
}

/// Returns the file of a rig whose true arm swings: three NiTi wires of 1.7 mm radius with 0.15 kg/m, pulled
/// by nine steel cables, by motors that hold their position. The straight arm stands upright.
inline std::string swinging_world_file(const LoopRig& rig, bool is_colored, const SwingingWorld& world) {
  std::string text = arcs_rig("method = \"bundle\"\npause = 5\n", rig);
  if (!is_colored) make_gray(text);
  const auto material = [](double stiffness) {
    return fmt::format(
        "material = {{ youngs_modulus = {}, radius_mm = 1.7, mass_per_length = 0.15, damping_time = 0.01 "
        "}}\n",
        stiffness * 54e9);
  };
  add_to_each("arm.section", "max_bend_rate_deg = 90\nbend_profile = [1, 1, 1]\n", text);
  const bool has_rods = world.model != "kinematic";
  if (has_rods) add_to_each("arm.section", material(1), text);
  add_to_each("truth.arm.section", material(world.stiffness), text);
  const std::string gravity = "gravity = [0, -9.81, 0]\n";
  if (has_rods) text.insert(text.find("[arm]\n") + 6, fmt::format("model = \"{}\"\n", world.model) + gravity);
  text += "\n[truth.arm]\nmodel = \"dynamic\"\n" + gravity;
  if (world.payload > 0)
    text += fmt::format("[[truth.arm.payload]]\nsection = 3\nmass = {}\n", world.payload);
  std::string axes;
  for (int i = 0; i < 9 && has_rods; ++i)
    text += fmt::format("[[arm.tendon]]\nsection = {}\nangle_deg = {}\nradius_mm = 15\ncompliance = {}\n",
                        i / 3 + 1, 120 * (i % 3) + 40 * (i / 3), world.model_compliance);
  for (int i = 0; i < 9; ++i) {
    const int section = i / 3 + 1, angle = 120 * (i % 3) + 40 * (i / 3);
    axes += fmt::format("  {{ section = {}, angle_deg = {} }},\n", section, angle);
    text += fmt::format(
        "[[truth.arm.tendon]]\nsection = {}\nangle_deg = {}\nradius_mm = 15\ncompliance = 3e-5\n"
        "friction = {}\n",
        section, angle, world.friction);
  }
  text += fmt::format(
      "[drive]\nradius_mm = 15\npretension = 10\nmotor = {{ steps = 200, phases = 2, microsteps = 16 }}\n"
      "spool = {{ radius_mm = 10, backlash_deg = {} }}\ntendon = [\n{}]\n[truth.drive.spool]\nbacklash_deg = "
      "{}\n",
      has_rods ? world.model_backlash_deg : 0.0, axes, world.backlash_deg);
  return text;
}

}  // namespace flexura
