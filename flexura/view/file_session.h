#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "flexura/view/background.h"
#include "flexura/view/image_streams.h"
#include "flexura/view/latest_jobs.h"
#include "flexura/view/messenger.h"
#include "flexura/view/session.h"
#include "flexura/vision/picture_file.h"

namespace flexura {

/// A picture file that clients view.
struct ViewedPicture {
  std::string name;  ///< Name for clients, which calls the picture a camera. All names are different.
  std::shared_ptr<const Photograph> photograph;  ///< The picture, never null.
};

/// Largest number of picture files in a session.
inline constexpr std::size_t most_viewed_pictures = 64;
/// Largest width and height of a viewed picture, px. Browsers draw no larger ones.
inline constexpr int most_viewed_side = 32767;

/// Session with picture files. There is no rig: clients can only see and measure the pictures.
class FileSession : public Session {
 public:
  /// Throws std::invalid_argument for too many or too large pictures.
  FileSession(std::vector<ViewedPicture> pictures, Messenger& messenger, Background& background);

  [[nodiscard]] Hello hello() const override;
  void opened(ClientId client) override;
  void closed(ClientId client) override;
  void take(ClientId client, const Ask& ask, Reply reply) override;
  void take(const Document& document, std::function<void(HttpAnswer)> answer) override;
  [[nodiscard]] RigInstant instant(ClientId client) override;
  void advance(double now) override;

 private:
  struct Taker;
  [[nodiscard]] std::size_t place_of(const std::string& name) const;
  void show(const ImageStreams::Key& key, double now);

  std::vector<ViewedPicture> pictures_;
  Messenger& messenger_;
  Background& background_;
  ImageStreams streams_;
  LatestJobs measures_, colors_;
  std::set<ClientId> clients_;
  std::shared_ptr<const bool> alive_ = std::make_shared<const bool>(true);
};

}  // namespace flexura
