#pragma once

#include <fmt/format.h>

#include <string>

#include "tests/support/view_fakes.h"

namespace flexura {

/// Returns viewed_text with a true arm that is a steel wire of 2 mm radius. `mass` is its mass per length,
/// kg/m. Three tendons with friction end at each section.
inline std::string viewed_rod(double mass = 0.5, double friction = 0) {
  std::string text = viewed_text + "[truth.arm]\nmodel = \"static\"\ngravity = [0, -9.81, 0]\n";
  for (int section = 0; section < 2; ++section)
    text += fmt::format(
        "[[truth.arm.section]]\n"
        "material = {{ youngs_modulus = 200e9, poisson = 0.3, radius_mm = 2, mass_per_length = {} }}\n",
        mass);
  for (int tendon = 0; tendon < 6; ++tendon)
    text += fmt::format("[[truth.arm.tendon]]\nsection = {}\nradius_mm = 15\nangle_deg = {}\nfriction = {}\n",
                        1 + tendon / 3, 120 * (tendon % 3) + 40 * (tendon / 3), friction);
  return text;
}

}  // namespace flexura
