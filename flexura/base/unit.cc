#include "flexura/base/unit.h"

#include <array>
#include <numbers>

#include "flexura/base/degree.h"

namespace flexura {

std::span<const UnitSpelling> spellings(Unit unit) {
  using std::numbers::pi;
  static constexpr std::array<UnitSpelling, 1> none{{{"", 1.0, ""}}};
  static constexpr std::array<UnitSpelling, 2> metre{{{"", 1.0, "m"}, {"_mm", 1e-3, "mm"}}};
  static constexpr std::array<UnitSpelling, 2> metre_per_second{{{"", 1.0, "m/s"}, {"_mm", 1e-3, "mm/s"}}};
  static constexpr std::array<UnitSpelling, 2> metre_per_second_squared{
      {{"", 1.0, "m/s^2"}, {"_mm", 1e-3, "mm/s^2"}}};
  static constexpr std::array<UnitSpelling, 2> second{{{"", 1.0, "s"}, {"_ms", 1e-3, "ms"}}};
  static constexpr std::array<UnitSpelling, 3> radian{
      {{"", 1.0, "rad"}, {"_deg", degree, "deg"}, {"_pi", pi, "pi rad"}}};
  static constexpr std::array<UnitSpelling, 3> radian_per_second{
      {{"", 1.0, "rad/s"}, {"_deg", degree, "deg/s"}, {"_pi", pi, "pi rad/s"}}};
  static constexpr std::array<UnitSpelling, 3> radian_per_second_squared{
      {{"", 1.0, "rad/s^2"}, {"_deg", degree, "deg/s^2"}, {"_pi", pi, "pi rad/s^2"}}};
  switch (unit) {
    case Unit::none:
      break;
    case Unit::metre:
      return metre;
    case Unit::metre_per_second:
      return metre_per_second;
    case Unit::metre_per_second_squared:
      return metre_per_second_squared;
    case Unit::second:
      return second;
    case Unit::radian:
      return radian;
    case Unit::radian_per_second:
      return radian_per_second;
    case Unit::radian_per_second_squared:
      return radian_per_second_squared;
  }
  return none;
}

std::span<const std::string_view> all_unit_suffixes() {
  static constexpr std::array<std::string_view, 9> suffixes{"_deg", "_pi", "_mm", "_ms", "_rad",
                                                            "_m",   "_s",  "_cm", "_hz"};
  return suffixes;
}

std::string_view without_unit(std::string_view key) {
  for (const std::string_view suffix : all_unit_suffixes()) {
    if (key.size() > suffix.size() && key.ends_with(suffix)) return key.substr(0, key.size() - suffix.size());
  }
  return key;
}

}  // namespace flexura
