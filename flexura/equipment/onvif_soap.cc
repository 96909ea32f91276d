#include "flexura/equipment/onvif_soap.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/uuid/detail/sha1.hpp>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <pugixml.hpp>

#include "flexura/base/bytes.h"

namespace flexura {
namespace {

std::string_view local_name(const pugi::xml_node& node) {
  const std::string_view name = node.name();
  return name.substr(name.rfind(':') + 1);  // npos + 1 is 0.
}

pugi::xml_node child(const pugi::xml_node& node, std::string_view name) {
  for (const pugi::xml_node one : node.children())
    if (one.type() == pugi::node_element && local_name(one) == name) return one;
  return {};
}

template <class... More>
pugi::xml_node child(const pugi::xml_node& node, std::string_view name, More... more) {
  return child(child(node, name), more...);
}

std::vector<pugi::xml_node> children(const pugi::xml_node& node, std::string_view name) {
  std::vector<pugi::xml_node> found;
  for (const pugi::xml_node one : node.children())
    if (one.type() == pugi::node_element && local_name(one) == name) found.push_back(one);
  return found;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string_view text_of(const pugi::xml_node& node) { return trimmed(node.child_value()); }

std::optional<double> finite_number(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<int> whole_number(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// A SOAP message and its body.
struct Soap {
  explicit Soap(std::string_view text) {
    // Without comments, instructions and document types: nothing is expanded or loaded.
    if (!document.load_buffer(text.data(), text.size(), pugi::parse_default)) return;
    envelope = child(document, "Envelope");
    body = child(envelope, "Body");
  }
  [[nodiscard]] pugi::xml_node answer(std::string_view name) const { return child(body, name); }
  pugi::xml_document document;
  pugi::xml_node envelope, body;
};

std::optional<double> utc_seconds(int year, int month, int day, int hour, int minute, double second) {
  using std::chrono::year_month_day;
  const year_month_day date{std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                            std::chrono::day(static_cast<unsigned>(day))};
  if (year < 1970 || year > 9999 || month < 0 || day < 0 || !date.ok()) return std::nullopt;
  const bool is_second = second >= 0 && second < 61;  // False if it is not a number.
  if (hour < 0 || hour > 23 || minute < 0 || minute > 59 || !is_second) return std::nullopt;
  const auto days = std::chrono::sys_days(date).time_since_epoch().count();
  return 86400.0 * static_cast<double>(days) + 3600.0 * hour + 60.0 * minute + second;
}

// An address without its host. Devices behind a router report the host that they know, which may be wrong.
std::string path_of(std::string_view address) {
  if (const std::size_t scheme = address.find("://"); scheme != std::string_view::npos) {
    const std::size_t path = address.find('/', scheme + 3);
    address = path == std::string_view::npos ? "/" : address.substr(path);
  }
  const bool is_clean =
      address.starts_with('/') && std::ranges::all_of(address, [](char c) { return c > ' ' && c < '\x7f'; });
  return is_clean ? std::string(address) : std::string();
}

std::optional<OnvifRange> range_of(const pugi::xml_node& node) {
  const auto min = finite_number(text_of(child(node, "Min"))),
             max = finite_number(text_of(child(node, "Max")));
  if (!min || !max || *min > *max) return std::nullopt;
  return OnvifRange{*min, *max};
}

std::vector<OnvifSpace> spaces_of(const pugi::xml_node& spaces, std::string_view name, bool has_y) {
  std::vector<OnvifSpace> found;
  for (const pugi::xml_node& one : children(spaces, name)) {
    const auto x = range_of(child(one, "XRange"));
    const auto y = has_y ? range_of(child(one, "YRange")) : OnvifRange{};
    if (x && y) found.push_back({std::string(text_of(child(one, "URI"))), *x, *y});
  }
  return found;
}

std::optional<double> attribute(const pugi::xml_node& node, const char* name) {
  return finite_number(node.attribute(name).value());
}

// A duration such as PT10S or PT1M0.5S; only minutes and seconds.
std::optional<double> duration_of(std::string_view text) {
  if (!text.starts_with("PT")) return std::nullopt;
  text.remove_prefix(2);
  double total = 0;
  for (const auto& [unit, factor] : {std::pair('M', 60.0), std::pair('S', 1.0)}) {
    const std::size_t end = text.find(unit);
    if (end == std::string_view::npos) continue;
    const auto value = finite_number(text.substr(0, end));
    if (!value || *value < 0) return std::nullopt;
    total += factor * *value;
    text.remove_prefix(end + 1);
  }
  return text.empty() ? std::optional(total) : std::nullopt;
}

std::string escaped(std::string_view text) {
  std::string made;
  for (const char c : text) {
    switch (c) {
      case '&':
        made += "&amp;";
        break;
      case '<':
        made += "&lt;";
        break;
      case '>':
        made += "&gt;";
        break;
      case '"':
        made += "&quot;";
        break;
      default:
        made += c;
    }
  }
  return made;
}

constexpr std::string_view ptz_names = "http://www.onvif.org/ver20/ptz/wsdl";
constexpr std::string_view media_names = "http://www.onvif.org/ver10/media/wsdl";
constexpr std::string_view device_names = "http://www.onvif.org/ver10/device/wsdl";

std::string call(std::string_view name, std::string_view names, std::string_view inside = {}) {
  return fmt::format("<{0} xmlns=\"{1}\">{2}</{0}>", name, names, inside);
}

std::string profile_token(std::string_view profile) {
  return fmt::format("<ProfileToken>{}</ProfileToken>", escaped(profile));
}

}  // namespace

std::string onvif_digest(std::string_view nonce, std::string_view created, std::string_view password) {
  boost::uuids::detail::sha1 sha;
  for (const std::string_view part : {nonce, created, password}) sha.process_bytes(part.data(), part.size());
  boost::uuids::detail::sha1::digest_type words;
  sha.get_digest(words);
  std::string bytes;
  // Words of 32 bits; bytes from Boost 1.86 on.
  for (const auto word : words)
    for (std::size_t shift = 8 * sizeof word; shift > 0; shift -= 8)
      bytes += static_cast<char>(static_cast<std::uint32_t>(word) >> (shift - 8));
  return base64(bytes);
}

std::string onvif_time_text(double time) {
  constexpr double last = 253402300799;  // End of the year 9999.
  const auto ms = static_cast<std::int64_t>(std::floor(1000 * std::clamp(time, 0.0, last)));
  const std::chrono::sys_days day{std::chrono::days(ms / 86400000)};
  const std::chrono::year_month_day date(day);
  const auto rest = ms % 86400000;
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}Z", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()), rest / 3600000,
                     rest / 60000 % 60, rest / 1000 % 60, rest % 1000);
}

std::optional<double> parse_onvif_time(std::string_view text) {
  constexpr std::string_view pattern = "dddd-dd-ddTdd:dd:dd";
  if (text.size() < pattern.size() + 1 || !text.ends_with('Z')) return std::nullopt;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    const bool is_digit = text[i] >= '0' && text[i] <= '9';
    if (pattern[i] == 'd' ? !is_digit : text[i] != pattern[i]) return std::nullopt;
  }
  const auto part = [&](std::size_t at, std::size_t size) { return *whole_number(text.substr(at, size)); };
  const std::string_view seconds = text.substr(17, text.size() - 18);
  const auto second = finite_number(seconds);
  if (!second || seconds.find_first_not_of("0123456789.") != std::string_view::npos) return std::nullopt;
  return utc_seconds(part(0, 4), part(5, 2), part(8, 2), part(11, 2), part(14, 2), *second);
}

std::string soap_message(std::string_view body, const std::optional<OnvifToken>& token) {
  std::string header;
  if (token) {
    constexpr std::string_view oasis = "http://docs.oasis-open.org/wss/2004/01/oasis-200401-wss-";
    header = fmt::format(
        "<s:Header><Security s:mustUnderstand=\"1\" xmlns=\"{0}wssecurity-secext-1.0.xsd\"><UsernameToken>"
        "<Username>{1}</Username>"
        "<Password Type=\"{0}username-token-profile-1.0#PasswordDigest\">{2}</Password>"
        "<Nonce EncodingType=\"{0}soap-message-security-1.0#Base64Binary\">{3}</Nonce>"
        "<Created xmlns=\"{0}wssecurity-utility-1.0.xsd\">{4}</Created>"
        "</UsernameToken></Security></s:Header>",
        oasis, escaped(token->user), token->digest, token->nonce, token->created);
  }
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>"
      "<s:Envelope xmlns:s=\"http://www.w3.org/2003/05/soap-envelope\">{}<s:Body>{}</s:Body></s:Envelope>",
      header, body);
}

