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
  static constexpr std::array<HazardText, 6> texts{{{"bend", degrees, " deg"},
                                                    {"bend rate", degrees, " deg/s"},
                                                    {"stretch", 1, ""},
                                                    {"folding: curvature times radius", 1, ""},
                                                    {"jump", 1, ""},
                                                    {"no finite value", 1, ""}}};
  return texts.at(static_cast<std::size_t>(hazard));
}

}  // namespace

const char* name_of(Hazard hazard) { return text_of(hazard).name; }

std::string Violation::text() const {
  const HazardText& shown = text_of(hazard);
  std::string text =
      start == end ? fmt::format("{:.6g} s: ", start) : fmt::format("{:.6g} s to {:.6g} s: ", start, end);
  if (section) text += fmt::format("section {}: ", *section + 1);
  text += shown.name;
  if (hazard == Hazard::not_finite) return text;
  text += fmt::format(" {:.6g}{}", value * shown.factor, shown.unit);
  if (hazard != Hazard::jump) text += fmt::format(", limit {:.6g}{}", limit * shown.factor, shown.unit);
  return text;
}

}  // namespace flexura
