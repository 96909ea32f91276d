#include "flexura/log/export_mp4.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <stdexcept>

#include "flexura/base/source.h"
#include "flexura/base/table.h"
#include "flexura/camera/sensor.h"
#include "flexura/log/messages.h"
#include "flexura/log/results.h"
#include "flexura/log/results_log.h"
#include "flexura/store/child_process.h"
#include "flexura/store/json.h"

namespace flexura {
namespace {

double seconds(const TimeMessage& time) {
  return static_cast<double>(time.sec) + 1e-9 * static_cast<double>(time.nsec);
}

// Calls see(camera, image) for every image of the log.
template <class See>
void for_each_image(const McapReader& log, See&& see) {
  const std::string prefix = image_topic("");
  for (const McapMessage& message : log.messages()) {
    const std::string& topic = message.channel->topic;
    if (!topic.starts_with(prefix)) continue;
    see(topic.substr(prefix.size()),
        read_as<ImageMessage>(parse_json(message.text(), "an image of the log")));
  }
}

// Returns the end of the run, s: its last state is always in the log.
double end_of(const McapReader& log) {
  std::uint64_t last = 0;
  for (const McapMessage& message : log.messages()) last = std::max(last, message.log_time);
  return 1e-9 * static_cast<double>(last);
}

// Returns the sensors of the cameras that filmed the run. Throws InputError if there are no images.
std::map<std::string, SensorConfig> sensors_of(const McapReader& log,
                                               const std::vector<CameraConfig>& cameras,
                                               const std::filesystem::path& results) {
  std::map<std::string, SensorConfig> sensors;
  for_each_image(log, [&](const std::string& camera, const ImageMessage&) {
    for (const CameraConfig& config : cameras)
      if (config.name == camera) sensors.try_emplace(camera, config.sensor);
  });
  if (!sensors.empty()) return sensors;
  throw input_error(
      results.string(),
      "holds no images: expected a run with [record] cameras = true; where it was, no frame arrived "
      "before its end");
}

class Film {
 public:
  // For equal images the bytes are equal: one thread, no date, no version.
  Film(const std::filesystem::path& file, const SensorConfig& sensor)
      : frame_rate_(sensor.frame_rate),
        first_(frame_times(sensor, 0).middle),
        program_({film_program, "-loglevel",
                  "error",      "-nostdin",
                  "-f",         "image2pipe",
                  "-framerate", fmt::format("{:.9g}", frame_rate_),
                  "-c:v",       "png",
                  "-i",         "-",
                  "-c:v",       "libx264",
                  "-pix_fmt",   "yuv420p",
                  "-vf",        "pad=ceil(iw/2)*2:ceil(ih/2)*2",
                  "-threads",   "1",
                  "-fflags",    "+bitexact",
                  "-flags:v",   "+bitexact",
                  file.string()}) {}

  void show(const ImageMessage& image) {
    const std::int64_t number = std::llround((seconds(image.timestamp) - first_) * frame_rate_);
    if (frames_ == 0) shown_ = image.data.data;
    fill(number);
    put(image.data.data);
    shown_ = image.data.data;
  }
  // Includes the frames that began up to the run's end.
  void finish(double end) {
    constexpr double rounding = 1e-6;
    fill(static_cast<std::int64_t>(std::floor(end * frame_rate_ + rounding)) + 1);
    finish();
  }

 private:
  // More than any run makes: keeps a damaged log from filling the disk.
  static constexpr std::int64_t most_frames = 1000000;

  // Repeats the last picture until there are this many frames.
  void fill(std::int64_t frames) {
    while (frames_ < std::min(frames, most_frames)) put(shown_);
  }
  void finish() {
    if (const int status = program_.finish(); status != 0)
      throw std::runtime_error(
          fmt::format("{} made no film: it ended with the status {}", film_program, status));
  }
  void put(const std::string& png) {
    if (!program_.write(png)) finish();
    ++frames_;
  }

  double frame_rate_;
  double first_;  // Timestamp of frame 0, s.
  ChildProcess program_;
  std::int64_t frames_ = 0;
  std::string shown_;
};

}  // namespace

ExportResult export_mp4(const std::filesystem::path& results, const std::vector<CameraConfig>& cameras,
                        Progress* progress) {
  const McapReader log = open_log(results);
  const auto sensors = from_log([&] { return sensors_of(log, cameras, results); });
  if (!has_program(film_program))
    throw std::runtime_error(fmt::format(
        "there is no program {0} on the PATH, which makes films: install the package {0}", film_program));
  ExportResult result{make_new_folder(results / "mp4"), log.truncated()};
  std::map<std::string, Film> films;
  for (const auto& [camera, sensor] : sensors)
    films.try_emplace(camera, result.folder / (camera + ".mp4"), sensor);
  const double end = end_of(log);
  for_each_image(log, [&](const std::string& camera, const ImageMessage& image) {
    if (progress != nullptr)
      progress->update(end > 0 ? std::clamp(seconds(image.timestamp) / end, 0.0, 1.0) : 0, "films");
    if (const auto film = films.find(camera); film != films.end()) film->second.show(image);
  });
  for (auto& [camera, film] : films) film.finish(end);
  return result;
}

}  // namespace flexura
