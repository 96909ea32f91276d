#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "flexura/camera/view.h"
#include "flexura/render/scene.h"

namespace flexura {

/// Content of a picture at an instant.
struct ShownScene {
  Scene scene;  ///< Complete scene at this instant.
  View view;    ///< View of the camera.
};

/// Writes the true values that belong to the picture of `shown`, which is in the file `image`. The true
/// values are computed from the geometry, without sensor effects. Let NAME.png be the name of `image`. The
/// written files are in the same folder:
///   NAME_depth.tiff   Depth along the optical axis, m; infinite without an object.
///   NAME_s.tiff       Arc length on the arm, m; not a number elsewhere.
///   NAME_labels.png   Visible object, 16 bits.
///   NAME_flow.tiff    Motion in the image until `next`, px right and down; only if there is a next.
///   NAME_truth.json   The camera, the labels' meaning, the backbone, the outlines and the markers in the
///                     image.
/// Returns the paths of the files. Throws std::runtime_error with the path on a system error.
std::vector<std::filesystem::path> write_truth(const ShownScene& shown, const std::optional<ShownScene>& next,
                                               const std::filesystem::path& image);

}  // namespace flexura