std::string onvif_ask_time() { return call("GetSystemDateAndTime", device_names); }
std::string onvif_ask_services() {
  return call("GetServices", device_names, "<IncludeCapability>false</IncludeCapability>");
}
std::string onvif_ask_capabilities() {
  return call("GetCapabilities", device_names, "<Category>All</Category>");
}
std::string onvif_ask_profiles() { return call("GetProfiles", media_names); }
std::string onvif_ask_nodes() { return call("GetNodes", ptz_names); }
std::string onvif_ask_status(std::string_view profile) {
  return call("GetStatus", ptz_names, profile_token(profile));
}

std::string onvif_move(std::string_view profile, const OnvifPlace& place, std::string_view space,
                       const std::optional<double>& speed) {
  constexpr std::string_view schema = "xmlns=\"http://www.onvif.org/ver10/schema\"";
  std::string position = fmt::format("<PanTilt {} x=\"{:.6g}\" y=\"{:.6g}\" space=\"{}\"/>", schema,
                                     place.pan, place.tilt, space);
  std::string speeds;
  if (speed) speeds = fmt::format("<PanTilt {} x=\"{:.6g}\" y=\"{:.6g}\"/>", schema, *speed, *speed);
  if (place.zoom) {
    position += fmt::format("<Zoom {} x=\"{:.6g}\" space=\"{}\"/>", schema, *place.zoom, onvif_zoom_space);
    if (speed) speeds += fmt::format("<Zoom {} x=\"{:.6g}\"/>", schema, *speed);
  }
  std::string inside = profile_token(profile) + "<Position>" + position + "</Position>";
  if (speed) inside += "<Speed>" + speeds + "</Speed>";
  return call("AbsoluteMove", ptz_names, inside);
}

