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
      Table<ScreenConfig>("screen", "A flat white screen, visible from both sides.")
          .field("center", &ScreenConfig::center,
                 {.meaning = "Centre: X, Y, Z.",
                  .unit = Unit::metre,
                  .range = coordinate_range,
                  .required = true})
          .field("normal", &ScreenConfig::normal,
                 {.meaning = "Normal of the screen. The screen is turned about its normal so that its height "
                             "is as upright as possible.",
                  .range = coordinate_range})
          .field("width", &ScreenConfig::width, length_of("Width."))
          .field("height", &ScreenConfig::height, length_of("Height."))
          .field(
              "brightness", &ScreenConfig::brightness,
              {.meaning = "Emitted light, in units of the cameras' full scale.", .range = brightness_range})
          .field(
              "gradient", &ScreenConfig::gradient,
              {.meaning =
                   "Relative increase of brightness from the middle to the right edge and to the upper edge.",
               .range = between(-1, 1)})
          .field("fall_off", &ScreenConfig::fall_off,
                 {.meaning = "Relative loss of brightness in the corners. The loss increases with the square "
                             "of the distance from the middle.",
                  .range = share_range})
          .check([](const ScreenConfig& screen, Reader& reader) {
            expect_direction(screen.normal, "normal", reader);
          });
  return table;
}

const Table<EtalonConfig>& fields_of(const EtalonConfig*) {
  static const auto table =
      Table<EtalonConfig>("etalon", "Calibration cylinder: dark grey, with a red line every 90 degrees.")
          .field("position", &EtalonConfig::position,
                 {.meaning = "Centre of the lower end: X, Y, Z.",
                  .unit = Unit::metre,
                  .range = coordinate_range})
          .field("rotation", &EtalonConfig::rotation,
                 {.meaning = "Quaternion (w, x, y, z) from the cylinder's axes to the world. The cylinder's "
                             "axis is y; one red line faces z.",
                  .range = between(-2, 2)})
          .field("radius", &EtalonConfig::radius, length_of("Radius."))
          .field("height", &EtalonConfig::height, length_of("Height."))
          .field("color", &EtalonConfig::color,
                 {.meaning = "Fractions of red, green and blue light that the cylinder reflects.",
                  .range = share_range})
          .field("line_width", &EtalonConfig::line_width, length_of("Width of a red line."))
          .field("line_color", &EtalonConfig::line_color,
                 {.meaning = "Fractions of red, green and blue light that the lines reflect.",
                  .range = share_range})
          .check([](const EtalonConfig& etalon, Reader& reader) {
            if (const std::string problem = quaternion_problem(etalon.rotation); !problem.empty())
              reader.problem_at("rotation", problem);
            if (4 * etalon.line_width > 2 * std::numbers::pi * etalon.radius)
              reader.problem_at("line_width", "is too large: expected gaps between the four lines");
          });
  return table;
}

const Table<LightConfig>& fields_of(const LightConfig*) {
  static const auto table =
      Table<LightConfig>("light", "Light on the arm, the calibration cylinder and the obstacles.")
          .field("ambient", &LightConfig::ambient, {.meaning = "Ambient light.", .range = brightness_range})
          .field("directional", &LightConfig::directional,
                 {.meaning = "Directional light on a surface that faces the light source.",
                  .range = brightness_range})
          .field("towards", &LightConfig::towards,
                 {.meaning = "Direction towards the light source.", .range = coordinate_range})
          .field("shadow", &LightConfig::shadow,
                 {.meaning = "Fraction of the directional light, and of the screens' light, that is missing "
                             "in a shadow.",
                  .range = share_range})
          .field(
              "angular_radius", &LightConfig::angular_radius,
              {.meaning = "Half the angular size of the light source. A larger source makes softer shadows.",
               .unit = Unit::radian,
               .range = above_up_to(0, 0.5)})
          .check([](const LightConfig& light, Reader& reader) {
            expect_direction(light.towards, "towards", reader);
          });
  return table;
}

const Table<StandConfig>& fields_of(const StandConfig*) {
  static const auto table =
      Table<StandConfig>("stand", "Surroundings of the arm: screens, calibration cylinder and light.")
          .field("screen", &StandConfig::screen,
                 {.meaning = "Screens, as tables [[stand.screen]].",
                  .count = {0, 100},
                  .default_text = "two, behind the arm for the paper's two cameras"})
          .field("etalon", &StandConfig::etalon, {.meaning = "Calibration cylinder.", .default_text = "none"})
          .field("light", &StandConfig::light, {.meaning = "Light."})
          .field("camera_distances", &StandConfig::camera_distances,
                 {.meaning = "Distances D1 and D2 of the default cameras \"front\" and \"side\" from the "
                             "planes XOY and ZOY through the arm's base.",
                  .unit = Unit::metre,
                  .range = above_up_to(0, 1e6),
                  .default_text = "large enough to show the arm's whole reach"})
          .field("background", &StandConfig::background,
                 {.meaning = "Light of the background, in units of the cameras' full scale.",
                  .range = brightness_range})
          .field("arm", &StandConfig::arm, {.meaning = "Whether the arm is in the scene."});
  return table;
}

std::vector<ScreenConfig> default_screens(double length, const std::array<double, 3>& base) {
  // The screens are just beyond the arm's reach. They are larger than the view, at this distance, of a camera
  // that has the whole reach in its image.
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
