#include "flexura/experiment/export_mp4.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <stdexcept>

#include "flexura/base/source.h"
#include "flexura/experiment/messages.h"
#include "flexura/experiment/results.h"
#include "flexura/experiment/results_log.h"
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

// The shortest time between two images of each camera, s: that of one frame, unless every second one was
// lost.
std::map<std::string, double> frame_times_of(const McapReader& log) {
  std::map<std::string, double> shortest, last;
  for_each_image(log, [&](const std::string& camera, const ImageMessage& image) {
    const double time = seconds(image.timestamp);
    const auto [found, is_first] = shortest.try_emplace(camera, std::numeric_limits<double>::infinity());
    if (!is_first && time > last[camera]) found->second = std::min(found->second, time - last[camera]);
    last[camera] = time;
  });
  constexpr double of_a_single_image = 1;
  for (auto& [camera, time] : shortest)
    if (!std::isfinite(time)) time = of_a_single_image;
  return shortest;
}

class Film {
 public:
  // The same images give the same bytes: one thread, no date, no version.
  Film(const std::filesystem::path& file, double frame_time)
      : frame_time_(frame_time), program_({film_program, "-loglevel",
                                           "error",      "-nostdin",
                                           "-f",         "image2pipe",
                                           "-framerate", fmt::format("{:.9g}", 1 / frame_time),
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
    const double time = seconds(image.timestamp);
    // Those lost in between, as far as there is one before.
    if (frames_ > 0) {
      const auto missing = std::llround((time - last_) / frame_time_) - 1;
      for (std::int64_t i = 0; i < missing && i < most_missing; ++i) put(shown_);
    }
    put(image.data.data);
    shown_ = image.data.data;
    last_ = time;
  }
  void finish() {
    if (const int status = program_.finish(); status != 0)
      throw std::runtime_error(
          fmt::format("{} made no film: it ended with the status {}", film_program, status));
  }

 private:
  static constexpr std::int64_t most_missing = 100000;

  void put(const std::string& png) {
    if (!program_.write(png)) finish();
    ++frames_;
  }

  double frame_time_;
  ChildProcess program_;
  std::int64_t frames_ = 0;
  double last_ = 0;
  std::string shown_;
};

}  // namespace

ExportResult export_mp4(const std::filesystem::path& results) {
  const McapReader log = open_log(results);
  const auto frame_times = from_log([&] { return frame_times_of(log); });
  if (frame_times.empty())
    throw input_error(results.string(),
                      "holds no images: expected a run of an experiment with [record] cameras = true");
  if (!has_program(film_program))
    throw std::runtime_error(
        fmt::format("there is no program {} on the PATH: films are made by it", film_program));
  ExportResult result{make_new_folder(results / "mp4"), log.truncated()};
  std::map<std::string, Film> films;
  for (const auto& [camera, time] : frame_times)
    films.try_emplace(camera, result.folder / (camera + ".mp4"), time);
  for_each_image(log,
                 [&](const std::string& camera, const ImageMessage& image) { films.at(camera).show(image); });
  for (auto& [camera, film] : films) film.finish();
  return result;
}

}  // namespace flexura
