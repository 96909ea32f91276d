#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "flexura/view/background.h"
#include "flexura/view/branch.h"
#include "flexura/view/extras.h"
#include "flexura/view/messenger.h"
#include "flexura/view/picture_session.h"
#include "flexura/view/recording.h"
#include "flexura/view/session.h"

namespace flexura {

/// Session with the recording of a run. Each client has its own time in the recording.
class RecordingSession : public PictureSession {
 public:
  RecordingSession(RecordingPtr recording, Messenger& messenger, Background& background);

  [[nodiscard]] Hello hello() const override;
  void opened(ClientId client) override;
  void closed(ClientId client) override;
  void take(ClientId client, const Ask& ask, Reply reply) override;
  void take(const Document& document, std::function<void(HttpAnswer)> answer) override;
  [[nodiscard]] RigInstant instant(ClientId client) override {
    return instant_at(*recording_, times_[client]);
  }
  void advance(double now) override;

  [[nodiscard]] const Recording& recording() const { return *recording_; }

 private:
  struct Taker;
  struct Table;  // Table of the series, used only on the lane of checks.

  [[nodiscard]] Look look(const ImageStreams::Key& key) override;
  void send_extras(ClientId client);
  void add_truth(double time, Extras& extras) const;
  void send_state(ClientId client);
  void show_state(const ImageStreams::Key& key, std::int64_t place);
  void send_image(const ImageStreams::Key& key, std::int64_t place);
  void send_no_image(const ImageStreams::Key& key, double time);
  void report_pixel(const ImageStreams::Key& key, int u, int v, Reply reply);
  /// Returns the number of the image shown at a time, s: its index among the camera's logged images;
  /// std::nullopt before the first image. For a camera without logged images, the result is the index of a
  /// state.
  [[nodiscard]] std::optional<std::int64_t> image_place(std::size_t camera, double time) const;
  /// Returns the number of the image shown at a time, s. Throws ViewRefusal if there is no image.
  [[nodiscard]] std::int64_t require_image(std::size_t camera, double time) const;
  [[nodiscard]] bool is_filmed(std::size_t camera) const { return recording_->images(camera) > 0; }
  [[nodiscard]] ValueShot shot(std::size_t camera, std::int64_t number) const;
  void give_image(const ImageAsk& ask, std::function<void(HttpAnswer)> answer);
  void give_series(const SeriesAsk& ask, std::function<void(HttpAnswer)> answer);
  void give_report(std::function<void(HttpAnswer)> answer);

  RecordingPtr recording_;
  std::shared_ptr<Table> table_;
  std::map<ClientId, double> times_;  // Time of each client in the recording, s.
  std::map<ClientId, std::optional<Conditioned>> reported_;
  std::uint32_t sequence_ = 0;
  double clock_ = 0;  // Time of advance(), s.
};

}  // namespace flexura