std::string onvif_stop(std::string_view profile) {
  return call("Stop", ptz_names, profile_token(profile) + "<PanTilt>true</PanTilt><Zoom>true</Zoom>");
}

std::optional<SoapFault> parse_soap_fault(std::string_view soap) {
  const Soap read(soap);
  const pugi::xml_node fault = read.answer("Fault");
  if (!fault) return std::nullopt;
  SoapFault found;
  // SOAP 1.2 nests codes, SOAP 1.1 has one.
  std::string_view code = text_of(child(fault, "faultcode"));
  constexpr int most_codes = 8;
  pugi::xml_node one = child(fault, "Code");
  for (int i = 0; !one.empty() && i < most_codes; one = child(one, "Subcode"), ++i)
    if (const std::string_view value = text_of(child(one, "Value")); !value.empty()) code = value;
  found.code = code.substr(code.rfind(':') + 1);
  const std::string_view reason = text_of(child(fault, "Reason", "Text"));
  found.reason = reason.empty() ? text_of(child(fault, "faultstring")) : reason;
  return found;
}

std::optional<double> parse_onvif_clock(std::string_view soap) {
  const Soap read(soap);
  const pugi::xml_node utc =
      child(read.answer("GetSystemDateAndTimeResponse"), "SystemDateAndTime", "UTCDateTime");
  const auto part = [&](const char* group, const char* name) {
    return whole_number(text_of(child(utc, group, name)));
  };
  const auto year = part("Date", "Year"), month = part("Date", "Month"), day = part("Date", "Day"),
             hour = part("Time", "Hour"), minute = part("Time", "Minute"), second = part("Time", "Second");
  if (!year || !month || !day || !hour || !minute || !second) return std::nullopt;
  return utc_seconds(*year, *month, *day, *hour, *minute, *second);
}

std::optional<OnvifServices> parse_onvif_services(std::string_view soap) {
  const Soap read(soap);
  OnvifServices found;
  if (const pugi::xml_node services = read.answer("GetServicesResponse")) {
    for (const pugi::xml_node& one : children(services, "Service")) {
      const std::string_view names = text_of(child(one, "Namespace"));
      const std::string path = path_of(text_of(child(one, "XAddr")));
      if (names == ptz_names) found.ptz = path;
      if (names == media_names) found.media = path;
    }
    return found;
  }
  const pugi::xml_node all = child(read.answer("GetCapabilitiesResponse"), "Capabilities");
  if (!all) return std::nullopt;
  found.media = path_of(text_of(child(all, "Media", "XAddr")));
  found.ptz = path_of(text_of(child(all, "PTZ", "XAddr")));
  return found;
}

