#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace flexura {

/// What waits to be sent to one client: texts in their order, all of them, and of each stream the newest
/// message.
class Outbox {
 public:
  struct Message {
    std::shared_ptr<const std::string> bytes;
    bool text = false;
  };

  /// How much text may wait.
  Outbox(std::size_t texts, std::size_t bytes) : texts_limit_(texts), bytes_limit_(bytes) {}

  /// Whether so little text waits that the client may ask for more: a quarter of what may.
  [[nodiscard]] bool has_room() const {
    return texts_.size() < texts_limit_ / 4 && text_bytes_ < bytes_limit_ / 4;
  }
  /// False when too much would wait: the client does not read.
  [[nodiscard]] bool push(std::string text);
  /// In place of an older message of the stream, which was not sent then.
  void post(std::uint32_t stream, std::shared_ptr<const std::string> message);
  /// The next message to send, until done(). A text after a message of a stream and the other way round,
  /// while there are both; streams take turns.
  std::optional<Message> next();
  /// What next() gave has been sent.
  void done();
  /// Of all messages, the one being sent among them.
  [[nodiscard]] std::size_t bytes() const { return text_bytes_ + stream_bytes_ + sending_bytes_; }
  /// Whether a message is being sent.
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
