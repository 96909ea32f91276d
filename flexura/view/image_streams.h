#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "flexura/serve/server.h"

namespace flexura {

/// Which client gets images of which camera when: at its rate, and the next one only after the client has
/// said that the last has come.
class ImageStreams {
 public:
  struct Key {
    ClientId client = 0;
    std::size_t camera = 0;
    auto operator<=>(const Key&) const = default;
  };

  /// `rate` a second; 0 ends the stream.
  void set(const Key& key, double rate, int quality);
  void ack(const Key& key, std::int64_t number);
  void close(ClientId client);

  /// Whether image `number` of the camera is due at `now` s: another than the last one sent.
  [[nodiscard]] bool is_due(const Key& key, std::int64_t number, double now) const;
  /// The streams of a camera to which its image `number` is due.
  [[nodiscard]] std::vector<Key> due(std::size_t camera, std::int64_t number, double now) const;
  /// Of a stream that there is.
  [[nodiscard]] int quality(const Key& key) const { return streams_.at(key).quality; }
  /// The image is on its way.
  void sent(const Key& key, std::int64_t number, double now);
  /// It is not, after all.
  void failed(const Key& key);
  [[nodiscard]] bool contains(const Key& key) const { return streams_.contains(key); }

 private:
  struct Stream {
    double interval = 0;  // s
    int quality = 80;
    std::optional<std::int64_t> last;
    bool is_acknowledged = true;
    double due = 0;  // s
  };
  std::map<Key, Stream> streams_;
};

}  // namespace flexura
