#include "flexura/serve/http_session.h"

#include <algorithm>
#include <utility>

#include "flexura/serve/request_target.h"

namespace flexura {

namespace {

constexpr std::string_view end_of_head = "\r\n\r\n";

bool is_clean(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c >= ' ' && c != '\x7f'; });
}

/// Returns true if the browser reports a request from another server's page. Older browsers report nothing.
bool is_foreign(const RequestHead& head) {
  const std::string* site = head.find("sec-fetch-site");
  return site != nullptr && *site != "same-origin" && *site != "none";
}

/// 16 bytes in base64.
bool is_socket_key(std::string_view key) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  return key.size() == 24 && key.ends_with("==") && key.find_first_not_of(letters) == 22;
}

}  // namespace

HttpSession::HttpSession(const Site& site, std::string local) : site_(&site), local_(std::move(local)) {}

void HttpSession::feed(std::string_view bytes) { buffer_ += bytes; }

Step HttpSession::next() {
  std::optional<RequestHead> head;
  if (const int status = read_head(&head); status != 0) {
    last_ = true;
    return refusal(status, {}, last_);
  }
  if (!head) return ReadMore{};
  last_ = !head->keep_alive;
  has_shown_token_ = has_shown_token_ || site_->gate.has_token(*head);
  Step step = decide(*head);
  const bool is_let_in = std::holds_alternative<Question>(step) && site_->gate.has_bearer(*head);
  cookie_ = is_let_in ? "Set-Cookie: " + site_->gate.cookie(*head->find("host")) + "\r\n" : std::string();
  return step;
}

int HttpSession::read_head(std::optional<RequestHead>* head) {
  const std::size_t end = buffer_.find(end_of_head, looked_);
  const std::size_t length = end == std::string::npos ? buffer_.size() : end + end_of_head.size();
  if (length > site_->longest_header) return 431;
  if (end == std::string::npos) {
    looked_ = length - std::min(length, end_of_head.size() - 1);
    return 0;
  }
  auto parsed = parse_request_head(std::string_view(buffer_).substr(0, end));
  buffer_.erase(0, length);
  looked_ = 0;
  if (const auto* refused = std::get_if<Refusal>(&parsed)) return refused->status;
  *head = std::get<RequestHead>(std::move(parsed));
  return 0;
}

Step HttpSession::decide(const RequestHead& head) const {
  const std::string* host = head.find("host");
  if (host == nullptr || !site_->gate.knows_host(*host, local_)) return refusal(421, {}, last_);
  const std::string* origin = head.find("origin");
  if (origin != nullptr && !site_->gate.knows_origin(*origin, local_)) return refusal(403, {}, last_);
  const auto target = parse_request_target(head.target);
  if (!target) return refusal(400, {}, last_);
  // Assets are found by the path as received: there is one spelling.
  const std::string_view path = std::string_view(head.target).substr(0, head.target.find('?'));
  if (head.method != "GET") return refusal(405, "Allow: GET\r\n", last_);
  const auto asset = std::ranges::find(site_->assets, path == "/" ? "/index.html" : path, &Asset::path);
  if (asset != site_->assets.end()) return page(*asset);
  if (path == "/" || target->path.starts_with("/assets/")) return refusal(404, {}, last_);
  return secret(head, path);
}

Step HttpSession::secret(const RequestHead& head, std::string_view path) const {
  // Browsers send cookies to this server from pages of other ports too.
  if (is_foreign(head)) return refusal(403, {}, last_);
  if (!site_->gate.has_token(head)) return refusal(401, "WWW-Authenticate: Bearer\r\n", last_);
  if (path == "/socket") return upgrade(head);
  return Question{head.target};
}

Step HttpSession::upgrade(const RequestHead& head) const {
  if (!head.lists("connection", "upgrade") || !head.lists("upgrade", "websocket") || head.minor == 0) {
    return refusal(426, "Upgrade: websocket\r\n", last_);
  }
  const std::string* version = head.find("sec-websocket-version");
  if (version == nullptr || *version != "13") return refusal(426, "Sec-WebSocket-Version: 13\r\n", last_);
  const std::string* key = head.find("sec-websocket-key");
  // Nothing may be sent before the answer: it would belong to neither protocol.
  if (key == nullptr || !is_socket_key(*key) || !buffer_.empty()) return refusal(400, {}, last_);
  return Upgrade{*key};
}

Answer HttpSession::page(const Asset& asset) const {
  // Names under /assets/ contain a hash of their content.
  const bool hashed = asset.path.starts_with("/assets/");
  Answer answer;
  answer.fixed = asset.gzip;
  answer.last = last_;
  answer.head = format_head({.status = 200,
                             .content_type = asset.content_type,
                             .length = asset.gzip.size(),
                             .policy = {},
                             .cache = hashed ? "max-age=31536000, immutable" : "no-cache",
                             .more = "Content-Encoding: gzip\r\n",
                             .last = last_});
  return answer;
}

Answer HttpSession::format(HttpAnswer host) const {
  if (host.status < 200 || host.status > 599 || !is_clean(host.content_type) || !is_clean(host.policy)) {
    return refuse(500);
  }
  Answer answer;
  answer.head = format_head({.status = host.status,
                             .content_type = host.content_type,
                             .length = host.body.size(),
                             .policy = host.policy,
                             .cache = "no-store",
                             .more = cookie_,
                             .last = last_});
  if (host.status != 204 && host.status != 304) answer.body = std::move(host.body);
  answer.last = last_;
  return answer;
}

Answer HttpSession::refuse(int status) const { return refusal(status, {}, last_); }

}  // namespace flexura
