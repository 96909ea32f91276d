#include "flexura/serve/outbox.h"

#include <algorithm>

namespace flexura {

bool Outbox::push(std::string text) {
  if (texts_.size() >= texts_limit_ || text.size() > bytes_limit_ - text_bytes_) return false;
  text_bytes_ += text.size();
  texts_.push_back(std::move(text));
  return true;
}

void Outbox::post(std::uint32_t stream, std::shared_ptr<const std::string> message) {
  const auto place = std::ranges::find(streams_, stream,
                                       &std::pair<std::uint32_t, std::shared_ptr<const std::string>>::first);
  stream_bytes_ += message->size();
  if (place == streams_.end()) {
    streams_.emplace_back(stream, std::move(message));
  } else {
    stream_bytes_ -= place->second->size();
    place->second = std::move(message);
  }
}

std::optional<Outbox::Message> Outbox::next() {
  if (texts_.empty() && streams_.empty()) return std::nullopt;
  Message message;
  message.text = streams_.empty() || (!texts_.empty() && !text_last_);
  if (message.text) {
    text_bytes_ -= texts_.front().size();
    message.bytes = std::make_shared<const std::string>(std::move(texts_.front()));
    texts_.pop_front();
  } else {
    message.bytes = std::move(streams_.front().second);
    stream_bytes_ -= message.bytes->size();
    streams_.pop_front();
  }
  text_last_ = message.text;
  sending_bytes_ = message.bytes->size();
  return message;
}

void Outbox::done() { sending_bytes_ = 0; }

}  // namespace flexura
