#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "flexura/port/camera_port.h"
#include "flexura/sim/simulated_camera.h"
#include "flexura/view/background.h"
#include "flexura/view/image_streams.h"
#include "flexura/view/messenger.h"
#include "flexura/view/session.h"
#include "flexura/view/viewed_rig.h"

namespace flexura {

/// The stream of Messenger::post for states; that of camera i's images is 1 + i.
inline constexpr std::uint32_t state_stream = 0;
[[nodiscard]] inline std::uint32_t image_stream(std::size_t camera) {
  return 1 + static_cast<std::uint32_t>(camera);
}

/// Where a session's pictures are taken, away from its thread: a camera's next one only when the last is
/// done. What is sure to look as the last one did is not taken again.
class PictureRoom {
 public:
  PictureRoom(ViewedRigPtr rig, Messenger& messenger, Background& background, ImageStreams& streams);

  /// Whether a picture of the camera is being taken for streams.
  [[nodiscard]] bool is_busy(std::size_t camera) const { return busy_.contains(camera); }
  /// Takes a picture and sends it to these streams of one camera.
  void show(const ValueShot& shot, const std::vector<ImageStreams::Key>& to, double now);
  /// What a pixel shows of the picture last sent to the client, or else of `newest`. A ViewRefusal
  /// when too many wait.
  void pixel(const ImageStreams::Key& key, const ValueShot& newest, int u, int v, Reply reply);
  /// The picture as PNG. False when too many wait.
  [[nodiscard]] bool file(const ValueShot& shot, std::function<void(HttpAnswer)> answer);
  /// A picture and what it shows.
  struct Shown {
    ValueShot shot;
    std::shared_ptr<const Picture> picture;
  };
  /// The picture last sent to the client; none before the first.
  [[nodiscard]] std::optional<Shown> last_sent(const ImageStreams::Key& key) const;
  void close(ClientId client);

 private:
  struct Tools;
  struct Sent;  // what a picture's streams get
  void deliver(const Sent& sent);

  ViewedRigPtr rig_;
  Messenger& messenger_;
  Background& background_;
  ImageStreams& streams_;
  std::shared_ptr<Tools> tools_;
  std::set<std::size_t> busy_;
  std::map<ImageStreams::Key, Shown> last_;
  int waiting_ = 0;  // files and pixels
  std::shared_ptr<const bool> alive_ = std::make_shared<const bool>(true);
};

}  // namespace flexura
