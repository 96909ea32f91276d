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
  ArmState arm;  ///< State to which the arm is commanded.
  /// Axis positions of each camera's head and stage: the readings, or the last commands in a live session
  /// without a shown run.
  std::vector<CameraReading> cameras;
};

/// Returns the rig's experiment with another start: the arm's initial command and the readings of the camera
/// axes are those of `instant`. Differences between truth and model at the start stay unchanged.
[[nodiscard]] Experiment started_at(const ViewedRig& rig, const RigInstant& instant);

/// Returns the problems of a text as an experiment file, with their lines and columns; empty if the text is
/// valid. The text must not name other files: neither `include` nor files of keyframes.
[[nodiscard]] std::vector<Problem> experiment_problems(const std::string& text);

/// Returns the text of an experiment for editing: `file_text` if it alone gives the experiment, otherwise a
/// text with every value.
[[nodiscard]] std::string editable_text(const std::string& file_text, const Experiment& experiment);

/// Returns `text`, which gives the rig's experiment, with a task `move` to a state at its end. If that is not
/// possible in `text`, returns a text with every value.
[[nodiscard]] std::string with_move(const std::string& text, const ViewedRig& rig, const ArmState& to);
/// Returns `text`, which gives the rig's experiment, with another start of one camera's axes. If that is not
/// possible in `text`, returns a text with every value.
[[nodiscard]] std::string with_camera_start(const std::string& text, const ViewedRig& rig, std::size_t camera,
                                            const CameraReading& reading);

/// Returns the name of a file that does not exist in `folder`: "STEM-2.toml", "STEM-3.toml", ...
[[nodiscard]] std::string free_name(const std::filesystem::path& folder, const std::string& stem);

/// Writes a new file into `folder` and returns its path. Throws ViewRefusal if `name` is not a plain name
/// that ends with .toml, if the file exists or cannot be written.
std::filesystem::path save_new_experiment(const std::filesystem::path& folder, const std::string& name,
                                          const std::string& text);

}  // namespace flexura
