#include "flexura/model/drive_config.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "flexura/base/table.h"
#include "flexura/math/dense.h"

namespace flexura {
namespace {

// Angle, rad, below which two directions count as equal.
constexpr double direction_tolerance = 1e-3;
constexpr std::size_t max_tendons = 10000;
// Doubles and the positions of a log represent all integers up to this value.
constexpr double max_position = 9007199254740992.0;
// Limit for a section in a file: the range of ShapeConfig.
constexpr double max_stretch = 100.0;

const char* tendons_needed(bool planar, bool stretching) {
  if (planar && stretching) return "at least 2 on different sides of the arm";
  if (planar) return "at least 1 that is not at 90 or 270 deg";
  if (stretching) return "at least 3 that are not on one line";
  return "at least 2 in different directions";
}

// The length of a tendon depends on the sum of the bends up to the section at which the tendon ends. Hence
// the tendons of each section determine one sum, and tendons of another section cannot replace them.
void check_section(const Drive& drive, const ArmConfig& arm, std::size_t index, const std::string& path,
                   Reader& reader) {
  const bool planar = arm.kind == ArmKind::planar;
  const bool stretching = arm.section[index].can_stretch();
  std::vector<Eigen::Vector2d> offsets;
  double largest = 0;
  for (const Tendon& tendon : drive.tendons) {
    if (tendon.section != index) continue;
    offsets.push_back(tendon.offset());
    largest = std::max(largest, tendon.radius);
  }
  // Unknowns: the bend in one or two planes, and the stretch. Motions that the section cannot make count as
  // determined.
  Eigen::Matrix3d gram = Eigen::Vector3d(0, planar ? 1 : 0, stretching ? 0 : 1).asDiagonal();
  gram *= largest * largest;
  for (const Eigen::Vector2d& offset : offsets) {
    const Eigen::Vector3d row(offset.x(), planar ? 0 : offset.y(), stretching ? largest : 0);
    gram += row * row.transpose();
  }
  const double determined = std::pow(direction_tolerance * largest, 2);
  if (!offsets.empty() && least_eigenvalue(gram) > determined) return;
  reader.problem_at(path,
                    fmt::format("does not determine the {} of section {}, where {} tendon{}: expected {}",
                                stretching ? "bend and the stretch" : "bend", index + 1, offsets.size(),
                                offsets.size() == 1 ? " ends" : "s end", tendons_needed(planar, stretching)));
}

void check_positions(const Drive& drive, const ArmConfig& arm, const std::string& path, Reader& reader) {
  double length = 0;
  for (const Section& section : arm.section) length += section.length * max_stretch;
  const double turns = 2 * angle_range.max * static_cast<double>(arm.section.size());
  for (std::size_t i = 0; i < drive.axes.size(); ++i) {
    const double most_travel = drive.tendons[i].radius / 2,
                 travel = drive.axes[i].spool.friction_travel.value_or(0);
    if (travel > most_travel)
      reader.problem_at(fmt::format("{}[{}]", path, i),
                        fmt::format("loses a travel of {:.6g} m per radian by friction "
                                    "(spool.friction_travel): expected at most half of its "
                                    "radius, {:.6g} m",
                                    travel, most_travel));
    const double farthest = (length + turns * drive.tendons[i].radius) * drive.axes[i].microsteps_a_metre() +
                            drive.axes[i].backlash_steps() + drive.axes[i].friction_steps(turns);
    if (farthest < max_position) continue;
    reader.problem_at(fmt::format("{}[{}]", path, i),
                      fmt::format("needs up to {:.1e} microsteps: expected less than {:.1e}; use a larger "
                                  "spool.radius, a smaller gear, or fewer steps or microsteps",
                                  farthest, max_position));
  }
}

Table<StepperMotor>& add_limits(Table<StepperMotor>& table) {
  return table
      .field("max_speed", &StepperMotor::max_speed,
             {.meaning = "Largest speed of the motor.",
              .unit = Unit::radian_per_second,
              .range = above(0),
              .default_text = "no limit"})
      .field("max_acceleration", &StepperMotor::max_acceleration,
             {.meaning = "Largest acceleration of the motor.",
              .unit = Unit::radian_per_second_squared,
              .range = above(0),
              .default_text = "no limit"})
      .field("max_step_rate", &StepperMotor::max_step_rate,
             {.meaning = "Largest microstep rate of the controller, 1/s.",
              .range = above(0),
              .default_text = "no limit"})
      .field("max_position", &StepperMotor::max_position,
             {.meaning = "Largest motor position in both directions, in microsteps. Position 0 is the "
                         "straight, unstretched arm.",
              .range = above(0),
              .default_text = "no limit"})
      .field(
          "pull_out", &StepperMotor::pull_out,
          {.meaning =
               "Pull-out torque as pairs [speed in rad/s, torque in N m], in the order of speed. "
               "Between the pairs, the torque is interpolated linearly. If a tendon of an elastic arm needs "
               "more torque, the motor loses steps.",
           .range = between(0, 1e9),
           .count = {1, 1000},
           .default_text = "no limit"});
}

}  // namespace

const Table<StepperMotor>& fields_of(const StepperMotor*) {
  static const auto table = [] {
    Table<StepperMotor> motor("motor", "A stepper motor and the limits of its controller.");
    motor.field("phases", &StepperMotor::phases, {.meaning = "Number of phases.", .range = between(2, 100)})
        .field("steps", &StepperMotor::steps,
               {.meaning = "Full steps per revolution, a multiple of the phases.", .range = between(2, 1e6)})
        .field("microsteps", &StepperMotor::microsteps,
               {.meaning = "Microsteps per full step.", .range = between(1, 1e5)});
    add_limits(motor);
    motor.check([](const StepperMotor& value, Reader& reader) {
      for (std::size_t i = 1; value.pull_out && i < value.pull_out->size(); ++i) {
        if ((*value.pull_out)[i][0] > (*value.pull_out)[i - 1][0]) continue;
        reader.problem_at(fmt::format("pull_out[{}]", i),
                          "expected a higher speed than in the previous pair");
        break;
      }
      if (value.steps % value.phases == 0) return;
      reader.problem_at("steps",
                        fmt::format("{} full steps per revolution of a motor with {} phases: expected a "
                                    "multiple of the phases",
                                    value.steps, value.phases));
    });
    return motor;
  }();
  return table;
}

const Table<Spool>& fields_of(const Spool*) {
  static const auto table =
      Table<Spool>("spool", "Spool that winds a tendon's cable, and gear between motor and spool.")
          .field("radius", &Spool::radius,
                 {.meaning = "Constant distance of the cable's middle from the spool's axis.",
                  .unit = Unit::metre,
                  .range = above_up_to(0, 1e3)})
          .field("gear", &Spool::gear,
                 {.meaning = "Gear ratio: motor turns per spool turn.", .range = above_up_to(0, 1e6)})
          .field("backlash", &Spool::backlash,
                 {.meaning = "Backlash between motor and spool, as an angle of the spool: after a reversal, "
                             "the first rotation by this angle does not move the cable.",
                  .unit = Unit::radian,
                  .range = between(0, 10)})
          .field("friction_travel", &Spool::friction_travel,
                 {.meaning = "Cable that the spool winds without effect on the arm after a reversal, because "
                             "the tendon has friction and stretches: length per radian of bend that the "
                             "tendon passes. At most half of the tendon's `radius`.",
                  .unit = Unit::metre,
                  .range = between(0, 1e3),
                  .default_text = "0: friction is not compensated"});
  return table;
}

const Table<TendonConfig>& fields_of(const TendonConfig*) {
  static const auto table =
      Table<TendonConfig>("tendon",
                          "A cable parallel to the backbone, from the arm's base to the end of one section, "
                          "and its motor axis.")
          .field("section", &TendonConfig::section,
                 {.meaning = "Section at the end of which the tendon ends, counted from 1 at the base.",
                  .range = between(1, 1e6),
                  .required = true})
          .field("angle", &TendonConfig::angle,
                 {.meaning = "Angle around the backbone, from the section's x towards its y.",
                  .unit = Unit::radian,
                  .range = angle_range,
                  .required = true})
          .field("radius", &TendonConfig::radius,
                 {.meaning = "Distance from the backbone.",
                  .unit = Unit::metre,
                  .range = above_up_to(0, 1e3),
                  .default_text = "the drive's"})
          .field("reversed", &TendonConfig::reversed,
                 {.meaning = "Whether positive microsteps let the cable out instead of pulling it in."})
          .field("motor", &TendonConfig::motor,
                 {.meaning = "Motor of this tendon. Omitted keys have the defaults of [drive.motor], not the "
                             "values written there.",
                  .default_text = "the drive's"})
          .field("spool", &TendonConfig::spool,
                 {.meaning = "Spool of this tendon. Omitted keys have the defaults of [drive.spool], not the "
                             "values written there.",
                  .default_text = "the drive's"});
  return table;
}

const Table<DriveConfig>& fields_of(const DriveConfig*) {
  static const auto table =
      Table<DriveConfig>("drive", "Tendon drive of the arm: spools turned by stepper motors.")
          .field("radius", &DriveConfig::radius,
                 {.meaning = "Distance of the tendons from the backbone. A `radius` of a single tendon "
                             "overrides this distance.",
                  .unit = Unit::metre,
                  .range = above_up_to(0, 1e3)})
          .field("disks", &DriveConfig::disks,
                 {.meaning = "Number of equal pieces into which guide disks divide each section. Tendons are "
                             "straight between disks.",
                  .range = between(1, 1e6),
                  .default_text = "none: a continuous channel"})
          .field("axes_per_controller", &DriveConfig::axes_per_controller,
                 {.meaning =
                      "Motors per controller. This number only affects the names of axes in command lists.",
                  .range = between(1, 1000)})
          .field("pretension", &DriveConfig::pretension,
                 {.meaning = "Tension of each tendon of an elastic arm if all motors are at position 0 and "
                             "the arm has no other loads, N.",
                  .range = between(0, 1e9)})
          .field("motor", &DriveConfig::motor, {.meaning = "Motors."})
          .field("spool", &DriveConfig::spool, {.meaning = "Spools and gears."})
          .field("tendon", &DriveConfig::tendon,
                 {.meaning = "Tendons in the order of their motor axes, as tables [[drive.tendon]].",
                  .count = {1, max_tendons},
                  .required = true});
  return table;
}

Drive DriveConfig::drive() const {
  Drive result;
  result.disks = disks;
  result.axes_per_controller = static_cast<std::size_t>(axes_per_controller);
  result.pretension = pretension;
  for (const TendonConfig& one : tendon) {
    result.tendons.push_back(
        {static_cast<std::size_t>(one.section - 1), one.radius.value_or(radius), one.angle});
    result.axes.push_back({one.motor.value_or(motor), one.spool.value_or(spool), one.reversed});
  }
  return result;
}

void check_drive(const DriveConfig& config, const ArmConfig& arm, const std::string& path, Reader& reader) {
  const auto sections = static_cast<std::int64_t>(arm.section.size());
  const std::string tendons = path + ".tendon";
  bool all_end = true;
  for (std::size_t i = 0; i < config.tendon.size(); ++i) {
    if (config.tendon[i].section <= sections) continue;
    all_end = false;
    reader.problem_at(
        fmt::format("{}[{}].section", tendons, i),
        fmt::format("{}: expected a section of the arm, 1 to {}", config.tendon[i].section, sections));
  }
  if (!all_end) return;
  const Drive drive = config.drive();
  for (std::size_t i = 0; i < arm.section.size(); ++i) check_section(drive, arm, i, tendons, reader);
  check_positions(drive, arm, tendons, reader);
}

}  // namespace flexura
