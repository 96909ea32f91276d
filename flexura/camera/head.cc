#include "flexura/camera/head.h"

#include <cmath>

#include "flexura/base/degree.h"
#include "flexura/camera/axis_fields.h"

namespace flexura {
namespace {

constexpr NumberRange offset_range = {.min = -1e3, .max = 1e3};
constexpr AxisUnits turn_units = {Unit::radian, Unit::radian_per_second, Unit::radian_per_second_squared};
constexpr AxisUnits zoom_units = {Unit::none, Unit::none, Unit::none};

template <class Turn>
Table<Turn> turn_table(const char* name, const char* meaning) {
  Table<Turn> table = axis_table<Turn>(name, meaning, turn_units, turn_range);
  table.field("zero", &Turn::zero,
              {.meaning = "Zero offset: true angle of the axis when the head reports 0. The true angle is "
                          "the reported angle plus this offset.",
               .unit = Unit::radian,
               .range = turn_range});
  return table;
}

}  // namespace

// Limits and rates are those of the paper's heads (sections 1 and 2). The paper does not give accelerations.
PanConfig::PanConfig()
    : AxisConfig{.limits = {-135 * degree, 135 * degree},
                 .max_rate = 50 * degree,
                 .max_acceleration = 200 * degree} {}

TiltConfig::TiltConfig()
    : AxisConfig{
          .limits = {-45 * degree, 90 * degree}, .max_rate = 25 * degree, .max_acceleration = 100 * degree} {}

AxisConfig ZoomConfig::axis(const ZoomTable& lens) const {
  constexpr double whole_range = 3;  // s
  AxisConfig axis;
  axis.limits = limits.value_or(lens.is_linear() ? std::array<double, 2>{1, 10}
                                                 : std::array<double, 2>{lens.first(), lens.last()});
  axis.max_rate = max_rate.value_or((axis.limits[1] - axis.limits[0]) / whole_range);
  axis.max_acceleration = max_acceleration;
  axis.resolution = resolution;
  axis.backlash = backlash;
  return axis;
}

const Table<PanConfig>& fields_of(const PanConfig*) {
  static const auto table = turn_table<PanConfig>(
      "pan", "Pan axis along the mount's vertical axis; positive to the camera's left.");
  return table;
}

const Table<TiltConfig>& fields_of(const TiltConfig*) {
  static const auto table =
      turn_table<TiltConfig>("tilt", "Tilt axis, perpendicular to the viewing direction; positive upwards.");
  return table;
}

const Table<ZoomConfig>& fields_of(const ZoomConfig*) {
  static const auto table = [] {
    Table<ZoomConfig> zoom(
        "zoom", "Zoom axis. Positions are ratios, or motor positions if the lens table has counts.");
    zoom.field("limits", &ZoomConfig::limits,
               {.meaning = "Smallest and largest position.",
                .range = {.min = -1e9, .max = 1e9},
                .default_text = "1 to 10, or the range of the lens table"});
    add_axis_fields(zoom, zoom_units, &ZoomConfig::max_rate, "the whole range in 3 s");
    return zoom.check([](const ZoomConfig& config, Reader& reader) {
      if (config.limits) check_limits(*config.limits, reader);
    });
  }();
  return table;
}

const Table<HeadConfig>& fields_of(const HeadConfig*) {
  static const auto table =
      Table<HeadConfig>("head", "Pan/tilt/zoom head: limits, dynamics and geometry of its axes.")
          .field("pan", &HeadConfig::pan, {.meaning = "Pan axis."})
          .field("tilt", &HeadConfig::tilt, {.meaning = "Tilt axis."})
          .field("zoom", &HeadConfig::zoom, {.meaning = "Zoom axis."})
          .field("delay", &HeadConfig::delay,
                 {.meaning = "Delay from a command to the start of the motion.",
                  .unit = Unit::second,
                  .range = between(0, 1e3)})
          .field("tilt_axis", &HeadConfig::tilt_axis,
                 {.meaning = "Point on the tilt axis relative to the mount's origin on the pan axis: right, "
                             "down, forward at pan 0.",
                  .unit = Unit::metre,
                  .range = offset_range})
          .field("pupil", &HeadConfig::pupil,
                 {.meaning = "Position of the entrance pupil at zoom ratio 1 relative to `tilt_axis`: right, "
                             "down, forward in the camera's axes.",
                  .unit = Unit::metre,
                  .range = offset_range})
          .field("pupil_shift", &HeadConfig::pupil_shift,
                 {.meaning = "Forward shift of the entrance pupil per unit of zoom ratio.",
                  .unit = Unit::metre,
                  .range = offset_range});
  return table;
}

Eigen::Matrix3d pan_rotation(double pan) {
  const double c = std::cos(pan), s = std::sin(pan);
  Eigen::Matrix3d R;
  R << c, 0, -s, 0, 1, 0, s, 0, c;
  return R;
}

Eigen::Matrix3d tilt_rotation(double tilt) {
  const double c = std::cos(tilt), s = std::sin(tilt);
  Eigen::Matrix3d R;
  R << 1, 0, 0, 0, c, -s, 0, s, c;
  return R;
}

Pose head_pose(const HeadGeometry& geometry, double pan, double tilt) {
  const Eigen::Matrix3d R_pan = pan_rotation(pan), R_tilt = tilt_rotation(tilt);
  return {R_pan * R_tilt, R_pan * (geometry.tilt_axis + R_tilt * geometry.pupil)};
}

}  // namespace flexura
