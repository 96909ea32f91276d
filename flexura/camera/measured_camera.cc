#include "flexura/camera/measured_camera.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <variant>

#include "flexura/base/table.h"
#include "flexura/camera/lens_ranges.h"

namespace flexura {
namespace {

using Rows = std::array<std::array<double, 3>, 3>;
using Quaternion = std::array<double, 4>;

// Tolerance for rotations written with four digits.
constexpr double largest_error = 2e-3;

Eigen::Matrix3d matrix_of(const Rows& rows) {
  Eigen::Matrix3d matrix;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) matrix(i, j) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  return matrix;
}

void check_measured_camera(const MeasuredCamera& camera, Reader& reader) {
  if (const std::string wrong = distortion_fault(camera.model, camera.distortion); !wrong.empty())
    reader.problem_at("distortion", wrong);
  if (camera.rotation.error() > largest_error) {
    reader.problem_at("rotation", fmt::format("not a rotation (error {:.2g}): expected the rows of "
                                              "a rotation matrix or a quaternion [w, x, y, z] of norm 1",
                                              camera.rotation.error()));
  }
}

void check_names(const MeasuredCameras& cameras, Reader& reader) {
  for (std::size_t i = 0; i < cameras.camera.size(); ++i)
    for (std::size_t k = 0; k < i && !cameras.camera[i].name.empty(); ++k)
      if (cameras.camera[k].name == cameras.camera[i].name)
        reader.problem_at(fmt::format("camera[{}].name", i),
                          fmt::format("is also the name of camera[{}]: expected another name", k));
}

}  // namespace

double RotationConfig::error() const {
  if (const auto* rows = std::get_if<Rows>(&value)) {
    const Eigen::Matrix3d R = matrix_of(*rows);
    return (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() +
           std::abs(R.determinant() - 1);
  }
  const auto& q = std::get<Quaternion>(value);
  return std::abs(std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]) - 1);
}

Eigen::Matrix3d RotationConfig::matrix() const {
  if (const auto* rows = std::get_if<Rows>(&value)) {
    // The nearest rotation, by way of the quaternion.
    return Eigen::Quaterniond(matrix_of(*rows)).normalized().toRotationMatrix();
  }
  const auto& q = std::get<Quaternion>(value);
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

Type Codec<RotationConfig>::type() {
  return {.kind = Type::Kind::array, .item = std::make_shared<const Type>(Codec<double>::type())};
}

bool Codec<RotationConfig>::read(const Node& node, const Spec& spec, Reader& reader, RotationConfig& value) {
  const auto* entries = node.as<Node::Array>();
  if (entries != nullptr && entries->size() == 4)
    return Codec<Quaternion>::read(node, spec, reader, value.value.emplace<Quaternion>());
  const auto is_row = [](const Node& entry) { return entry.as<Node::Array>() != nullptr; };
  if (entries != nullptr && entries->size() == 3 && std::ranges::any_of(*entries, is_row))
    return Codec<Rows>::read(node, spec, reader, value.value.emplace<Rows>());
  reader.unexpected(node, "three rows of three numbers, or a quaternion [w, x, y, z]");
  return false;
}

Node Codec<RotationConfig>::write(const RotationConfig& value) {
  return std::visit(
      [](const auto& written) { return Codec<std::decay_t<decltype(written)>>::write(written); },
      value.value);
}

Lens MeasuredCamera::lens() const {
  return Lens(
      {.fx = fx, .fy = fy.value_or(fx), .cx = cx, .cy = cy, .distortion = distortion_of(model, distortion)});
}

Pose MeasuredCamera::pose() const { return {rotation.matrix(), {position[0], position[1], position[2]}}; }

std::optional<std::string> MeasuredCamera::other_size(int width, int height) const {
  if (!size || *size == std::array<std::int64_t, 2>{width, height}) return std::nullopt;
  return fmt::format("{} x {} px: expected {} x {} px, the size of camera {} in the file of cameras", width,
                     height, (*size)[0], (*size)[1], Node{name, {}}.brief());
}

const Table<ViewPrior>& fields_of(const ViewPrior*) {
  using C = ViewPrior;
  static const Table<C> table =
      Table<C>("prior",
               "Prior standard deviations of the errors of a camera's description. With a prior, these "
               "errors are estimated together with the shape.")
          .field("rotation_std", &C::rotation_std,
                 {.meaning = "Standard deviation of the orientation, about each axis.",
                  .unit = Unit::radian,
                  .range = between(0, 0.3)})
          .field("focal_std", &C::focal_std,
                 {.meaning = "Relative standard deviation of the focal length.", .range = between(0, 0.3)})
          .renamed("turn", "rotation_std")
          .renamed("focal", "focal_std");
  return table;
}

const Table<MeasuredCamera>& fields_of(const MeasuredCamera*) {
  using C = MeasuredCamera;
  static const Table<C> table =
      Table<C>("camera", "A fixed, measured camera.")
          .field("name", &C::name, {.meaning = "Name of the camera in messages."})
          .field("fx", &C::fx,
                 {.meaning = "Focal length along u, px.", .range = focal_length_range, .required = true})
          .field("fy", &C::fy,
                 {.meaning = "Focal length along v, px.", .range = focal_length_range, .default_text = "fx"})
          .field("cx", &C::cx,
                 {.meaning = "Column of the principal point, px; 0 is the middle of the leftmost pixel.",
                  .range = principal_point_range,
                  .required = true})
          .field("cy", &C::cy,
                 {.meaning = "Row of the principal point, px; 0 is the middle of the topmost pixel.",
                  .range = principal_point_range,
                  .required = true})
          .field("model", &C::model, {.meaning = lens_model_meaning})
          .field("distortion", &C::distortion, distortion_spec(distortion_meaning, "zeros"))
          .field("position", &C::position,
                 {.meaning = "Position of the entrance pupil in the world.", .unit = Unit::metre})
          .field("rotation", &C::rotation,
                 {.meaning = "Rotation from the camera's frame (x right, y down, z forward) to the world: "
                             "three rows of a matrix, or a quaternion [w, x, y, z]."})
          .field("gamma", &C::gamma,
                 {.meaning = "Gamma of the pictures: a pixel value is light to the power 1/gamma. Typical "
                             "values are 1 for measurement cameras and 2.2 for other cameras.",
                  .range = between(0.1, 10)})
          .field("size", &C::size,
                 {.meaning = "Width and height of the pictures, px. Pictures of another size are refused.",
                  .range = between(1, 65535),
                  .default_text = "any"})
          .field("prior", &C::prior,
                 {.meaning = "Prior standard deviations of orientation and focal length.",
                  .default_text = "exact"})
          .renamed("doubt", "prior")
          .check(check_measured_camera);
  return table;
}

const Table<MeasuredCameras>& fields_of(const MeasuredCameras*) {
  static const Table<MeasuredCameras> table =
      Table<MeasuredCameras>("cameras", "Measured cameras, one per picture.")
          .field("camera", &MeasuredCameras::camera,
                 {.meaning = "Cameras, in the order of the pictures.", .count = {1, 64}, .required = true})
          .check(check_names);
  return table;
}

}  // namespace flexura
