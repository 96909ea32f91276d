#include "flexura/tasks/dynamics/dynamics_task_config.h"

#include "flexura/base/table.h"
#include "flexura/tasks/shape_fields.h"

namespace flexura {
namespace {

constexpr double longest_motion = 1e4;  // s
constexpr std::size_t most_angles = 10000;
constexpr NumberRange amount = {.min = 0, .max = 1e6};
constexpr NumberRange gain = {.min = -1e6, .max = 1e6};

}  // namespace

const std::vector<std::string>& names_of(const ElasticityRule*) {
  static const std::vector<std::string> names{"cancelled", "shaped", "ignored"};
  return names;
}

const std::vector<std::string>& names_of(const AngleBasis*) {
  static const std::vector<std::string> names{"polynomial", "sections"};
  return names;
}

const std::vector<std::string>& names_of(const DriveKind*) {
  static const std::vector<std::string> names{"everywhere", "torques", "moments"};
  return names;
}

const std::vector<std::string>& names_of(const AngleReading*) {
  static const std::vector<std::string> names{"angles", "planes"};
  return names;
}

const Table<DynamicsTargetConfig>& fields_of(const DynamicsTargetConfig*) {
  using Target = DynamicsTargetConfig;
  static const auto table =
      with_shape_fields(
          Table<Target>(
              "target",
              "Target shape of the law, given by bends or by the two angles of the arm's direction."))
          .field("azimuths", &Target::azimuths,
                 {.meaning = "Azimuths theta of the arm's direction from +Y towards +X, at evenly spaced "
                             "points from base to tip. The first azimuth is that of the base. "
                             "Successive azimuths differ by at most half a turn.",
                  .unit = Unit::radian,
                  .range = between(-50, 50),
                  .count = {2, most_angles},
                  .default_text = "not set"})
          .field(
              "elevations", &Target::elevations,
              {.meaning = "Elevations q of the arm's direction from the plane XOY towards +Z, at the same "
                          "points as `azimuths`. The magnitude of an elevation must be below a quarter turn.",
               .unit = Unit::radian,
               .range = angle_range,
               .count = {2, most_angles},
               .default_text = "not set"});
  return table;
}

const Table<PotentialConfig>& fields_of(const PotentialConfig*) {
  using P = PotentialConfig;
  static const auto table =
      Table<P>("law",
               "Gains of the artificial potential with gravity compensation and damping. The program also "
               "accepts gains that violate the conditions of the theory. The task then runs, and ends as "
               "failed with the reason.")
          .field(
              "stiffness", &P::stiffness,
              {.meaning = "Stiffness k of the potential for theta and q, N m per metre of arm and rad. One "
                          "number for both angles, or one per angle. The theory requires values above 0.",
               .range = gain,
               .one_for_all = true})
          .field("damping", &P::damping,
                 {.meaning = "Damping matrix K of the rates of (theta, q), N m s per metre of arm. The "
                             "theory requires a positive definite matrix.",
                  .range = gain})
          .field("length_stiffness", &P::length_stiffness,
                 {.meaning = "Stiffness k of the potential for each variable section length, N/m. The theory "
                             "requires a value above 0.",
                  .range = gain})
          .field("length_damping", &P::length_damping,
                 {.meaning = "Damping coefficient K of each variable section length, N s/m. The theory "
                             "requires a value above 0.",
                  .range = gain})
          .field("gravity_compensation", &P::gravity_compensation,
                 {.meaning = "Fraction of gravity that the law compensates. The theory requires 1.",
                  .range = between(-10, 10)})
          .field(
              "elasticity", &P::elasticity,
              {.meaning =
                   "Treatment of the arm's own elasticity: cancelled, part of the potential, or ignored. "
                   "The theory does not allow `ignored` if the target bends or stretches the elastic arm."})
          .field("drives", &P::drives,
                 {.meaning = "Actuators that apply the law's force: everywhere along the arm, a uniform "
                             "torque along each section, or a moment from each section's base to its end. "
                             "With torques or moments, the actuators apply the force nearest to the law's "
                             "force. With the basis \"sections\" this force is exact."})
          .field("sign", &P::sign,
                 {.meaning = "Sign of the potential's force: 1, or -1 to drive the arm away from the target.",
                  .range = between(-1, 1)});
  return table;
}

const Table<MeasurementConfig>& fields_of(const MeasurementConfig*) {
  using M = MeasurementConfig;
  static const auto table =
      Table<M>("measurement",
               "Measurement of the arm's angles. The potential and both compensations use the latest "
               "measurement; damping uses the true rates.")
          .field("reading", &M::reading,
                 {.meaning = "Measured quantity. `angles`: theta and q at each node. `planes`: each point of "
                             "the arm in two image planes. With `planes`, the potential's force uses the "
                             "angle errors in the two planes. Where these angles are undefined, points are "
                             "triangulated from both pictures."})
          .field("delay", &M::delay,
                 {.meaning = "Delay of a measurement.", .unit = Unit::second, .range = between(0, 60)})
          .field("noise", &M::noise,
                 {.meaning = "Standard deviation of each measured angle, independent for each measurement. "
                             "For planar arms, the elevation has no noise.",
                  .unit = Unit::radian,
                  .range = between(0, 10)})
          .field("step", &M::step,
                 {.meaning = "Time between measurements.",
                  .unit = Unit::second,
                  .range = between(1e-4, 10),
                  .default_text = "the clock's step"});
  return table;
}

const Table<DynamicsTask>& fields_of(const DynamicsTask*) {
  using T = DynamicsTask;
  static const auto table =
      Table<T>("dynamics",
               "Moves the arm by the forces of the paper's artificial potential. The arm is a continuum with "
               "mass, weight and elasticity; it starts at rest in its current shape. Drives, cameras and "
               "[truth] have no effect.")
          .field("name", &T::name, {.meaning = "Name of the task in results.", .default_text = "its kind"})
          .field("duration", &T::duration,
                 {.meaning = "Duration of the motion.",
                  .unit = Unit::second,
                  .range = above_up_to(0, longest_motion)})
          .field("target", &T::target,
                 {.meaning = "Target shape: either `target.bends_deg = [...]`, or both `target.azimuths_deg "
                             "= [...]` and `target.elevations_deg = [...]`.",
                  .required = true})
          .field("density", &T::density,
                 {.meaning = "Mass per length of the arm at rest, kg/m.", .range = between(1e-6, 1e6)})
          .field("gravity", &T::gravity,
                 {.meaning = "Gravity in the world's frame: X, Y, Z.",
                  .unit = Unit::metre_per_second_squared,
                  .range = between(-1e4, 1e4)})
          .field("bending_stiffness", &T::bending_stiffness,
                 {.meaning = "Bending stiffness EI, N m^2.", .range = amount})
          .field("axial_stiffness", &T::axial_stiffness,
                 {.meaning = "Axial stiffness EA of the sections, N; with variable_lengths only.",
                  .range = amount})
          .field("damping", &T::damping,
                 {.meaning = "Damping by the surrounding medium: power loss per metre of arm at a rotation "
                             "rate of 1 rad/s, W/m.",
                  .range = amount})
          .field("length_damping", &T::length_damping,
                 {.meaning = "Damping of the rates of variable lengths, N s/m.", .range = amount})
          .field("variable_lengths", &T::variable_lengths,
                 {.meaning = "Whether the law changes the lengths of the sections."})
          .field("basis", &T::basis,
                 {.meaning = "Function of arc length that represents each angle. `sections`: linear in every "
                             "section, which is an arc if the arm bends in one plane. `polynomial`: one "
                             "polynomial for the whole arm."})
          .field("nodes", &T::nodes,
                 {.meaning = "Number of nodes of each angle's polynomial.", .range = between(1, 16)})
          .field("law", &T::law, {.meaning = "Gains of the law."})
          .field("measurement", &T::measurement,
                 {.meaning = "Measurement of the arm's angles.", .default_text = "exact"})
          .field("tolerance", &T::tolerance,
                 {.meaning = "The task succeeds if the final value of the Lyapunov function W is at most "
                             "this fraction of the initial value.",
                  .range = above_up_to(0, 1)});
  return table;
}

}  // namespace flexura
