#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/base/image.h"
#include "flexura/base/source.h"

namespace flexura {

struct ArmScene;
struct Setup;

/// A table [[seeing]]: what separates the arm from its surroundings in the pictures of one camera
/// (docs/vision.md, "Arms in front of anything").
struct SeeingConfig {
  std::string camera;  ///< Name of the camera.
  /// Corners [u, v] of the region in which the arm is, px: two opposite ones of a rectangle, or at least
  /// three of a polygon; empty: the whole picture.
  std::vector<std::array<double, 2>> region;
  std::string background;  ///< Picture file without the arm, in the experiment's folder or below; "": none.
  std::optional<std::array<double, 3>> color;  ///< Red, green and blue of the arm, from 0 to 255.
};

/// A table [[backdrop]]: a picture that a simulated camera sees behind everything else.
struct BackdropConfig {
  std::string camera;   ///< Name of the camera.
  std::string picture;  ///< Picture file, in the experiment's folder or below.
};

const Table<SeeingConfig>& fields_of(const SeeingConfig*);
const Table<BackdropConfig>& fields_of(const BackdropConfig*);

/// Reports unknown cameras and wrong regions to `reader`.
void check_seeing(const Setup& setup, Reader& reader);
/// Returns the problems of the picture files, at their places in `document`. The files are read again when
/// they are needed.
[[nodiscard]] std::vector<Problem> seeing_file_problems(const Setup& setup, const Node& document);

/// Copies the picture files into the folder of a run's results, which then needs no other files. Does nothing
/// for a setup without a folder. Throws InputError or std::runtime_error for a file that cannot be copied.
void copy_seeing_files(const Setup& setup, const std::filesystem::path& results);

/// Returns what separates the arm from its surroundings, for each camera of the setup; null: nothing is
/// given. Throws InputError for a picture that is not readable or has another size than the camera's
/// pictures.
[[nodiscard]] std::vector<std::shared_ptr<const ArmScene>> arm_scenes(const Setup& setup);

/// Returns the light that a camera sees behind everything else: one or three channels of the size of its
/// pictures, 1 being full scale; empty: no backdrop, or a setup without a folder. Throws InputError as
/// arm_scenes().
[[nodiscard]] Image<float> backdrop_light(const Setup& setup, std::size_t camera);

}  // namespace flexura
