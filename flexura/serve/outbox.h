#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace flexura {

/// Messages that wait for one client: all texts in their order, and the newest message of each stream.
class Outbox {
 public:
  struct Message {
    std::shared_ptr<const std::string> bytes;
    bool text = false;
  };

  /// `texts`, `bytes`: largest number and total size of waiting texts.
  Outbox(std::size_t texts, std::size_t bytes) : texts_limit_(texts), bytes_limit_(bytes) {}

  /// Returns true if the client may send further requests, because the waiting texts are below a quarter of
  /// both limits.
  [[nodiscard]] bool has_room() const {
    return texts_.size() < texts_limit_ / 4 && text_bytes_ < bytes_limit_ / 4;
  }
  /// Adds a text. Returns false if the waiting texts exceed a limit, because the client does not read them.
  [[nodiscard]] bool push(std::string text);
  /// Sets the newest message of a stream, which replaces an older message that was not sent.
  void post(std::uint32_t stream, std::shared_ptr<const std::string> message);
  /// Returns the next message to send; call done() after it was sent. If both texts and messages of streams
  /// are waiting, they alternate. Different streams alternate too.
  std::optional<Message> next();
  /// Reports that the message from next() was sent.
  void done();
  /// Returns the number of bytes of all messages, including the one being sent.
  [[nodiscard]] std::size_t bytes() const { return text_bytes_ + stream_bytes_ + sending_bytes_; }
  /// Returns true if a message is being sent.
  [[nodiscard]] bool is_sending() const { return sending_bytes_ > 0; }

 private:
  std::size_t texts_limit_;
  std::size_t bytes_limit_;
  std::deque<std::string> texts_;
  std::deque<std::pair<std::uint32_t, std::shared_ptr<const std::string>>> streams_;
  std::size_t text_bytes_ = 0;
  std::size_t stream_bytes_ = 0;
  std::size_t sending_bytes_ = 0;
  bool text_last_ = false;
};

}  // namespace flexura
