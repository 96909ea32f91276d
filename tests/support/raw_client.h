#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace flexura {

/// An HTTP answer as it came.
struct RawAnswer {
  int status = 0;
  std::map<std::string, std::string> fields;  ///< By name in lower case; of several the last.
  std::string head;
  std::string body;
};

/// A WebSocket frame as it came.
struct RawFrame {
  int opcode = 0;  ///< 1 text, 2 binary, 8 close, 9 ping, 10 pong; 0 when the connection has ended.
  std::string payload;
  /// Of a close frame; 0 without.
  [[nodiscard]] int close_code() const;
};

/// A TCP connection to a server of this machine, for tests: sends any bytes, reads what comes. What does not
/// come within half a minute throws std::runtime_error.
class RawClient {
 public:
  /// `receive_buffer`: what the system holds for a client that does not read; 0 for its usual. `address`:
  /// IPv4.
  explicit RawClient(std::uint16_t port, int receive_buffer = 0, const char* address = "127.0.0.1");
  ~RawClient();
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;
  RawClient(RawClient&& other) noexcept;
  RawClient& operator=(RawClient&&) = delete;

  /// False when the other side does not take it any more.
  bool send(std::string_view bytes) const;
  /// No more will be sent.
  void end_sending() const;
  RawAnswer read_answer();
  RawFrame read_frame();
  /// All that comes until the other side closes.
  std::string read_to_end();

  /// A masked frame; `first` as in the protocol: 0x81 a whole text, 0x82 whole bytes, 0x01 a text's beginning
  /// ...
  bool send_frame(std::uint8_t first, std::string_view payload) const;
  bool send_text(std::string_view text) const { return send_frame(0x81, text); }

 private:
  /// More bytes into buffer_; false at the end.
  bool read_more();
  bool have(std::size_t count);
  std::string take(std::size_t count);

  int socket_;
  std::string buffer_;
};

}  // namespace flexura
