#include "flexura/model/stand.h"

#include <numbers>
#include <string>

#include "flexura/base/table.h"
#include "flexura/math/arrays.h"
#include "flexura/model/ranges.h"

namespace flexura {
namespace {

constexpr NumberRange brightness_range = {.min = 0, .max = 100};

Spec length_of(const char* meaning) {
  return {.meaning = meaning, .unit = Unit::metre, .range = above_up_to(0, 1e6)};
}

void expect_direction(const std::array<double, 3>& direction, const char* name, Reader& reader) {
  if (std::hypot(direction[0], direction[1], direction[2]) < 1e-9)
    reader.problem_at(name, "has no direction: expected a vector that is not zero");
}

}  // namespace

const Table<ScreenConfig>& fields_of(const ScreenConfig*) {
  static const auto table =
      Table<ScreenConfig>("screen", "A flat white screen, seen from both sides.")
          .field("center", &ScreenConfig::center,
                 {.meaning = "Its middle: X, Y, Z.",
                  .unit = Unit::metre,
                  .range = coordinate_range,
                  .required = true})
          .field("normal", &ScreenConfig::normal,
                 {.meaning = "The way it faces; its height runs upwards as far as it can.",
                  .range = coordinate_range})
          .field("width", &ScreenConfig::width, length_of("Width."))
          .field("height", &ScreenConfig::height, length_of("Height."))
          .field("brightness", &ScreenConfig::brightness,
                 {.meaning = "Light that it sends; 1 is a camera's full scale.", .range = brightness_range})
          .field("gradient", &ScreenConfig::gradient,
                 {.meaning =
                      "Share by which it grows brighter from its middle to its right and to its upper edge.",
                  .range = between(-1, 1)})
          .field(
              "fall_off", &ScreenConfig::fall_off,
              {.meaning =
                   "Share by which its corners are darker than its middle; grows with the distance squared.",
               .range = share_range})
          .check([](const ScreenConfig& screen, Reader& reader) {
            expect_direction(screen.normal, "normal", reader);
          });
  return table;
}

const Table<EtalonConfig>& fields_of(const EtalonConfig*) {
  static const auto table =
      Table<EtalonConfig>("etalon", "The calibration cylinder: dark grey, with a red line every 90 degrees.")
          .field("position", &EtalonConfig::position,
                 {.meaning = "Middle of its lower end: X, Y, Z.",
                  .unit = Unit::metre,
                  .range = coordinate_range})
          .field("rotation", &EtalonConfig::rotation,
                 {.meaning = "Quaternion (w, x, y, z) that turns its axes into the world's; it stands along "
                             "its y, a red line towards its z.",
                  .range = between(-2, 2)})
          .field("radius", &EtalonConfig::radius, length_of("Radius."))
          .field("height", &EtalonConfig::height, length_of("Height."))
          .field("color", &EtalonConfig::color,
                 {.meaning = "Shares of red, green and blue light that it gives back.", .range = share_range})
          .field("line_width", &EtalonConfig::line_width, length_of("Width of a red line."))
          .field("line_color", &EtalonConfig::line_color,
                 {.meaning = "Shares of red, green and blue light that the lines give back.",
                  .range = share_range})
          .check([](const EtalonConfig& etalon, Reader& reader) {
            if (const std::string problem = quaternion_problem(etalon.rotation); !problem.empty())
              reader.problem_at("rotation", problem);
            if (4 * etalon.line_width > 2 * std::numbers::pi * etalon.radius)
              reader.problem_at("line_width", "leaves nothing between the four lines: expected less");
          });
  return table;
}

const Table<LightConfig>& fields_of(const LightConfig*) {
  static const auto table =
      Table<LightConfig>("light", "The light on the arm, the etalon and the obstacles.")
          .field("ambient", &LightConfig::ambient,
                 {.meaning = "Light from everywhere.", .range = brightness_range})
          .field(
              "directional", &LightConfig::directional,
              {.meaning = "Light from one direction, on a surface that faces it.", .range = brightness_range})
          .field("towards", &LightConfig::towards,
                 {.meaning = "The direction from which it comes.", .range = coordinate_range})
          .field("shadow", &LightConfig::shadow,
                 {.meaning = "Share of the directional light, and of a screen's, that a shadow takes away.",
                  .range = share_range})
          .field(
              "angular_radius", &LightConfig::angular_radius,
              {.meaning =
                   "Half the angle under which the light's source is seen: the larger, the softer a shadow's "
                   "border.",
               .unit = Unit::radian,
               .range = above_up_to(0, 0.5)})
          .check([](const LightConfig& light, Reader& reader) {
            expect_direction(light.towards, "towards", reader);
          });
  return table;
}

const Table<StandConfig>& fields_of(const StandConfig*) {
  static const auto table =
      Table<StandConfig>("stand", "What stands around the arm: screens, calibration cylinder, light.")
          .field("screen", &StandConfig::screen,
                 {.meaning = "Screens, as tables [[stand.screen]].",
                  .count = {0, 100},
                  .default_text = "two, behind the arm as the paper's two cameras see it"})
          .field("etalon", &StandConfig::etalon,
                 {.meaning = "The calibration cylinder.", .default_text = "none"})
          .field("light", &StandConfig::light, {.meaning = "The light."})
          .field(
              "camera_distances", &StandConfig::camera_distances,
              {.meaning = "How far the default cameras \"front\" and \"side\" stand from the planes XOY and "
                          "ZOY through the arm's base: the paper's D1 and D2.",
               .unit = Unit::metre,
               .range = above_up_to(0, 1e6),
               .default_text = "so far that all of the arm's reach is in view"})
          .field("background", &StandConfig::background,
                 {.meaning = "Light from where nothing is.", .range = brightness_range})
          .field("arm", &StandConfig::arm, {.meaning = "Whether the arm stands there too."});
  return table;
}

std::vector<ScreenConfig> default_screens(double length, const std::array<double, 3>& base) {
  // Just beyond the arm's reach. Wider than the view there of a camera that has the whole reach in its image.
  const double away = 1.2 * length, size = 5 * length;
  ScreenConfig behind_1, behind_2;
  behind_1.center = {base[0], base[1], base[2] - away};
  behind_1.normal = {0, 0, 1};
  behind_2.center = {base[0] + away, base[1], base[2]};
  behind_2.normal = {-1, 0, 0};
  for (ScreenConfig* screen : {&behind_1, &behind_2}) screen->width = screen->height = size;
  return {behind_1, behind_2};
}

}  // namespace flexura
