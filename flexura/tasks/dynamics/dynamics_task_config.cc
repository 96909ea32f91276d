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
          Table<Target>("target",
                        "The shape that the law leads to, said in one way: by its bends, or by the two "
                        "angles of the arm's direction."))
          .field("azimuths", &Target::azimuths,
                 {.meaning =
                      "theta: the direction's angle from +Y towards +X, at equal shares of the length, "
                      "from the base, where it is the base's own, to the tip; by half a turn at most from "
                      "place to place.",
                  .unit = Unit::radian,
                  .range = between(-50, 50),
                  .count = {2, most_angles},
                  .default_text = "not set"})
          .field(
              "elevations", &Target::elevations,
              {.meaning = "q: its angle from the plane XOY towards +Z, at the same places; below a quarter "
                          "turn.",
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
               "Numbers of the artificial potential with gravity compensation and damping. What violates a "
               "condition of the theory is taken too; the run then shows what happens, and ends as failed, "
               "with the reason.")
          .field(
              "stiffness", &P::stiffness,
              {.meaning = "k of theta and of q, N m a metre of the arm and rad; by the theory above 0. One "
                          "for both, or one each.",
               .range = gain,
               .one_for_all = true})
          .field(
              "damping", &P::damping,
              {.meaning = "K of the rates of (theta, q), N m s a metre of the arm: a matrix, by the theory "
                          "positive definite.",
               .range = gain})
          .field("length_stiffness", &P::length_stiffness,
                 {.meaning = "k of each section's length, where lengths vary, N/m; above 0.", .range = gain})
          .field("length_damping", &P::length_damping,
                 {.meaning = "K of each section's length, N s/m; above 0.", .range = gain})
          .field("gravity_compensation", &P::gravity_compensation,
                 {.meaning = "How much of gravity is compensated, a share; by the theory 1.",
                  .range = between(-10, 10)})
          .field("elasticity", &P::elasticity,
                 {.meaning = "What the law does about the arm's own elasticity: cancels it, makes it part of "
                             "the potential, or ignores it, which the theory does not allow where the target "
                             "bends or stretches the arm."})
          .field("drives", &P::drives,
                 {.meaning = "What gives the arm the law's forces: drives everywhere along it, or a torque "
                             "alike along each section, or a moment from each section's base to its end. The "
                             "few give what is nearest to the law's force; with basis \"sections\" that is "
                             "all of it."})
          .field("sign", &P::sign,
                 {.meaning = "Of the potential's force: 1, or -1 to lead away from the target.",
                  .range = between(-1, 1)});
  return table;
}

const Table<MeasurementConfig>& fields_of(const MeasurementConfig*) {
  using M = MeasurementConfig;
  static const auto table =
      Table<M>("measurement",
               "How the law gets to know the arm's angles. The potential, gravity's compensation and that of "
               "elasticity go by what was measured last; the damping is of the arm's own rates.")
          .field("reading", &M::reading,
                 {.meaning = "What is read: theta and q themselves at each node, or what two image planes "
                             "show of each point of the arm; the potential's force is then that of the two "
                             "plane errors, and where these do not tell both pictures are triangulated."})
          .field("delay", &M::delay,
                 {.meaning = "How late measurements are.", .unit = Unit::second, .range = between(0, 60)})
          .field("noise", &M::noise,
                 {.meaning = "Standard deviation of each of the angles that are read, from measurement to "
                             "measurement; out of its plane a planar arm has none.",
                  .unit = Unit::radian,
                  .range = between(0, 10)})
          .field("step", &M::step,
                 {.meaning = "Time from one measurement to the next.",
                  .unit = Unit::second,
                  .range = between(1e-4, 10),
                  .default_text = "the clock's step"});
  return table;
}

const Table<DynamicsTask>& fields_of(const DynamicsTask*) {
  using T = DynamicsTask;
  static const auto table =
      Table<T>("dynamics",
               "The arm as a continuum with mass, weight and elasticity moves from where it is, at rest, by "
               "the forces of the paper's artificial potential. Drives, cameras and [truth] have no part in "
               "it.")
          .field("name", &T::name,
                 {.meaning = "What to call the task in results.", .default_text = "its kind"})
          .field("duration", &T::duration,
                 {.meaning = "How long the motion is followed.",
                  .unit = Unit::second,
                  .range = above_up_to(0, longest_motion)})
          .field("target", &T::target,
                 {.meaning = "Where to, as `target.bends_deg = [...]` or `target.azimuths_deg = [...]` and "
                             "`target.elevations_deg = [...]`.",
                  .required = true})
          .field("density", &T::density,
                 {.meaning = "Mass a length of the arm at rest, kg/m.", .range = between(1e-6, 1e6)})
          .field("gravity", &T::gravity,
                 {.meaning = "In the world, any direction.",
                  .unit = Unit::metre_per_second_squared,
                  .range = between(-1e4, 1e4)})
          .field("bending_stiffness", &T::bending_stiffness, {.meaning = "EI, N m^2.", .range = amount})
          .field("axial_stiffness", &T::axial_stiffness,
                 {.meaning = "EA, where lengths vary, N.", .range = amount})
          .field("damping", &T::damping,
                 {.meaning = "By the medium: of a length that turns by 1 rad/s it takes so many W/m.",
                  .range = amount})
          .field("length_damping", &T::length_damping,
                 {.meaning = "Of the lengths' rates, N s/m.", .range = amount})
          .field("variable_lengths", &T::variable_lengths,
                 {.meaning = "The sections' lengths change by the law, too; else they stay as they are."})
          .field("basis", &T::basis,
                 {.meaning = "What each angle is along the arm: linear in every section (arcs, where the arm "
                             "bends in one plane), or one polynomial."})
          .field("nodes", &T::nodes,
                 {.meaning = "Numbers of the polynomial, of each angle.", .range = between(1, 16)})
          .field("law", &T::law, {.meaning = "The law's numbers."})
          .field("measurement", &T::measurement,
                 {.meaning = "How the law gets to know the angles.", .default_text = "exactly"})
          .field("tolerance", &T::tolerance,
                 {.meaning = "The arm is there when no more than this share of W, as it was at the start, is "
                             "left at the end.",
                  .range = above_up_to(0, 1)});
  return table;
}

}  // namespace flexura
