#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace flexura {

/// A raw HTTP answer.
struct RawAnswer {
  int status = 0;
  std::map<std::string, std::string>
      fields;  ///< Header fields by lower-case name; the last value of repeated ones.
  std::string head;
  std::string body;
};

/// A raw WebSocket frame.
struct RawFrame {
  int opcode = 0;  ///< 1 text, 2 binary, 8 close, 9 ping, 10 pong; 0 after the end of the connection.
  std::string payload;
  /// Returns the code of a close frame; 0 if there is no code.
  [[nodiscard]] int close_code() const;
};

/// A TCP connection to a local server, for tests: sends any bytes and reads the answers. Throws
/// std::runtime_error if an expected answer does not arrive within half a minute.
class RawClient {
 public:
  /// `receive_buffer`: size of the system's receive buffer; 0 for the default. `address`: IPv4.
  explicit RawClient(std::uint16_t port, int receive_buffer = 0, const char* address = "127.0.0.1");
  ~RawClient();
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;
  RawClient(RawClient&& other) noexcept;
  RawClient& operator=(RawClient&&) = delete;

  /// Sends bytes. Returns false if the other side no longer accepts them.
  bool send(std::string_view bytes) const;
  /// Closes the sending direction.
  void end_sending() const;
  RawAnswer read_answer();
  RawFrame read_frame();
  /// Reads until the other side closes.
  std::string read_to_end();

  /// Sends a masked frame. `first` as in the protocol: 0x81 a complete text, 0x82 complete binary data, 0x01
  /// the beginning of a text, and so on.
  bool send_frame(std::uint8_t first, std::string_view payload) const;
  bool send_text(std::string_view text) const { return send_frame(0x81, text); }

 private:
  /// Reads more bytes into buffer_; returns false at the end.
  bool read_more();
  bool have(std::size_t count);
  std::string take(std::size_t count);

  int socket_;
  std::string buffer_;
};

}  // namespace flexura
