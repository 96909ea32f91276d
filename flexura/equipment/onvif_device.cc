#include "flexura/equipment/onvif_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "flexura/base/bytes.h"
#include "flexura/equipment/onvif_answers.h"

namespace flexura {
namespace {

// Maps a position of one range to another one.
double mapped(double x, const OnvifRange& from, const OnvifRange& to) {
  return to.min + (x - from.min) / (from.max - from.min) * (to.max - to.min);
}

bool is_within(double x, const OnvifRange& range) { return x >= range.min && x <= range.max; }

// The fault that is sent on a connection instead of `whole`.
std::string faulty(OnvifFault fault, const std::string& whole) {
  switch (fault) {
    case OnvifFault::truncated:
    case OnvifFault::closes:
      return whole.substr(0, whole.size() / 2);
    case OnvifFault::garbage:
      return "\x01\x02 this is not HTTP\r\n\r\n";
    case OnvifFault::not_soap:
      return http_reply(200, "<html><body><p>Welcome</body></html>", true);
    case OnvifFault::huge:
      return http_reply(200, std::string((std::size_t{2} << 20), ' '), true);
    case OnvifFault::duplicate_headers:
      return http_reply(200, "<a/>", true, false, "Content-Length: 3\r\n");
    default:
      return whole;
  }
}

}  // namespace

double OnvifDevice::Axis::at(double now) const {
  const double way = to - from, done = rate * std::max(now - since, 0.0);
  return done >= std::abs(way) ? to : from + std::copysign(done, way);
}

OnvifDevice::OnvifDevice(OnvifModel model) : model_(std::move(model)) {
  axes_[2].from = axes_[2].to = model_.zoom.min;
}

void OnvifDevice::put(const OnvifPlace& place) {
  const std::array<double, 3> to = {place.pan, place.tilt, place.zoom.value_or(model_.zoom.min)};
  for (std::size_t i = 0; i < axes_.size(); ++i) axes_[i].from = axes_[i].to = to[i];
}

void OnvifDevice::fail(OnvifFault fault, std::size_t count) { fault_ = fault, faults_left_ = count; }

OnvifPlace OnvifDevice::place(double now) const {
  return {axes_[0].at(now), axes_[1].at(now), axes_[2].at(now)};
}

bool OnvifDevice::is_moving(double now) const {
  return !is_blocked_ &&
         std::ranges::any_of(axes_, [now](const Axis& axis) { return axis.at(now) != axis.to; });
}

void OnvifDevice::block(bool is_blocked, double now) {
  is_blocked_ = is_blocked;
  for (Axis& axis : axes_) axis.from = axis.to = axis.at(now);
}

std::size_t OnvifDevice::executed(std::string_view name) const {
  const auto found = executed_.find(name);
  return found == executed_.end() ? 0 : found->second;
}

void OnvifDevice::go(std::size_t axis, double to, double rate, double now) {
  if (!model_.obeys || is_blocked_) return;
  Axis& one = axes_[axis];
  one.from = one.at(now), one.to = to, one.since = now, one.rate = rate;
}

void OnvifDevice::halt(const OnvifRequest& request, double now) {
  for (std::size_t i = 0; i < axes_.size(); ++i)
    if (i == 2 ? request.stops_zoom : request.stops_turn) axes_[i].from = axes_[i].to = axes_[i].at(now);
}

std::vector<OnvifChunk> OnvifDevice::answer(const HttpMessage& request, double now) {
  OnvifChunk sent{now + model_.reply_delay, {}, !request.keeps_open};
  const auto asked = parse_onvif_request(request.body);
  Reply reply;
  constexpr int bad = 400, unauthorized = 401, no_method = 405;
  std::string headers;
  if (model_.wants_http_login) {
    reply = {unauthorized, {}};
    headers = "WWW-Authenticate: Digest realm=\"camera\", nonce=\"1\", qop=\"auth\"\r\n";
  } else if (request.method != "POST") {
    reply = {no_method, {}};
  } else if (!asked) {
    reply = {bad, soap_fault("WellFormed", "no request in the message")};
  } else {
    reply = reply_to(*asked, now);
    if (reply.status == 200) ++executed_[asked->name];
  }
  const OnvifFault fault = faults_left_ > 0 ? fault_ : OnvifFault::none;
  if (faults_left_ > 0) --faults_left_;
  const std::string whole =
      http_reply(reply.status, reply.soap, request.keeps_open, fault == OnvifFault::chunked, headers);
  if (fault == OnvifFault::silent) return {};
  if (fault == OnvifFault::closes || fault == OnvifFault::hangs_up || fault == OnvifFault::unmarked)
    sent.closes = true;
  if (fault == OnvifFault::hangs_up) return {sent};
  sent.bytes = fault == OnvifFault::unmarked ? "HTTP/1.1 200 OK\r\n\r\n" + reply.soap : faulty(fault, whole);
  if (fault != OnvifFault::in_pieces) return {sent};
  std::vector<OnvifChunk> pieces;
  for (const char c : sent.bytes) pieces.push_back({sent.at, std::string(1, c), false});
  pieces.back().closes = sent.closes;
  return pieces;
}

std::optional<OnvifDevice::Reply> OnvifDevice::login_fault(const OnvifRequest& request, double now) {
  if (model_.user.empty()) return std::nullopt;
  Reply refused{400, soap_fault("NotAuthorized", "Sender not authorized")};
  if (!request.token) return refused;
  const OnvifToken& token = *request.token;
  const auto created = parse_onvif_time(token.created);
  const auto nonce = from_base64(token.nonce);
  const double clock = model_.epoch + now;
  if (!created || !nonce || std::abs(*created - clock) > model_.most_age) return refused;
  if (token.user != model_.user || token.digest != onvif_digest(*nonce, token.created, model_.password))
    return refused;
  if (!model_.refuses_replays) return std::nullopt;
  // A signature counts once. Older ones are refused by their time.
  std::erase_if(nonces_, [&](const auto& one) { return one.second < clock - 2 * model_.most_age; });
  if (!nonces_.emplace(token.nonce, clock).second) return refused;
  return std::nullopt;
}

OnvifDevice::Reply OnvifDevice::reply_to(const OnvifRequest& request, double now) {
  const std::string& name = request.name;
  const auto good = [](const std::string& inside) { return Reply{200, soap_message(inside)}; };
  if (name == "GetSystemDateAndTime") return good(clock(now));
  if (name == "GetServices" && model_.has_services) return good(services());
  if (name == "GetCapabilities") return good(capabilities());
  if (const auto fixed = onvif_open_answer(name)) return good(*fixed);
  if (auto fault = login_fault(request, now)) return *std::move(fault);
  if (name == "GetNodes" || name == "GetNode") return good(nodes());
  if (name == "GetStatus") return good(status(now));
  if (const auto fixed = onvif_fixed_answer(name, model_.host)) return good(*fixed);
  const bool is_motion = name == "AbsoluteMove" || name == "ContinuousMove" || name == "Stop";
  if (!is_motion) return {500, soap_fault("ActionNotSupported", "the camera has no such request")};
  if (request.profile != onvif_fixed_profile) return {400, soap_fault("NoProfile", "no such profile")};
  if (name == "AbsoluteMove") return move(request, now);
  if (name == "ContinuousMove") return drive(request, now);
  halt(request, now);
  return good(onvif_empty_answer("Stop"));
}

OnvifDevice::Reply OnvifDevice::move(const OnvifRequest& request, double now) {
  if (model_.refuses) return {500, soap_fault("MovingPTZ", "The head\ncannot move now")};
  const bool is_degrees = request.turn_space == onvif_degree_space;
  if (!request.turn_space.empty() && request.turn_space != onvif_generic_space &&
      !(is_degrees && model_.has_degrees))
    return {400, soap_fault("SpaceNotSupported", "no such position space")};
  const auto generic = [&](const std::optional<double>& at, const OnvifRange& range,
                           const OnvifRange& degrees) {
    if (!at) return at;
    return std::optional(is_degrees ? mapped(*at, degrees, range) : *at);
  };
  const auto pan = generic(request.pan, model_.pan, model_.pan_degrees),
             tilt = generic(request.tilt, model_.tilt, model_.tilt_degrees);
  const auto fits = [](const std::optional<double>& at, const OnvifRange& range) {
    constexpr double rounding = 1e-6;
    return !at || is_within(*at, {range.min - rounding, range.max + rounding});
  };
  if (!fits(pan, model_.pan) || !fits(tilt, model_.tilt) || !fits(request.zoom, model_.zoom))
    return {400, soap_fault("InvalidPosition", "the position is out of bounds")};
  const double speed = std::clamp(request.speed.value_or(1), 0.0, 1.0);
  if (pan) go(0, *pan, model_.rates[0] * speed, now);
  if (tilt) go(1, *tilt, model_.rates[1] * speed, now);
  if (request.zoom && model_.has_zoom) go(2, *request.zoom, model_.rates[2] * speed, now);
  return {200, soap_message(onvif_empty_answer("AbsoluteMove"))};
}

OnvifDevice::Reply OnvifDevice::drive(const OnvifRequest& request, double now) {
  if (model_.refuses) return {500, soap_fault("MovingPTZ", "The head cannot move now")};
  constexpr double longest = 60;  // s
  const double time = std::min(request.timeout.value_or(longest), longest);
  const std::array<std::optional<double>, 3> speeds{request.pan, request.tilt, request.zoom};
  const std::array<OnvifRange, 3> ranges{model_.pan, model_.tilt, model_.zoom};
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    if (!speeds[i]) continue;
    const double rate = std::clamp(*speeds[i], -1.0, 1.0) * model_.rates[i];
    const double to = std::clamp(axes_[i].at(now) + rate * time, ranges[i].min, ranges[i].max);
    go(i, to, std::abs(rate), now);
  }
  return {200, soap_message(onvif_empty_answer("ContinuousMove"))};
}

