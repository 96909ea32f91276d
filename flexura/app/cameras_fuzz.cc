// Fuzzes files of measured cameras with any text. A text is rejected with an error at a place in the file, or
// gives cameras. Their orientations must be rotations, projecting and unprojecting must agree, and writing
// and rereading must preserve them.
#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/app/estimate.h"
#include "flexura/base/node.h"
#include "flexura/base/source.h"
#include "flexura/base/table.h"
#include "flexura/camera/measured_camera.h"
#include "flexura/camera/view.h"
#include "flexura/store/toml.h"

namespace {

using flexura::MeasuredCamera, flexura::MeasuredCameras;

void require(bool holds) {
  if (!holds) std::abort();
}

std::vector<MeasuredCamera> read(const std::string& text, std::size_t count) {
  return flexura::standing_cameras(flexura::parse_toml(text, "cameras.toml"), count);
}

// Returns the number of pictures for which the file is accepted.
std::size_t count_of(const std::string& text) {
  const flexura::Node file = flexura::parse_toml(text, "cameras.toml");
  const flexura::Node* cameras = file.find("camera");
  const auto* list = cameras == nullptr ? nullptr : cameras->as<flexura::Node::Array>();
  return list == nullptr ? 2 : list->size();
}

void check_view(const MeasuredCamera& camera) {
  const flexura::View view{.lens = camera.lens(), .X_WC = camera.pose()};
  const Eigen::Matrix3d& R = view.X_WC.rotation;
  require((R.transpose() * R - Eigen::Matrix3d::Identity()).norm() < 1e-12 && R.determinant() > 0);
  require(view.X_WC.position.allFinite());
  const auto middle = view.project(view.X_WC.position + 2 * R.col(2));
  require(middle && (*middle - Eigen::Vector2d(camera.cx, camera.cy)).norm() < 1e-6 * (1 + camera.fx));
  for (const double u : {0.0, 200.0, 639.0}) {
    const Eigen::Vector2d pixel(u, 0.7 * u);
    const auto ray = view.lens.unproject(pixel);
    if (!ray) continue;
    const auto back = view.lens.project(ray->homogeneous());
    require(back &&
            (*back - pixel).norm() < 1e-6 * (1 + pixel.norm() + std::abs(camera.cx) + std::abs(camera.cy)));
  }
}

void check_written(const std::vector<MeasuredCamera>& cameras) {
  const MeasuredCameras file{cameras};
  const std::string text =
      flexura::write_toml(flexura::Codec<MeasuredCameras>::write(file), flexura::fields_of(&file).info());
  const auto again = read(text, cameras.size());
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const MeasuredCamera &one = cameras[i], &other = again[i];
    require(one.name == other.name && one.fx == other.fx && one.fy == other.fy && one.cx == other.cx &&
            one.cy == other.cy && one.distortion == other.distortion && one.position == other.position &&
            one.gamma == other.gamma && one.size == other.size &&
            one.prior.focal_std == other.prior.focal_std);
    require((one.pose().rotation - other.pose().rotation).norm() < 1e-12);
    require(std::abs(one.prior.rotation_std - other.prior.rotation_std) <= 1e-12 * one.prior.rotation_std);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 20000) return 0;
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const auto cameras = read(text, count_of(text));
    for (const MeasuredCamera& camera : cameras) check_view(camera);
    check_written(cameras);
  } catch (const flexura::InputError& error) {
    require(!error.problems().empty());
  }
  return 0;
}
