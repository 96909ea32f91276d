#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "flexura/base/source.h"
#include "flexura/experiment/experiment.h"
#include "flexura/view/viewed_rig.h"

// Texts of experiments that clients look at, edit and save.
namespace flexura {

/// State of a rig or a recording at one time.
struct RigInstant {
  ArmState arm;  ///< Commanded state of the arm.
  /// Axis positions of each camera's head and stage. These are the measured positions; in a live session that
  /// shows no run, the last commanded positions.
  std::vector<CameraReading> cameras;
};

/// Returns the rig's experiment with `instant` as its start: the arm's initial command and the camera axes'
/// measured positions. Initial differences between the true rig and its model do not change.
[[nodiscard]] Experiment started_at(const ViewedRig& rig, const RigInstant& instant);

/// Returns the errors in the text of an experiment file, with their lines and columns; empty if the text is
/// valid. The text must not refer to other files by `include` or as keyframes.
[[nodiscard]] std::vector<Problem> experiment_problems(const std::string& text);

/// Returns the text of an experiment for editing: `file_text` if this text alone defines the experiment,
/// otherwise a complete text with every value.
[[nodiscard]] std::string editable_text(const std::string& file_text, const Experiment& experiment);

/// Appends a task `move` to a given state to `text`, the text of the rig's experiment, and returns the
/// result. If `text` cannot be changed in this way, returns a complete text with every value.
[[nodiscard]] std::string with_move(const std::string& text, const ViewedRig& rig, const ArmState& to);
/// Changes the initial axis positions of one camera in `text`, the text of the rig's experiment, and returns
/// the result. If `text` cannot be changed in this way, returns a complete text with every value.
[[nodiscard]] std::string with_camera_start(const std::string& text, const ViewedRig& rig, std::size_t camera,
                                            const CameraReading& reading);

/// Returns the name of a file that does not exist in `folder`: "STEM-2.toml", "STEM-3.toml", ...
[[nodiscard]] std::string free_name(const std::filesystem::path& folder, const std::string& stem);

/// Writes a new file into `folder` and returns its path. Throws ViewRefusal if `name` is not a plain file
/// name that ends with .toml, if the file exists, or if it cannot be written.
std::filesystem::path save_new_experiment(const std::filesystem::path& folder, const std::string& name,
                                          const std::string& text);

}  // namespace flexura
