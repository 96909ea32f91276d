#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "flexura/camera/view.h"
#include "flexura/render/scene.h"

namespace flexura {

/// What a picture shows, at an instant.
struct ShownScene {
  Scene scene;  ///< All that stands there then.
  View view;    ///< The camera's.
};

/// Writes what is true of the picture of `shown` in the file `image`, from the geometry and free of sensor
/// effects, beside it, NAME.png's files being
///   NAME_depth.tiff   along the optical axis, m, infinite where nothing is
///   NAME_s.tiff       arc length on the arm, m, no number elsewhere
///   NAME_labels.png   what is seen, 16 bits
///   NAME_flow.tiff    how far what is seen moves until `next`, px right and down; only when there is a next
///   NAME_truth.json   the camera, the labels' meaning, the backbone, the outlines and the markers in the
///   image
/// Returns the files. std::runtime_error with the path when the system refuses.
std::vector<std::filesystem::path> write_truth(const ShownScene& shown, const std::optional<ShownScene>& next,
                                               const std::filesystem::path& image);

}  // namespace flexura
