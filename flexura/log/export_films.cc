#include "flexura/log/export_films.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "flexura/base/source.h"
#include "flexura/base/table.h"
#include "flexura/log/messages.h"
#include "flexura/log/results.h"
#include "flexura/log/results_log.h"
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
      "has no images: expected a run with [record] cameras = true, in which at least one frame arrived");
}

// The frames of a film, from time 0 on. Equal successive frames are written at once.
class Film {
 public:
  Film(std::unique_ptr<FilmWriter> writer, const SensorConfig& sensor)
      : writer_(std::move(writer)), frame_rate_(sensor.frame_rate), first_(frame_times(sensor, 0).middle) {}

  void show(const ImageMessage& image) {
    const std::int64_t number = std::llround((seconds(image.timestamp) - first_) * frame_rate_);
    if (frames_ == 0) shown_ = image.data.data;
    repeat_until(number);
    if (image.data.data != shown_) {
      write();
      shown_ = image.data.data;
    }
    repeat_until(frames_ + 1);
  }
  // Includes the frames that began up to the run's end.
  void finish(double end) {
    constexpr double rounding = 1e-6;
    repeat_until(static_cast<std::int64_t>(std::floor(end * frame_rate_ + rounding)) + 1);
    write();
    writer_->finish();
  }

 private:
  // More than any run makes: keeps a damaged log from filling the disk.
  static constexpr std::int64_t most_frames = 1000000;

  // Repeats the last picture until there are this many frames.
  void repeat_until(std::int64_t frames) {
    const std::int64_t more = std::max<std::int64_t>(0, std::min(frames, most_frames) - frames_);
    frames_ += more, waiting_ += more;
  }
  void write() {
    if (waiting_ > 0) writer_->put(shown_, waiting_);
    waiting_ = 0;
  }

  std::unique_ptr<FilmWriter> writer_;
  double frame_rate_;
  double first_;  // Timestamp of frame 0, s.
  std::int64_t frames_ = 0, waiting_ = 0;
  std::string shown_;
};

}  // namespace

ExportResult export_films(const std::filesystem::path& results, const std::string& folder,
                          const std::vector<CameraConfig>& cameras, const NewFilm& new_film,
                          Progress* progress) {
  const McapReader log = open_log(results);
  const auto sensors = from_log([&] { return sensors_of(log, cameras, results); });
  ExportResult result{make_new_folder(results / folder), log_notes(log)};
  std::map<std::string, Film> films;
  for (const auto& [camera, sensor] : sensors)
    films.try_emplace(camera, new_film(result.folder / camera, sensor), sensor);
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
