#include "flexura/serve/server_visit.h"

#include <algorithm>
#include <atomic>
#include <boost/asio/buffer.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <cstddef>
#include <mutex>
#include <utility>
#include <variant>

#include "flexura/serve/server_client.h"

namespace flexura {

namespace {

/// Returns the local address, with an IPv4-mapped IPv6 address as IPv4.
std::string local_address(const tcp::socket& socket) {
  ErrorCode error;
  const auto address = socket.local_endpoint(error).address();
  if (!address.is_v6() || !address.to_v6().is_v4_mapped()) return address.to_string();
  return net::ip::make_address_v4(net::ip::v4_mapped, address.to_v6()).to_string();
}

}  // namespace

/// Returns a host's answer to its connection, from any thread, even after the end of the server. Without an
/// answer it is a 500.
class Server::Loop::Reply {
 public:
  Reply(std::shared_ptr<net::io_context> context, std::weak_ptr<Visit> visit)
      : context_(std::move(context)), visit_(std::move(visit)) {}
  ~Reply() { give({.status = 500, .content_type = "text/plain", .body = {}, .policy = {}}); }
  Reply(const Reply&) = delete;
  Reply& operator=(const Reply&) = delete;

  void give(HttpAnswer answer) {
    if (given_.exchange(true)) return;
    net::post(*context_, [visit = visit_, answer = std::move(answer)]() mutable {
      if (const auto there = visit.lock()) there->answer(std::move(answer));
    });
  }

 private:
  std::shared_ptr<net::io_context> context_;
  std::weak_ptr<Visit> visit_;
  std::atomic<bool> given_ = false;
};

Server::Loop::Visit::Visit(Loop& loop, tcp::socket socket)
    : loop_(&loop),
      number_(++loop.last_visit_),
      session_(loop.site_, local_address(socket)),
      socket_(std::move(socket)),
      timer_(*loop.context_) {}

void Server::Loop::Visit::advance() {
  Step step = session_.next();
  if (auto* out = std::get_if<Answer>(&step)) {
    answer(std::move(*out));
  } else if (auto* question = std::get_if<Question>(&step)) {
    ask(std::move(question->target));
  } else if (const auto* how = std::get_if<Upgrade>(&step)) {
    upgrade(*how);
  } else {
    read();
  }
}

void Server::Loop::Visit::read() {
  socket_.async_read_some(net::buffer(bytes_),
                          [self = shared_from_this()](ErrorCode error, std::size_t count) {
                            if (error) {
                              self->end();
                            } else {
                              self->came(count);
                            }
                          });
}

void Server::Loop::Visit::came(std::size_t count) {
  if (!std::exchange(begun_, true)) deadline(loop_->config_.handshake);
  session_.feed({bytes_.data(), count});
  advance();
}

void Server::Loop::Visit::answer(Answer answer) {
  answer_ = std::move(answer);
  const std::array<net::const_buffer, 3> parts = {net::buffer(answer_.head), net::buffer(answer_.body),
                                                  net::buffer(answer_.fixed.data(), answer_.fixed.size())};
  const auto progress = [self = shared_from_this()](const ErrorCode& error, std::size_t) -> std::size_t {
    self->deadline(self->loop_->config_.idle);
    return error ? 0 : std::size_t{64} * 1024;
  };
  net::async_write(socket_, parts, progress, [self = shared_from_this()](ErrorCode error, std::size_t) {
    if (error) {
      self->end();
    } else if (self->answer_.last) {
      self->linger();
    } else {
      self->rest();
    }
  });
}

/// After an answer: the next request may have begun already.
void Server::Loop::Visit::rest() {
  answer_ = {};
  begun_ = session_.begun();
  deadline(begun_ ? loop_->config_.handshake : loop_->config_.idle);
  advance();
}

/// Reads and discards remaining bytes: closing a socket with unread bytes may lose the answer.
void Server::Loop::Visit::linger() {
  ErrorCode error;
  disregard(socket_.shutdown(tcp::socket::shutdown_send, error));
  deadline(std::min(loop_->config_.handshake, std::chrono::milliseconds(1000)));
  read_over();
}

void Server::Loop::Visit::read_over() {
  socket_.async_read_some(net::buffer(bytes_), [self = shared_from_this()](ErrorCode error, std::size_t) {
    if (error) {
      self->end();
    } else {
      self->read_over();
    }
  });
}

void Server::Loop::Visit::ask(std::string target) {
  timer_.expires_at(net::steady_timer::time_point::max());
  const auto reply = std::make_shared<Reply>(loop_->context_, weak_from_this());
  loop_->host_->asked(std::move(target), [reply](HttpAnswer answer) { reply->give(std::move(answer)); });
}

void Server::Loop::Visit::upgrade(const Upgrade& how) {
  const ClientId id = loop_->last_client_ + 1;
  std::shared_ptr<Client> client;
  {
    const std::lock_guard lock(loop_->mutex_);
    if (loop_->clients_.size() < loop_->config_.clients) {
      client = std::make_shared<Client>(*loop_, id, std::move(socket_));
      loop_->clients_.emplace(id, client);
    }
  }
  if (client == nullptr) {
    answer(session_.refuse(503));
  } else {
    loop_->last_client_ = id;
    end();
    client->accept(how);
  }
}

void Server::Loop::Visit::deadline(std::chrono::milliseconds limit) {
  timer_.expires_after(limit);
  timer_.async_wait([self = shared_from_this()](ErrorCode error) {
    // A timer that expired before it was extended also arrives here.
    if (!error && self->timer_.expiry() <= net::steady_timer::clock_type::now()) self->end();
  });
}

void Server::Loop::Visit::close() {
  ErrorCode error;
  disregard(socket_.close(error));
}

void Server::Loop::Visit::end() {
  close();
  timer_.cancel();
  loop_->visits_.erase(shared_from_this());
}

}  // namespace flexura
