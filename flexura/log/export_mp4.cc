#include "flexura/log/export_mp4.h"

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

#include "flexura/store/child_process.h"

namespace flexura {
namespace {

class Mp4Writer : public FilmWriter {
 public:
  // For equal images the bytes are equal: one thread, no date, no version.
  Mp4Writer(const std::filesystem::path& file, double frame_rate)
      : program_({film_program, "-loglevel",
                  "error",      "-nostdin",
                  "-f",         "image2pipe",
                  "-framerate", fmt::format("{:.9g}", frame_rate),
                  "-c:v",       "png",
                  "-i",         "-",
                  "-c:v",       "libx264",
                  "-pix_fmt",   "yuv420p",
                  "-vf",        "pad=ceil(iw/2)*2:ceil(ih/2)*2",
                  "-threads",   "1",
                  "-fflags",    "+bitexact",
                  "-flags:v",   "+bitexact",
                  file.string()}) {}

  void put(const std::string& png, std::int64_t times) override {
    for (; times > 0; --times)
      if (!program_.write(png)) finish();
  }
  void finish() override {
    if (const int status = program_.finish(); status != 0)
      throw std::runtime_error(
          fmt::format("{} failed to make a film: its exit status is {}", film_program, status));
  }

 private:
  ChildProcess program_;
};

}  // namespace

ExportResult export_mp4(const std::filesystem::path& results, const std::vector<CameraConfig>& cameras,
                        Progress* progress) {
  if (!has_program(film_program))
    throw std::runtime_error(fmt::format(
        "the program {0}, which makes films, is not on the PATH: install the package {0}", film_program));
  return export_films(
      results, "mp4", cameras,
      [](const std::filesystem::path& stem, const SensorConfig& sensor) {
        return std::make_unique<Mp4Writer>(stem.string() + ".mp4", sensor.frame_rate);
      },
      progress);
}

}  // namespace flexura
