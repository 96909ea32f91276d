#include "flexura/report/page.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstddef>

#include "flexura/kinematics/shape.h"

namespace flexura {
namespace {

// Nine digits: a micrometre in a kilometre, and half the size of all of them.
std::string json_number(double value) { return fmt::format("{:.9g}", value + 0.0); }

class JsonArray {
 public:
  void add(double value) { text_ += (text_.empty() ? "" : ",") + json_number(value); }
  [[nodiscard]] std::string text() const { return '[' + text_ + ']'; }

 private:
  std::string text_;
};

std::string unsafe_json(const ReportMotion& motion) {
  std::string text;
  for (const auto& violation : motion.violations) {
    for (const std::size_t section : violation.sections) {
      text += fmt::format("{}[{},{},{}]", text.empty() ? "" : ",", json_number(violation.start),
                          json_number(violation.end), section);
    }
  }
  return '[' + text + ']';
}

const char* curve_name(CurveKind kind) {
  if (kind == CurveKind::arcs) return "arcs";
  return kind == CurveKind::bezier ? "bezier" : "catmull_rom";
}

std::string states_json(const ReportMotion& motion) {
  JsonArray bends;
  JsonArray stretches;
  for (const ArmState& state : motion.states) {
    for (const Eigen::Vector2d& bend : state.bends) {
      bends.add(bend.x());
      if (motion.arm.kind == ArmKind::spatial) bends.add(bend.y());
    }
    if (!motion.stretches_change) continue;
    for (const double stretch : state.stretches) stretches.add(stretch);
  }
  return fmt::format(R"("bends":{},"stretches":{})", bends.text(), stretches.text());
}

}  // namespace

std::string filled(std::string_view text, const std::map<std::string, std::string, std::less<>>& values) {
  std::string out;
  for (std::size_t open = text.find("{{"); open != std::string_view::npos; open = text.find("{{")) {
    const std::size_t close = text.find("}}", open);
    out += text.substr(0, open);
    out += values.at(std::string(text.substr(open + 2, close - open - 2)));
    text.remove_prefix(close + 2);
  }
  return out += text;
}

std::string csp_hash(std::string_view hex) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string base64;
  unsigned bits = 0;
  unsigned waiting = 0;
  for (const char& digit : hex) {
    unsigned nibble = 0;
    std::from_chars(&digit, &digit + 1, nibble, 16);
    bits = (bits << 4U) | nibble;
    waiting += 4;
    if (waiting < 6) continue;
    waiting -= 6;
    base64 += digits[(bits >> waiting) & 63U];
  }
  if (waiting > 0) base64 += digits[(bits << (6 - waiting)) & 63U];
  while (base64.size() % 4 != 0) base64 += '=';
  return "'sha256-" + base64 + "'";
}

std::string motion_json(const ReportMotion& motion) {
  JsonArray rotation;
  JsonArray lengths;
  JsonArray radii;
  JsonArray times;
  const Pose& X_WB = motion.arm.X_WB;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) rotation.add(X_WB.rotation(row, column));
  }
  for (const Section& section : motion.arm.sections) {
    lengths.add(section.length);
    for (const double radius : section.radius) radii.add(radius);
  }
  for (const double time : motion.times) times.add(time);
  return fmt::format(
      "{{\"planar\":{},\"coordinates\":{},\"baseAngle\":{},\"axes\":{},\"origin\":[{},{},{}],"
      "\"lengths\":{},\"radii\":{},\"times\":{},\"unsafe\":{},\"curve\":\"{}\",\"tension\":{},{}}}",
      motion.arm.kind == ArmKind::planar, motion.tip_coordinates(),
      json_number(base_tangent_angle(motion.arm)), rotation.text(), json_number(X_WB.position.x()),
      json_number(X_WB.position.y()), json_number(X_WB.position.z()), lengths.text(), radii.text(),
      times.text(), unsafe_json(motion), curve_name(motion.curve), json_number(motion.tension),
      states_json(motion));
}

}  // namespace flexura
