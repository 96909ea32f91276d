#include "flexura/view/image_streams.h"

#include <algorithm>

namespace flexura {

void ImageStreams::set(const Key& key, double rate, int quality) {
  if (!(rate > 0)) {
    streams_.erase(key);
    return;
  }
  // Resets the stream: a client that asks again may have lost the images in transit.
  streams_[key] = {.interval = 1 / rate, .quality = quality, .last = {}};
}

void ImageStreams::ack(const Key& key, std::int64_t number) {
  const auto found = streams_.find(key);
  if (found != streams_.end() && found->second.last == number) found->second.is_acknowledged = true;
}

void ImageStreams::close(ClientId client) {
  std::erase_if(streams_, [&](const auto& entry) { return entry.first.client == client; });
}

bool ImageStreams::is_due(const Key& key, std::int64_t number, double now) const {
  const auto found = streams_.find(key);
  if (found == streams_.end()) return false;
  const Stream& stream = found->second;
  // Half a tick of a 60 Hz session counts as on time, so that rates are as requested and not the next lower
  // step.
  constexpr double half_a_tick = 0.5 / 60;
  return stream.is_acknowledged && stream.last != number && now + half_a_tick >= stream.due;
}

std::vector<ImageStreams::Key> ImageStreams::due(std::size_t camera, std::int64_t number, double now) const {
  std::vector<Key> keys;
  for (const auto& [key, stream] : streams_)
    if (key.camera == camera && is_due(key, number, now)) keys.push_back(key);
  return keys;
}

void ImageStreams::sent(const Key& key, std::int64_t number, double now) {
  const auto found = streams_.find(key);
  if (found == streams_.end()) return;
  Stream& stream = found->second;
  stream.last = number;
  stream.is_acknowledged = false;
  stream.due = std::max(stream.due, now - stream.interval) + stream.interval;
}

void ImageStreams::failed(const Key& key) {
  const auto found = streams_.find(key);
  if (found != streams_.end()) found->second.is_acknowledged = true;
}

}  // namespace flexura
