#include "tests/support/raw_client.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <stdexcept>
#include <utility>

#include "flexura/serve/request_head.h"

namespace flexura {

int RawFrame::close_code() const {
  if (opcode != 8 || payload.size() < 2) return 0;
  return static_cast<unsigned char>(payload[0]) * 256 + static_cast<unsigned char>(payload[1]);
}

RawClient::RawClient(std::uint16_t port, int receive_buffer, const char* address)
    : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
  if (receive_buffer > 0)
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
  constexpr timeval patience{30, 0};
  ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  sockaddr_in peer{};
  peer.sin_family = AF_INET;
  peer.sin_port = htons(port);
  ::inet_pton(AF_INET, address, &peer.sin_addr);
  if (::connect(socket_, reinterpret_cast<const sockaddr*>(&peer), sizeof peer) != 0) {
    ::close(socket_);
    throw std::runtime_error("no connection");
  }
}

RawClient::~RawClient() {
  if (socket_ >= 0) ::close(socket_);
}

RawClient::RawClient(RawClient&& other) noexcept
    : socket_(std::exchange(other.socket_, -1)), buffer_(std::move(other.buffer_)) {}

bool RawClient::send(std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t count = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

void RawClient::end_sending() const { ::shutdown(socket_, SHUT_WR); }

RawAnswer RawClient::read_answer() {
  std::size_t end = std::string::npos;
  while ((end = buffer_.find("\r\n\r\n")) == std::string::npos) {
    if (!read_more()) throw std::runtime_error("no answer, but: " + buffer_);
  }
  RawAnswer answer;
  answer.head = take(end + 4);
  answer.status = std::stoi(answer.head.substr(answer.head.find(' ') + 1, 3));
  for (std::size_t at = answer.head.find("\r\n") + 2; at < end;) {
    const std::size_t stop = answer.head.find("\r\n", at);
    const std::string line = answer.head.substr(at, stop - at);
    const std::size_t colon = line.find(':');
    answer.fields[in_lower_case(line.substr(0, colon))] = trimmed(std::string_view(line).substr(colon + 1));
    at = stop + 2;
  }
  const std::size_t length =
      answer.fields.contains("content-length") ? std::stoul(answer.fields["content-length"]) : 0;
  if (!have(length)) throw std::runtime_error("half an answer");
  answer.body = take(length);
  return answer;
}

RawFrame RawClient::read_frame() {
  if (!have(2)) return {};
  RawFrame frame;
  frame.opcode = buffer_[0] & 0x0F;
  std::size_t length = buffer_[1] & 0x7F;
  const std::size_t extra = (length == 126 ? 2 : 0) + (length == 127 ? 8 : 0);
  if (!have(2 + extra)) return {};
  take(2);
  if (extra > 0) length = 0;
  for (const char byte : take(extra)) length = length * 256 + static_cast<unsigned char>(byte);
  if (!have(length)) return {};
  frame.payload = take(length);
  return frame;
}

std::string RawClient::read_to_end() {
  while (read_more()) {
  }
  return std::exchange(buffer_, {});
}

bool RawClient::send_frame(std::uint8_t first, std::string_view payload) const {
  std::string frame(1, static_cast<char>(first));
  if (payload.size() < 126) {
    frame.push_back(static_cast<char>(0x80U | payload.size()));
  } else {
    const int bytes = payload.size() < 65536 ? 2 : 8;
    frame.push_back(static_cast<char>(bytes == 2 ? 0xFE : 0xFF));
    for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8)
      frame.push_back(static_cast<char>(payload.size() >> shift));
  }
  constexpr std::string_view mask = "\x12\x34\x56\x78";
  frame += mask;
  for (std::size_t i = 0; i < payload.size(); ++i)
    frame.push_back(static_cast<char>(payload[i] ^ mask[i % 4]));
  return send(frame);
}

bool RawClient::read_more() {
  std::array<char, 16384> bytes{};
  const ssize_t count = ::recv(socket_, bytes.data(), bytes.size(), 0);
  if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK))
    throw std::runtime_error("nothing came for long");
  if (count <= 0) return false;
  buffer_.append(bytes.data(), static_cast<std::size_t>(count));
  return true;
}

bool RawClient::have(std::size_t count) {
  while (buffer_.size() < count) {
    if (!read_more()) return false;
  }
  return true;
}

std::string RawClient::take(std::size_t count) {
  std::string taken = buffer_.substr(0, count);
  buffer_.erase(0, count);
  return taken;
}

}  // namespace flexura
