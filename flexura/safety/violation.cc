#include "flexura/safety/violation.h"

#include <fmt/format.h>

#include <array>
#include <numbers>

namespace flexura {
namespace {

struct HazardText {
  const char* name;
  double factor;     // from base units to those shown
  const char* unit;  // with a space before
};

const HazardText& text_of(Hazard hazard) {
  constexpr double degrees = 180.0 / std::numbers::pi;
  static constexpr std::array<HazardText, 8> texts{{{"bend", degrees, " deg"},
                                                    {"bend rate", degrees, " deg/s"},
                                                    {"stretch", 1, ""},
                                                    {"folding: curvature times radius", 1, ""},
                                                    {"jump", 1, ""},
                                                    {"no possible value", 1, ""},
                                                    {"self-contact", 1000, " mm deep"},
                                                    {"obstacle", 1000, " mm deep"}}};
  return texts.at(static_cast<std::size_t>(hazard));
}

}  // namespace

const char* name_of(Hazard hazard) { return text_of(hazard).name; }

std::string Violation::text() const {
  const HazardText& shown = text_of(hazard);
  std::string text =
      start == end ? fmt::format("{:.6g} s: ", start) : fmt::format("{:.6g} s to {:.6g} s: ", start, end);
  if (section && other_section && *section != *other_section) {
    text += fmt::format("sections {} and {}: ", *section + 1, *other_section + 1);
  } else if (section) {
    text += fmt::format("section {}: ", *section + 1);
  }
  if (hazard == Hazard::self_contact || hazard == Hazard::obstacle) {
    const std::string with = hazard == Hazard::obstacle ? obstacle
                             : section == other_section ? "itself"
                                                        : "each other";
    return text + fmt::format("contact with {}, {:.6g} mm deep", with, value * 1000);
  }
  text += shown.name;
  if (hazard == Hazard::not_finite) return text;
  text += fmt::format(" {:.6g}{}", value * shown.factor, shown.unit);
  if (hazard != Hazard::jump) text += fmt::format(", limit {:.6g}{}", limit * shown.factor, shown.unit);
  return text;
}

}  // namespace flexura
