#include "flexura/equipment/onvif_answers.h"

#include <fmt/format.h>

#include <charconv>
#include <tuple>
#include <utility>

namespace flexura {
namespace {

// Returns an element with the prefixes of a service: tds, trt or tptz.
std::string answer_element(std::string_view prefix, std::string_view name, std::string_view inside) {
  std::string_view names = "http://www.onvif.org/ver20/ptz/wsdl";
  if (prefix == "tds") names = "http://www.onvif.org/ver10/device/wsdl";
  if (prefix == "trt") names = "http://www.onvif.org/ver10/media/wsdl";
  return fmt::format(
      "<{0}:{1}Response xmlns:{0}=\"{2}\" "
      "xmlns:tt=\"http://www.onvif.org/ver10/schema\">{3}</{0}:{1}Response>",
      prefix, name, names, inside);
}

std::string range_text(std::string_view name, const OnvifRange& range) {
  return fmt::format("<tt:{0}><tt:Min>{1}</tt:Min><tt:Max>{2}</tt:Max></tt:{0}>", name, range.min, range.max);
}

std::string space_text(std::string_view name, const OnvifSpace& space, bool has_y) {
  return fmt::format("<tt:{0}><tt:URI>{1}</tt:URI>{2}{3}</tt:{0}>", name, space.uri,
                     range_text("XRange", space.x), has_y ? range_text("YRange", space.y) : std::string());
}

constexpr std::string_view turn_velocity =
    "http://www.onvif.org/ver10/tptz/PanTiltSpaces/VelocityGenericSpace";
constexpr std::string_view zoom_velocity = "http://www.onvif.org/ver10/tptz/ZoomSpaces/VelocityGenericSpace";

std::string configuration_inside() {
  return fmt::format(
      "<tt:Name>head</tt:Name><tt:UseCount>1</tt:UseCount><tt:NodeToken>node_1</tt:NodeToken>"
      "<tt:DefaultAbsolutePantTiltPositionSpace>{}</tt:DefaultAbsolutePantTiltPositionSpace>"
      "<tt:DefaultAbsoluteZoomPositionSpace>{}</tt:DefaultAbsoluteZoomPositionSpace>"
      "<tt:DefaultContinuousPanTiltVelocitySpace>{}</tt:DefaultContinuousPanTiltVelocitySpace>"
      "<tt:DefaultContinuousZoomVelocitySpace>{}</tt:DefaultContinuousZoomVelocitySpace>"
      "<tt:DefaultPTZTimeout>PT5S</tt:DefaultPTZTimeout>",
      onvif_generic_space, onvif_zoom_space, turn_velocity, zoom_velocity);
}

constexpr std::string_view source_inside =
    "<tt:Framerate>25</tt:Framerate><tt:Resolution><tt:Width>640</tt:Width><tt:Height>480</tt:Height>"
    "</tt:Resolution>";

std::string encoder_inside() {
  return "<tt:Name>encoder</tt:Name><tt:UseCount>1</tt:UseCount><tt:Encoding>H264</tt:Encoding>"
         "<tt:Resolution><tt:Width>640</tt:Width><tt:Height>480</tt:Height></tt:Resolution>"
         "<tt:Quality>5</tt:Quality><tt:RateControl><tt:FrameRateLimit>25</tt:FrameRateLimit>"
         "<tt:EncodingInterval>1</tt:EncodingInterval><tt:BitrateLimit>4096</tt:BitrateLimit></"
         "tt:RateControl>"
         "<tt:H264><tt:GovLength>25</tt:GovLength><tt:H264Profile>Main</tt:H264Profile></tt:H264>"
         "<tt:Multicast><tt:Address><tt:Type>IPv4</tt:Type><tt:IPv4Address>0.0.0.0</tt:IPv4Address></"
         "tt:Address>"
         "<tt:Port>0</tt:Port><tt:TTL>0</tt:TTL><tt:AutoStart>false</tt:AutoStart></tt:Multicast>"
         "<tt:SessionTimeout>PT60S</tt:SessionTimeout>";
}

std::string profile_inside() {
  return fmt::format(
      "<tt:Name>main</tt:Name>"
      "<tt:VideoSourceConfiguration "
      "token=\"source_config_1\"><tt:Name>source</tt:Name><tt:UseCount>1</tt:UseCount>"
      "<tt:SourceToken>source_1</tt:SourceToken><tt:Bounds x=\"0\" y=\"0\" width=\"640\" height=\"480\"/>"
      "</tt:VideoSourceConfiguration>"
      "<tt:VideoEncoderConfiguration token=\"encoder_1\">{}</tt:VideoEncoderConfiguration>"
      "<tt:PTZConfiguration token=\"head_1\">{}</tt:PTZConfiguration>",
      encoder_inside(), configuration_inside());
}

std::string address_text(std::string_view host, std::string_view service) {
  return fmt::format("<tt:XAddr>http://{}/onvif/{}_service</tt:XAddr>", host, service);
}

}  // namespace

std::string soap_fault(std::string_view code, std::string_view reason) {
  const std::string_view party = code == "ActionNotSupported" || code == "MovingPTZ" ? "Receiver" : "Sender";
  return soap_message(fmt::format(
      "<s:Fault xmlns:ter=\"http://www.onvif.org/ver10/error\"><s:Code><s:Value>s:{}</s:Value><s:Subcode>"
      "<s:Value>ter:{}</s:Value></s:Subcode></s:Code><s:Reason><s:Text xml:lang=\"en\">{}</s:Text></s:Reason>"
      "</s:Fault>",
      party, code, reason));
}

std::string onvif_empty_answer(std::string_view request) { return answer_element("tptz", request, {}); }

std::string onvif_clock_answer(double time) {
  const std::string text = onvif_time_text(time);
  const auto part = [&](std::size_t at, std::size_t size) {
    int value = 0;
    std::from_chars(text.data() + at, text.data() + at + size, value);
    return value;
  };
  const std::string date = fmt::format(
      "<tt:Time><tt:Hour>{}</tt:Hour><tt:Minute>{}</tt:Minute><tt:Second>{}</tt:Second></tt:Time>"
      "<tt:Date><tt:Year>{}</tt:Year><tt:Month>{}</tt:Month><tt:Day>{}</tt:Day></tt:Date>",
      part(11, 2), part(14, 2), part(17, 2), part(0, 4), part(5, 2), part(8, 2));
  return answer_element(
      "tds", "GetSystemDateAndTime",
      fmt::format(
          "<tds:SystemDateAndTime><tt:DateTimeType>Manual</tt:DateTimeType>"
          "<tt:DaylightSavings>false</tt:DaylightSavings><tt:TimeZone><tt:TZ>UTC0</tt:TZ></tt:TimeZone>"
          "<tt:UTCDateTime>{0}</tt:UTCDateTime><tt:LocalDateTime>{0}</tt:LocalDateTime>"
          "</tds:SystemDateAndTime>",
          date));
}

std::string onvif_services_answer(std::string_view host) {
  std::string all;
  for (const auto& [names, path] :
       {std::pair("ver10/device/wsdl", "device"), std::pair("ver10/media/wsdl", "media"),
        std::pair("ver20/ptz/wsdl", "ptz")})
    all += fmt::format(
        "<tds:Service><tds:Namespace>http://www.onvif.org/{}</tds:Namespace>"
        "<tds:XAddr>http://{}/onvif/{}_service</tds:XAddr><tds:Version><tt:Major>2</tt:Major><tt:Minor>5</"
        "tt:Minor>"
        "</tds:Version></tds:Service>",
        names, host, path);
  return answer_element("tds", "GetServices", all);
}

std::string onvif_capabilities_answer(std::string_view host) {
  return answer_element(
      "tds", "GetCapabilities",
      fmt::format("<tds:Capabilities><tt:Device>{}</tt:Device><tt:Media>{}<tt:StreamingCapabilities>"
                  "<tt:RTPMulticast>false</tt:RTPMulticast><tt:RTP_TCP>true</tt:RTP_TCP>"
                  "<tt:RTP_RTSP_TCP>true</tt:RTP_RTSP_TCP></tt:StreamingCapabilities></tt:Media>"
                  "<tt:PTZ>{}</tt:PTZ></tds:Capabilities>",
                  address_text(host, "device"), address_text(host, "media"), address_text(host, "ptz")));
}

std::string onvif_nodes_answer(const std::vector<OnvifSpace>& turn, const std::vector<OnvifSpace>& zoom) {
  std::string spaces;
  for (const OnvifSpace& one : turn) spaces += space_text("AbsolutePanTiltPositionSpace", one, true);
  for (const OnvifSpace& one : zoom) spaces += space_text("AbsoluteZoomPositionSpace", one, false);
  spaces +=
      space_text("ContinuousPanTiltVelocitySpace", {std::string(turn_velocity), {-1, 1}, {-1, 1}}, true);
  spaces += space_text("ContinuousZoomVelocitySpace", {std::string(zoom_velocity), {-1, 1}, {}}, false);
  return answer_element(
      "tptz", "GetNodes",
      fmt::format("<tptz:PTZNode token=\"node_1\" FixedHomePosition=\"true\"><tt:Name>head</tt:Name>"
                  "<tt:SupportedPTZSpaces>{}</tt:SupportedPTZSpaces>"
                  "<tt:MaximumNumberOfPresets>0</tt:MaximumNumberOfPresets>"
                  "<tt:HomeSupported>false</tt:HomeSupported></tptz:PTZNode>",
                  spaces));
}

std::string onvif_status_answer(const OnvifPlace& place, std::string_view space,
                                const std::optional<bool>& is_moving, double time) {
  std::string text =
      fmt::format("<tt:PanTilt x=\"{:.5f}\" y=\"{:.5f}\" space=\"{}\"/>", place.pan, place.tilt, space);
  if (place.zoom) text += fmt::format("<tt:Zoom x=\"{:.5f}\" space=\"{}\"/>", *place.zoom, onvif_zoom_space);
  text = "<tt:Position>" + text + "</tt:Position>";
  if (is_moving)
    text += fmt::format("<tt:MoveStatus><tt:PanTilt>{0}</tt:PanTilt><tt:Zoom>{0}</tt:Zoom></tt:MoveStatus>",
                        *is_moving ? "MOVING" : "IDLE");
  text += "<tt:Error>NO error</tt:Error><tt:UtcTime>" + onvif_time_text(time) + "</tt:UtcTime>";
  return answer_element("tptz", "GetStatus", "<tptz:PTZStatus>" + text + "</tptz:PTZStatus>");
}

std::optional<std::string> onvif_open_answer(std::string_view request) {
  if (request == "GetServiceCapabilities")
    return answer_element("tds", request,
                          "<tds:Capabilities><tds:Network/><tds:Security UsernameToken=\"true\" "
                          "HttpDigest=\"false\"/><tds:System/></tds:Capabilities>");
  if (request == "GetHostname")
    return answer_element("tds", request,
                          "<tds:HostnameInformation><tt:FromDHCP>false</tt:FromDHCP><tt:Name>camera</tt:Name>"
                          "</tds:HostnameInformation>");
  return std::nullopt;
}

std::optional<std::string> onvif_fixed_answer(std::string_view request, std::string_view host) {
  const auto profile = [&](std::string_view element) {
    return fmt::format("<trt:{0} token=\"{1}\" fixed=\"true\">{2}</trt:{0}>", element, onvif_fixed_profile,
                       profile_inside());
  };
  if (request == "GetDeviceInformation")
    return answer_element(
        "tds", request,
        "<tds:Manufacturer>Flexura</tds:Manufacturer><tds:Model>Simulated camera</tds:Model>"
        "<tds:FirmwareVersion>1</tds:FirmwareVersion><tds:SerialNumber>0001</tds:SerialNumber>"
        "<tds:HardwareId>1</tds:HardwareId>");
  if (request == "GetScopes")
    return answer_element("tds", request,
                          "<tds:Scopes><tt:ScopeDef>Fixed</tt:ScopeDef>"
                          "<tt:ScopeItem>onvif://www.onvif.org/name/camera</tt:ScopeItem></tds:Scopes>");
  if (request == "GetProfiles") return answer_element("trt", request, profile("Profiles"));
  if (request == "GetProfile") return answer_element("trt", request, profile("Profile"));
  if (request == "GetVideoSources")
    return answer_element(
        "trt", request,
        fmt::format("<trt:VideoSources token=\"source_1\">{}</trt:VideoSources>", source_inside));
  if (request == "GetVideoEncoderConfiguration")
    return answer_element(
        "trt", request,
        "<trt:Configuration token=\"encoder_1\">" + encoder_inside() + "</trt:Configuration>");
  for (const auto& [name, scheme, path] :
       {std::tuple("GetStreamUri", "rtsp", "stream"), std::tuple("GetSnapshotUri", "http", "snapshot")})
    if (request == name)
      return answer_element("trt", request,
                            fmt::format("<trt:MediaUri><tt:Uri>{}://{}/{}</tt:Uri>"
                                        "<tt:InvalidAfterConnect>false</tt:InvalidAfterConnect>"
                                        "<tt:InvalidAfterReboot>false</tt:InvalidAfterReboot>"
                                        "<tt:Timeout>PT60S</tt:Timeout></trt:MediaUri>",
                                        scheme, host, path));
  if (request == "GetConfigurations" || request == "GetConfiguration")
    return answer_element(
        "tptz", request,
        "<tptz:PTZConfiguration token=\"head_1\">" + configuration_inside() + "</tptz:PTZConfiguration>");
  return std::nullopt;
}

}  // namespace flexura
