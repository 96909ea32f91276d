#pragma once

#include <fmt/format.h>

#include <string>

namespace flexura {

/// Two small cameras and an arm of three sections. `sensor`: additional sensor settings; `rest`: additional
/// lines of the file.
struct ServoSetup {
  std::string sensor = "read_noise = 1, delay = 0.06, exposure = 0.002";
  std::string arm = "max_bend_deg = 120\nmax_bend_rate_deg = 90";
  std::string rest = "";
};

inline std::string servo_file(const std::string& task, const ServoSetup& rig = {}) {
  std::string text = "[clock]\nstep = 0.05\n[arm]\nkind = \"spatial\"\n";
  for (const double length : {0.35, 0.35, 0.3})
    text += fmt::format("[[arm.section]]\nlength = {}\nradius = 0.02\n{}\n", length, rig.arm);
  for (const bool is_side : {false, true})
    text += fmt::format(
        "[[camera]]\nname = \"{}\"\nmount = {{ position = [{}, 0.5, {}], look_at = [0, 0.5, 0] }}\n"
        "lens = {{ fx = 400 }}\nsensor = {{ width = 320, height = 240, frame_rate = 30, psf = 0.7, full_well "
        "= 20000, {} }}\n",
        is_side ? "side" : "front", is_side ? -2.5 : 0, is_side ? 0 : 2.5, rig.sensor);
  return text + rig.rest + "[[task]]\nkind = \"servo\"\n" + task;
}

inline const std::string servo_target = "[[task.target]]\nbends = [[0.8, 0.3], [-0.7, 0.9], [1.0, -0.6]]\n";

}  // namespace flexura
