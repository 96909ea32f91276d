#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "flexura/camera/camera_config.h"
#include "flexura/log/export_csv.h"

namespace flexura {

/// Program that makes films.
inline constexpr const char* film_program = "ffmpeg";

/// Makes a film of each camera's images in a run's log with the program ffmpeg on the PATH: NAME.mp4 (H.264).
/// They are in the new folder RESULTS/mp4 (mp4-2, ... if it exists). A film has the camera's frame rate, and
/// every frame from time 0 to the run's end. Lost frames repeat the previous one, or the first one. `cameras`
/// are the run's true cameras. `progress` may be null; it cannot end the export. Throws InputError if
/// `results` has no log or no images, std::runtime_error if ffmpeg is missing or fails.
ExportResult export_mp4(const std::filesystem::path& results, const std::vector<CameraConfig>& cameras,
                        Progress* progress = nullptr);

}  // namespace flexura
