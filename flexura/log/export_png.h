#pragma once

#include <filesystem>
#include <vector>

#include "flexura/camera/camera_config.h"
#include "flexura/log/export_films.h"

namespace flexura {

/// Makes films (export_films) as animated PNG pictures, which browsers play: RESULTS/png/NAME.png. These
/// films are lossless and repeat endlessly. Making these films needs no other program. Format: W3C, Portable
/// Network Graphics, third edition, 2025, chunks acTL, fcTL and fdAT.
ExportResult export_png(const std::filesystem::path& results, const std::vector<CameraConfig>& cameras,
                        Progress* progress = nullptr);

}  // namespace flexura