std::string OnvifDevice::status(double now) const {
  OnvifPlace at = place(now);
  if (model_.reports_degrees) {
    at.pan = mapped(at.pan, model_.pan, model_.pan_degrees);
    at.tilt = mapped(at.tilt, model_.tilt, model_.tilt_degrees);
  }
  if (!model_.has_zoom) at.zoom.reset();
  const std::string_view space = model_.reports_degrees ? onvif_degree_space : onvif_generic_space;
  return onvif_status_answer(at, space, model_.reports_motion ? std::optional(is_moving(now)) : std::nullopt,
                             model_.epoch + now);
}

std::string OnvifDevice::clock(double now) const { return onvif_clock_answer(model_.epoch + now); }

std::string OnvifDevice::nodes() const {
  std::vector<OnvifSpace> turn{{std::string(onvif_generic_space), model_.pan, model_.tilt}};
  if (model_.has_degrees)
    turn.push_back({std::string(onvif_degree_space), model_.pan_degrees, model_.tilt_degrees});
  std::vector<OnvifSpace> zoom;
  if (model_.has_zoom) zoom.push_back({std::string(onvif_zoom_space), model_.zoom, {}});
  return onvif_nodes_answer(turn, zoom);
}

std::string OnvifDevice::services() const { return onvif_services_answer(model_.host); }
std::string OnvifDevice::capabilities() const { return onvif_capabilities_answer(model_.host); }

std::vector<OnvifChunk> OnvifStream::receive(std::string_view bytes, double now) {
  reader_.put(bytes);
  std::vector<OnvifChunk> sent;
  while (const auto request = reader_.next())
    std::ranges::move(device_.answer(*request, now), std::back_inserter(sent));
  if (!reader_.problem().empty()) sent.push_back({now, http_reply(400, {}, false), true});
  return sent;
}

}  // namespace flexura