std::optional<std::vector<OnvifProfile>> parse_onvif_profiles(std::string_view soap) {
  const Soap read(soap);
  const pugi::xml_node answer = read.answer("GetProfilesResponse");
  if (!answer) return std::nullopt;
  std::vector<OnvifProfile> found;
  for (const pugi::xml_node& one : children(answer, "Profiles")) {
    const pugi::xml_node head = child(one, "PTZConfiguration");
    found.push_back(
        {one.attribute("token").value(), !head.empty(), std::string(text_of(child(head, "NodeToken")))});
  }
  return found;
}

std::optional<std::vector<OnvifNode>> parse_onvif_nodes(std::string_view soap) {
  const Soap read(soap);
  const pugi::xml_node answer = read.answer("GetNodesResponse");
  if (!answer) return std::nullopt;
  std::vector<OnvifNode> found;
  for (const pugi::xml_node& one : children(answer, "PTZNode")) {
    const pugi::xml_node spaces = child(one, "SupportedPTZSpaces");
    found.push_back({one.attribute("token").value(), spaces_of(spaces, "AbsolutePanTiltPositionSpace", true),
                     spaces_of(spaces, "AbsoluteZoomPositionSpace", false)});
  }
  return found;
}

std::optional<OnvifStatus> parse_onvif_status(std::string_view soap) {
  const Soap read(soap);
  const pugi::xml_node status = child(read.answer("GetStatusResponse"), "PTZStatus");
  if (!status) return std::nullopt;
  OnvifStatus found;
  const pugi::xml_node position = child(status, "Position"), turn = child(position, "PanTilt");
  const auto pan = attribute(turn, "x"), tilt = attribute(turn, "y");
  if (pan && tilt) found.place = OnvifPlace{*pan, *tilt, attribute(child(position, "Zoom"), "x")};
  found.turn_space = turn.attribute("space").value();
  for (const pugi::xml_node& one : child(status, "MoveStatus").children()) {
    const std::string_view state = text_of(one);
    if (state == "MOVING") found.is_moving = true;
    if (state == "IDLE") found.is_moving = found.is_moving.value_or(false);
  }
  found.error = text_of(child(status, "Error"));
  if (found.error == "NO error") found.error.clear();
  return found;
}

bool is_onvif_answer(std::string_view soap, std::string_view name) {
  const Soap read(soap);
  return !read.answer(name).empty();
}

std::optional<OnvifRequest> parse_onvif_request(std::string_view soap) {
  const Soap read(soap);
  OnvifRequest found;
  pugi::xml_node request;
  for (const pugi::xml_node one : read.body.children())
    if (!request && one.type() == pugi::node_element) request = one;
  if (!request) return std::nullopt;
  found.name = local_name(request);
  if (const pugi::xml_node token = child(read.envelope, "Header", "Security", "UsernameToken"))
    found.token = OnvifToken{
        std::string(text_of(child(token, "Username"))), std::string(text_of(child(token, "Password"))),
        std::string(text_of(child(token, "Nonce"))), std::string(text_of(child(token, "Created")))};
  found.profile = text_of(child(request, "ProfileToken"));
  const pugi::xml_node vector = child(request, found.name == "ContinuousMove" ? "Velocity" : "Position");
  const pugi::xml_node turn = child(vector, "PanTilt"), zoom = child(vector, "Zoom");
  found.pan = attribute(turn, "x"), found.tilt = attribute(turn, "y"), found.zoom = attribute(zoom, "x");
  found.turn_space = turn.attribute("space").value(), found.zoom_space = zoom.attribute("space").value();
  found.speed = attribute(child(request, "Speed", "PanTilt"), "x");
  found.timeout = duration_of(text_of(child(request, "Timeout")));
  const auto is_false = [&](const char* name) {
    const std::string_view text = text_of(child(request, name));
    return text == "false" || text == "0";
  };
  found.stops_turn = !is_false("PanTilt"), found.stops_zoom = !is_false("Zoom");
  return found;
}

}  // namespace flexura
