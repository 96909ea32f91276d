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

/// Number of the stream with state messages (Messenger::post). Images of camera i use the stream 1 + i.
inline constexpr std::uint32_t state_stream = 0;
[[nodiscard]] inline std::uint32_t image_stream(std::size_t camera) {
  return 1 + static_cast<std::uint32_t>(camera);
}

/// Renders a session's pictures outside the session's thread. A camera's next picture is rendered only after
/// its previous picture is complete. A picture that is certainly equal to the previous one is not rendered
/// again.
class PictureRoom {
 public:
  PictureRoom(ViewedRigPtr rig, Messenger& messenger, Background& background, ImageStreams& streams);

  /// Returns whether a picture of this camera is being rendered for streams.
  [[nodiscard]] bool is_busy(std::size_t camera) const { return busy_.contains(camera); }
  /// Renders a picture of one camera and sends the picture to the streams `to`.
  void show(const ValueShot& shot, const std::vector<ImageStreams::Key>& to, double now);
  /// Answers what a pixel shows in the last picture sent to the client. If no picture was sent yet, answers
  /// for the picture `newest`. Throws ViewRefusal if too many requests are waiting.
  void pixel(const ImageStreams::Key& key, const ValueShot& newest, int u, int v, Reply reply);
  /// Answers with the picture in PNG format. Returns false if too many requests are waiting.
  [[nodiscard]] bool file(const ValueShot& shot, std::function<void(HttpAnswer)> answer);
  /// A picture, and the shot from which it was rendered.
  struct Shown {
    ValueShot shot;
    std::shared_ptr<const Picture> picture;
  };
  /// Returns the last picture sent to the client; std::nullopt if no picture was sent yet.
  [[nodiscard]] std::optional<Shown> last_sent(const ImageStreams::Key& key) const;
  void close(ClientId client);

 private:
  struct Tools;
  struct Sent;  // Data for the streams of a picture.
  void deliver(const Sent& sent);

  ViewedRigPtr rig_;
  Messenger& messenger_;
  Background& background_;
  ImageStreams& streams_;
  std::shared_ptr<Tools> tools_;
  std::set<std::size_t> busy_;
  std::map<ImageStreams::Key, Shown> last_;
  int waiting_ = 0;  // Number of waiting file and pixel requests.
  std::shared_ptr<const bool> alive_ = std::make_shared<const bool>(true);
};

}  // namespace flexura
