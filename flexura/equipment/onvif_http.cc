#include "flexura/equipment/onvif_http.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <cstdint>
#include <variant>

namespace flexura {
namespace {

namespace http = boost::beast::http;

constexpr std::uint32_t most_header = 16 * 1024;
constexpr std::uint64_t most_body = 1024UL * 1024;

template <class Parser>
void set_limits(Parser& parser) {
  parser.header_limit(most_header);
  parser.body_limit(most_body);
  // In one step, Beast 1.74 would forget that a body is too long.
  parser.eager(false);
}

template <class Head>
HttpMessage http_message(Head& message, bool is_delimited) {
  HttpMessage made;
  made.keeps_open = message.keep_alive() && is_delimited;
  made.is_delimited = is_delimited;
  for (const auto& field : message)
    if (field.name() == http::field::www_authenticate)
      made.authenticate += (made.authenticate.empty() ? "" : ", ") + std::string(field.value());
  made.body = std::move(message.body());
  return made;
}

}  // namespace

class HttpReader::Parser {
 public:
  explicit Parser(Side side) : side_(side) { begin(); }

  void put(std::string_view bytes) {
    if (problem.empty()) bytes_ += bytes;
  }
  void close() { is_closed_ = true; }

  std::optional<HttpMessage> next() {
    for (;;) {
      if (!problem.empty()) return std::nullopt;
      const bool is_done =
          side_ == Side::requests ? step(std::get<Request>(parser_)) : step(std::get<Reply>(parser_));
      if (!is_done) return std::nullopt;
      HttpMessage message = take();
      begin();
      constexpr int first_final = 200;
      if (side_ == Side::replies && message.status < first_final) continue;
      return message;
    }
  }

  std::string problem;

 private:
  using Request = http::request_parser<http::string_body>;
  using Reply = http::response_parser<http::string_body>;

  void begin() {
    if (side_ == Side::requests) {
      set_limits(parser_.emplace<Request>());
    } else {
      set_limits(parser_.emplace<Reply>());
    }
  }

  // Returns whether a message is complete.
  template <class P>
  bool step(P& parser) {
    boost::system::error_code error;
    std::string_view rest = bytes_;
    while (!parser.is_done() && !rest.empty() && problem.empty()) {
      const std::size_t used = parser.put(boost::asio::buffer(rest.data(), rest.size()), error);
      rest.remove_prefix(used);
      if (error && error != http::error::need_more) problem = error.message();
      if (used == 0) break;
    }
    bytes_.erase(0, bytes_.size() - rest.size());
    if (!problem.empty()) return false;
    error = {};
    if (!parser.is_done() && is_closed_ && parser.got_some()) {
      parser.put_eof(error);
      if (error) problem = "it ends too early";
      return !error && parser.is_done();
    }
    return parser.is_done();
  }

  HttpMessage take() {
    if (auto* request = std::get_if<Request>(&parser_)) {
      auto message = request->release();
      const std::string method(message.method_string()), target(message.target());
      HttpMessage made = http_message(message, true);
      made.method = method, made.target = target;
      return made;
    }
    auto& reply = std::get<Reply>(parser_);
    const bool is_delimited = reply.chunked() || reply.content_length().has_value();
    auto message = reply.release();
    const auto status = static_cast<int>(message.result_int());
    HttpMessage made = http_message(message, is_delimited);
    made.status = status;
    return made;
  }

  Side side_;
  std::variant<std::monostate, Request, Reply> parser_;
  std::string bytes_;
  bool is_closed_ = false;
};

HttpReader::HttpReader(Side side) : parser_(std::make_unique<Parser>(side)) {}
HttpReader::~HttpReader() = default;
HttpReader::HttpReader(HttpReader&&) noexcept = default;
HttpReader& HttpReader::operator=(HttpReader&&) noexcept = default;
void HttpReader::put(std::string_view bytes) { parser_->put(bytes); }
void HttpReader::close() { parser_->close(); }
std::optional<HttpMessage> HttpReader::next() { return parser_->next(); }
const std::string& HttpReader::problem() const { return parser_->problem; }

std::string http_post(std::string_view host, std::string_view path, std::string_view soap, bool keeps_open) {
  return fmt::format(
      "POST {} HTTP/1.1\r\nHost: {}\r\nContent-Type: application/soap+xml; charset=utf-8\r\n"
      "Content-Length: {}\r\nConnection: {}\r\n\r\n{}",
      path, host, soap.size(), keeps_open ? "keep-alive" : "close", soap);
}

std::string http_reply(int status, std::string_view soap, bool keeps_open, bool is_chunked,
                       std::string_view headers) {
  const std::string reason(http::obsolete_reason(static_cast<http::status>(status)));
  std::string text = fmt::format(
      "HTTP/1.1 {} {}\r\nContent-Type: application/soap+xml; charset=utf-8\r\nConnection: {}\r\n{}", status,
      reason, keeps_open ? "keep-alive" : "close", headers);
  if (!is_chunked) return text + fmt::format("Content-Length: {}\r\n\r\n{}", soap.size(), soap);
  text += "Transfer-Encoding: chunked\r\n\r\n";
  constexpr std::size_t piece = 100;
  for (; !soap.empty(); soap.remove_prefix(std::min(piece, soap.size())))
    text += fmt::format("{:x}\r\n{}\r\n", std::min(piece, soap.size()), soap.substr(0, piece));
  return text + "0\r\n\r\n";
}

}  // namespace flexura
