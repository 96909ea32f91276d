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
              {.meaning = "Where the axis stands when the head says 0: its angle is what it says and this.",
               .unit = Unit::radian,
               .range = turn_range});
  return table;
}

}  // namespace

// Limits and rates: those of the paper's heads (sections 1 and 2). It gives no accelerations.
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
      "pan", "The pan axis, vertical at the head's foot; positive to the camera's left.");
  return table;
}

const Table<TiltConfig>& fields_of(const TiltConfig*) {
  static const auto table =
      turn_table<TiltConfig>("tilt", "The tilt axis, across the camera; positive upwards.");
  return table;
}

const Table<ZoomConfig>& fields_of(const ZoomConfig*) {
  static const auto table = [] {
    Table<ZoomConfig> zoom(
        "zoom", "What moves the zoom: in ratios, or in motor counts where the lens's table has them.");
    zoom.field("limits", &ZoomConfig::limits,
               {.meaning = "Smallest and largest position.",
                .range = {.min = -1e9, .max = 1e9},
                .default_text = "1 to 10 for a linear zoom, else the table's"});
    add_axis_fields(zoom, zoom_units, &ZoomConfig::max_rate, "all the range in 3 s");
    return zoom.check([](const ZoomConfig& config, Reader& reader) {
      if (config.limits) check_limits(*config.limits, reader);
    });
  }();
  return table;
}

const Table<HeadConfig>& fields_of(const HeadConfig*) {
  static const auto table =
      Table<HeadConfig>("head", "The pan/tilt/zoom head: how its axes move, and where they lie.")
          .field("pan", &HeadConfig::pan, {.meaning = "The pan axis."})
          .field("tilt", &HeadConfig::tilt, {.meaning = "The tilt axis."})
          .field("zoom", &HeadConfig::zoom, {.meaning = "What moves the zoom."})
          .field("delay", &HeadConfig::delay,
                 {.meaning = "From a command until its motion starts.",
                  .unit = Unit::second,
                  .range = between(0, 1e3)})
          .field(
              "tilt_axis", &HeadConfig::tilt_axis,
              {.meaning = "A point of the tilt axis, from the mount's origin on the pan axis: right, down, "
                          "forward at pan 0.",
               .unit = Unit::metre,
               .range = offset_range})
          .field("pupil", &HeadConfig::pupil,
                 {.meaning = "The entrance pupil at ratio 1, from that point: right, down, forward in the "
                             "camera's own axes.",
                  .unit = Unit::metre,
                  .range = offset_range})
          .field("pupil_shift", &HeadConfig::pupil_shift,
                 {.meaning = "How far the entrance pupil moves forward for each 1 of zoom ratio.",
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
