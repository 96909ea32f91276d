#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "flexura/camera/camera_config.h"
#include "flexura/log/export_csv.h"

namespace flexura {

/// The program that makes films.
inline constexpr const char* film_program = "ffmpeg";

/// Makes a film of each camera's images in a run's log: NAME.mp4 (H.264) in the new folder RESULTS/mp4
/// (mp4-2, ... when it exists), by the program ffmpeg on the PATH. A film has the camera's frame rate, and
/// every frame from time 0 to the run's end: lost ones are shown as the one before, or the first that came.
/// `cameras` are the run's, as they truly are. InputError when `results` holds no log or one without images;
/// std::runtime_error when ffmpeg is missing or fails.
ExportResult export_mp4(const std::filesystem::path& results, const std::vector<CameraConfig>& cameras);

}  // namespace flexura
