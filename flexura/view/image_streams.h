#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "flexura/serve/server.h"

namespace flexura {

/// Decides when to send a camera's images to a client. Each pair of client and camera is a stream with its
/// own rate. The next image is due only after the client has acknowledged the previous image.
class ImageStreams {
 public:
  struct Key {
    ClientId client = 0;
    std::size_t camera = 0;
    auto operator<=>(const Key&) const = default;
  };

  /// Sets the rate in images/s; 0 ends the stream.
  void set(const Key& key, double rate, int quality);
  void ack(const Key& key, std::int64_t number);
  void close(ClientId client);

  /// Returns whether image `number` of the camera is due at `now` (s). An image is not due if it was the last
  /// image sent.
  [[nodiscard]] bool is_due(const Key& key, std::int64_t number, double now) const;
  /// Returns the streams of a camera for which its image `number` is due.
  [[nodiscard]] std::vector<Key> due(std::size_t camera, std::int64_t number, double now) const;
  /// Returns the quality of an existing stream.
  [[nodiscard]] int quality(const Key& key) const { return streams_.at(key).quality; }
  /// Records that the image is being sent.
  void sent(const Key& key, std::int64_t number, double now);
  /// Records that sending failed.
  void failed(const Key& key);
  [[nodiscard]] bool contains(const Key& key) const { return streams_.contains(key); }

 private:
  struct Stream {
    double interval = 0;  // Time between images, s.
    int quality = 80;
    std::optional<std::int64_t> last;
    bool is_acknowledged = true;
    double due = 0;  // Time at which the next image is due, s.
  };
  std::map<Key, Stream> streams_;
};

}  // namespace flexura
