#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "flexura/base/progress.h"
#include "flexura/camera/camera_config.h"
#include "flexura/camera/sensor.h"
#include "flexura/log/export_csv.h"

namespace flexura {

/// Writes one film.
class FilmWriter {
 public:
  virtual ~FilmWriter() = default;
  FilmWriter() = default;
  FilmWriter(const FilmWriter&) = delete;
  FilmWriter& operator=(const FilmWriter&) = delete;
  FilmWriter(FilmWriter&&) = delete;
  FilmWriter& operator=(FilmWriter&&) = delete;

  /// Appends a picture `times` > 0 times. `png` is the content of the picture's PNG file.
  virtual void put(const std::string& png, std::int64_t times) = 0;
  /// Completes the film. The caller must call this function once, after the last frame.
  virtual void finish() = 0;
};

/// Returns the writer of a new film of a camera. `stem`: the film's path without extension.
using NewFilm =
    std::function<std::unique_ptr<FilmWriter>(const std::filesystem::path& stem, const SensorConfig& sensor)>;

/// Makes a film of each camera's images in a run's log. The films are written to the new folder
/// RESULTS/FOLDER (FOLDER-2, ... if it exists). A film has the camera's frame rate and lasts from time 0 to
/// the run's end. A lost frame is replaced by the previous frame or, at the beginning, by the first frame.
/// `cameras` are the run's true cameras. `progress` may be null. Throws InputError if `results` has no log or
/// no images.
ExportResult export_films(const std::filesystem::path& results, const std::string& folder,
                          const std::vector<CameraConfig>& cameras, const NewFilm& new_film,
                          Progress* progress = nullptr);

}  // namespace flexura
