// The only source that includes Boost.Beast, and only its WebSocket, without permessage-deflate. Beast's HTTP
// parser is not used: its iequals (1.74) reads a byte past its end. The request of the handshake consists of
// fixed texts here, which iequals compares without that byte.
#include "flexura/serve/server_client.h"

#include <boost/asio/buffer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

#include "flexura/base/utf8.h"

namespace flexura {

namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;

struct Server::Loop::Client::Stream {
  explicit Stream(tcp::socket tcp_socket) : socket(std::move(tcp_socket)) {}

  websocket::stream<tcp::socket, false> socket;
  beast::flat_buffer incoming;
};

Server::Loop::Client::Client(Loop& loop, ClientId id, tcp::socket socket)
    : outbox(loop.config_.waiting_texts, loop.config_.waiting_bytes),
      loop_(&loop),
      id_(id),
      stream_(std::make_unique<Stream>(std::move(socket))) {}

Server::Loop::Client::~Client() = default;

void Server::Loop::Client::accept(const Upgrade& how) {
  websocket::stream_base::timeout limits{};
  limits.handshake_timeout = loop_->config_.handshake;
  limits.idle_timeout = loop_->config_.idle;
  limits.keep_alive_pings = true;
  stream_->socket.set_option(limits);
  stream_->socket.set_option(websocket::stream_base::decorator(
      [](websocket::response_type& response) { response.set(beast::http::field::server, "flexura"); }));
  stream_->socket.read_message_max(loop_->config_.longest_message);
  stream_->socket.auto_fragment(false);
  beast::http::request<beast::http::empty_body> request(beast::http::verb::get, "/socket", 11);
  request.set(beast::http::field::host, "flexura");
  request.set(beast::http::field::connection, "upgrade");
  request.set(beast::http::field::upgrade, "websocket");
  request.set(beast::http::field::sec_websocket_key, how.key);
  request.set(beast::http::field::sec_websocket_version, "13");
  stream_->socket.async_accept(request, [self = shared_from_this()](ErrorCode error) {
    if (error) {
      self->end();
    } else {
      self->begin();
    }
  });
}

void Server::Loop::Client::begin() {
  open_ = true;
  loop_->host_->opened(id_);
  write();
  read();
}

void Server::Loop::Client::read() {
  if (reading_ || closing_ || !open_) return;
  {
    const std::lock_guard lock(loop_->mutex_);
    if (!outbox.has_room()) return;  // Data is being written: wrote() calls this again.
  }
  reading_ = true;
  stream_->socket.async_read(
      stream_->incoming, [self = shared_from_this()](ErrorCode error, std::size_t) { self->heard(error); });
}

void Server::Loop::Client::heard(const ErrorCode& error) {
  reading_ = false;
  const auto data = stream_->incoming.data();
  const std::string_view message(static_cast<const char*>(data.data()), data.size());
  if (error) {
    end();
  } else if (!stream_->socket.got_text()) {
    close(websocket::close_code::unknown_data);
  } else if (!is_utf8(message)) {
    // Beast 1.74 checks texts too, but accepts half a character if an empty frame ends the message.
    close(websocket::close_code::bad_payload);
  } else {
    loop_->host_->on_message(id_, std::string(message));
    stream_->incoming.consume(stream_->incoming.size());
    read();
  }
}

void Server::Loop::Client::close(int code) {
  closing_ = true;
  stream_->socket.async_close(websocket::close_reason(static_cast<std::uint16_t>(code)),
                              [self = shared_from_this()](ErrorCode) { self->end(); });
}

void Server::Loop::Client::write() {
  bool is_over = false;
  {
    const std::lock_guard lock(loop_->mutex_);
    is_over = overflowed;
    if (!is_over) {
      if (writing_ || closing_ || !open_) return;
      auto message = outbox.next();
      if (!message) return;
      sending_ = std::move(*message);
    }
  }
  if (is_over) {
    end();
    return;
  }
  writing_ = true;
  stream_->socket.text(sending_.text);
  stream_->socket.async_write(
      net::buffer(*sending_.bytes),
      [self = shared_from_this()](ErrorCode error, std::size_t) { self->wrote(error); });
}

void Server::Loop::Client::wrote(const ErrorCode& error) {
  {
    const std::lock_guard lock(loop_->mutex_);
    outbox.done();
  }
  sending_ = {};
  writing_ = false;
  if (error) {
    end();
  } else {
    write();
    read();
  }
}

void Server::Loop::Client::cut_off() {
  ErrorCode error;
  disregard(stream_->socket.next_layer().close(error));
}

void Server::Loop::Client::end() {
  cut_off();
  {
    const std::lock_guard lock(loop_->mutex_);
    loop_->clients_.erase(id_);
  }
  if (std::exchange(open_, false)) loop_->host_->closed(id_);
}

}  // namespace flexura
