#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "flexura/base/progress.h"

namespace flexura {

/// Colours of sections (section i has colour i modulo 8) and of obstacles, as in reports (report/figure.css).
/// Each colour is red, green, blue from 0 to 1.
extern const std::array<std::array<double, 3>, 8> section_colors;
extern const std::array<double, 3> report_obstacle_color;

/// Result of an export as glTF.
struct GltfExport {
  std::filesystem::path file;      ///< The new file.
  std::vector<std::string> notes;  ///< What is missing in the log (log_notes).
};

/// Writes the motion of a run's arm as a binary glTF 2.0 file. The arm is an animated tube with a skin on
/// joints along the backbone. The file also has the cameras and obstacles. The file shows the true arm if the
/// log contains it, otherwise the commanded arm. The file has 30 poses per second, but at most 3000 poses.
/// `file`: the new file; empty: arm.glb in the new folder RESULTS/gltf (gltf-2, ... if it exists). `progress`
/// may be null. Throws InputError if `results` is not a run's folder or its log is damaged,
/// std::runtime_error if the file exists or cannot be written.
GltfExport export_gltf(const std::filesystem::path& results, const std::filesystem::path& file,
                       Progress* progress = nullptr);

}  // namespace flexura
