#pragma once

#include <filesystem>
#include <vector>

#include "flexura/camera/camera_config.h"
#include "flexura/log/export_films.h"

namespace flexura {

/// Name of the program that makes films.
inline constexpr const char* film_program = "ffmpeg";

/// Makes films (export_films) with the program ffmpeg on the PATH: RESULTS/mp4/NAME.mp4 (H.264). Throws the
/// exceptions of export_films, and std::runtime_error if ffmpeg is missing or fails.
ExportResult export_mp4(const std::filesystem::path& results, const std::vector<CameraConfig>& cameras,
                        Progress* progress = nullptr);

}  // namespace flexura
