#include "flexura/model/obstacle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "flexura/base/table.h"
#include "flexura/math/arrays.h"
#include "flexura/model/ranges.h"

namespace flexura {
namespace {

// Adds the fields that every obstacle has.
template <class S>
Table<S> obstacle_table(const char* kind, const char* meaning) {
  Table<S> table(kind, meaning);
  table
      .field("name", &S::name,
             {.meaning = "Name of the obstacle in messages.",
              .default_text = "its kind and position in the list"})
      .field(
          "ignore_base", &S::ignore_base,
          {.meaning = "Length of the part of the arm next to its base that may touch the obstacle, measured "
                      "along the unstretched arm. An example is an obstacle that is the arm's support.",
           .unit = Unit::metre,
           .range = between(0, 1e6)})
      .field("may_touch", &S::may_touch,
             {.meaning =
                  "Whether the whole arm may touch the obstacle, for example to grasp it or to lean on it."})
      .field("color", &S::color,
             {.meaning = "Fractions of red, green and blue light that the obstacle reflects. Dark obstacles "
                         "in front of the screens disturb the detection of a dark arm in pictures. Obstacles "
                         "with the default colour do not disturb it.",
              .range = share_range});
  return table;
}

Spec place(const char* meaning, bool required = true) {
  return {.meaning = meaning, .unit = Unit::metre, .range = coordinate_range, .required = required};
}

Spec size(const char* meaning) {
  return {.meaning = meaning, .unit = Unit::metre, .range = above_up_to(0, 1e6), .required = true};
}

std::function<double(const Eigen::Vector3d&)> distance_of(const PlaneConfig& plane) {
  return [p = vector(plane.point),
          n = vector(plane.normal).normalized()](const Eigen::Vector3d& q) -> double { return n.dot(q - p); };
}

std::optional<Eigen::Vector3d> normal_of(const PlaneConfig& plane) {
  return vector(plane.normal).normalized();
}

template <class Other>
std::optional<Eigen::Vector3d> normal_of(const Other&) {
  return std::nullopt;
}

std::function<double(const Eigen::Vector3d&)> distance_of(const SphereConfig& sphere) {
  return [c = vector(sphere.center), r = sphere.radius](const Eigen::Vector3d& q) -> double {
    return (q - c).norm() - r;
  };
}

std::function<double(const Eigen::Vector3d&)> distance_of(const CapsuleConfig& capsule) {
  return [a = vector(capsule.from), along = Eigen::Vector3d(vector(capsule.to) - vector(capsule.from)),
          r = capsule.radius](const Eigen::Vector3d& q) -> double {
    const double squared = along.squaredNorm();
    const double u = squared > 0 ? std::clamp((q - a).dot(along) / squared, 0.0, 1.0) : 0.0;
    return (q - a - u * along).norm() - r;
  };
}

std::function<double(const Eigen::Vector3d&)> distance_of(const BoxConfig& box) {
  const Eigen::Matrix3d R_WX = rotation_of(box.rotation);
  return [c = vector(box.center), half = vector(box.half_sizes), R_WX](const Eigen::Vector3d& p) -> double {
    const Eigen::Vector3d beyond = (R_WX.transpose() * (p - c)).cwiseAbs() - half;
    return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0);
  };
}

std::vector<Obstacle::Side> sides_of(const BoxConfig& box) {
  const Eigen::Matrix3d R_WX = rotation_of(box.rotation);
  std::vector<Obstacle::Side> sides;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      const Eigen::Vector3d normal = sign * R_WX.col(axis);
      sides.push_back({normal, normal.dot(vector(box.center)) + vector(box.half_sizes)[axis]});
    }
  }
  return sides;
}

template <class Other>
std::vector<Obstacle::Side> sides_of(const Other&) {
  return {};
}

}  // namespace

const Table<PlaneConfig>& fields_of(const PlaneConfig*) {
  static const auto table =
      obstacle_table<PlaneConfig>("plane", "A plane that the arm must not pass, such as the ground.")
          .field("point", &PlaneConfig::point, place("A point of the plane.", false))
          .field("normal", &PlaneConfig::normal,
                 {.meaning = "Normal of the plane, towards the side where the arm is. The length of the "
                             "normal must be above 0.",
                  .range = coordinate_range})
          .check([](const PlaneConfig& plane, Reader& reader) {
            if (!(vector(plane.normal).norm() > 0))
              reader.problem_at("normal", "has no direction: expected a vector other than 0");
          });
  return table;
}

const Table<SphereConfig>& fields_of(const SphereConfig*) {
  static const auto table = obstacle_table<SphereConfig>("sphere", "A sphere.")
                                .field("center", &SphereConfig::center, place("Centre."))
                                .field("radius", &SphereConfig::radius, size("Radius."));
  return table;
}

const Table<CapsuleConfig>& fields_of(const CapsuleConfig*) {
  static const auto table = obstacle_table<CapsuleConfig>("capsule", "A rod with hemispherical ends.")
                                .field("from", &CapsuleConfig::from, place("Start of the axis."))
                                .field("to", &CapsuleConfig::to, place("End of the axis."))
                                .field("radius", &CapsuleConfig::radius, size("Radius."));
  return table;
}

const Table<BoxConfig>& fields_of(const BoxConfig*) {
  static const auto table =
      obstacle_table<BoxConfig>("box", "A box.")
          .field("center", &BoxConfig::center, place("Centre."))
          .field("half_sizes", &BoxConfig::half_sizes,
                 size("Half of the edge lengths along the box's x, y and z."))
          .field("rotation", &BoxConfig::rotation,
                 {.meaning = "Unit quaternion (w, x, y, z) from the box's axes to the world.",
                  .range = between(-2, 2)})
          .check([](const BoxConfig& box, Reader& reader) {
            if (const std::string problem = quaternion_problem(box.rotation); !problem.empty())
              reader.problem_at("rotation", problem);
          });
  return table;
}

std::vector<Obstacle> obstacles(const std::vector<ObstacleConfig>& configs) {
  std::vector<Obstacle> result;
  for (const ObstacleConfig& config : configs) {
    std::visit(
        [&]<class One>(const One& one) {
          const std::string called = fmt::format("{} {}", Codec<One>::table().info().name, result.size() + 1);
          // An obstacle that may be touched is ignored along the whole arm.
          constexpr double all = 1e9;
          result.push_back({one.name.empty() ? called : one.name, one.may_touch ? all : one.ignore_base,
                            distance_of(one), normal_of(one), sides_of(one)});
        },
        config);
  }
  return result;
}

}  // namespace flexura
