#include "flexura/app/intrinsics_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "flexura/base/source.h"
#include "flexura/base/table.h"
#include "flexura/experiment/experiment.h"
#include "flexura/math/arrays.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"
#include "flexura/store/toml.h"

namespace flexura {
namespace {

std::array<double, 3> array_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
std::array<double, 4> array_of(const Eigen::Vector4d& v) { return {v[0], v[1], v[2], v[3]}; }

void put_lens(const CalibratedCamera& camera, CameraConfig& config) {
  config.lens = camera.lens;
  config.sensor.width = camera.size[0], config.sensor.height = camera.size[1];
}

}  // namespace

const Table<RigFile>& fields_of(const RigFile*) {
  static const auto table =
      Table<RigFile>("rig", "Cameras that experiments can include.")
          .field("camera", &RigFile::camera, {.meaning = "The cameras.", .required = true})
          .check([](const RigFile& rig, Reader& reader) { check_cameras(rig.camera, "camera", reader); });
  return table;
}

LensConfig lens_config(const Intrinsics& lens) {
  return {.fx = lens.fx,
          .fy = lens.fy,
          .cx = lens.cx,
          .cy = lens.cy,
          .model = lens.distortion.model(),
          .distortion = lens.distortion,
          .zoom = {}};
}

ViewPrior view_prior_of(const IntrinsicsFit& fit, std::size_t camera) {
  // Scale of the sigmas: errors of one picture's corners are correlated (docs/intrinsics.md).
  constexpr double together = 3;
  constexpr double most = 0.3;  // Maximum that a file may give.
  const CameraFit& own = fit.cameras[camera];
  const auto [fx, fy] = std::pair(own.lens.fx, own.lens.fy);
  const double focal = std::max(own.sigma(0) / fx, own.sigma(1) / fy),
               aside = std::max(own.sigma(2) / fx, own.sigma(3) / fy),
               turn = std::sqrt(fit.pose_covariance[camera].diagonal().tail<3>().maxCoeff());
  return {.rotation_std = std::min(most, together * std::max(aside, turn)),
          .focal_std = std::min(most, together * focal)};
}

std::string measured_cameras_toml(const std::vector<CalibratedCamera>& cameras, const std::string& remark) {
  MeasuredCameras file;
  for (const CalibratedCamera& camera : cameras) {
    MeasuredCamera& written = file.camera.emplace_back();
    written.name = camera.name;
    written.fx = camera.lens.fx, written.fy = camera.lens.fy;
    written.cx = *camera.lens.cx, written.cy = *camera.lens.cy;
    written.model = camera.lens.model, written.distortion = camera.lens.distortion;
    written.size = {camera.size[0], camera.size[1]};
    written.position = array_of(camera.pose.position);
    written.rotation.value = array_of(quaternion_wxyz(camera.pose.rotation));
    written.prior = camera.view_prior;
  }
  return fmt::format("# {}\n", remark) +
         write_toml(Codec<MeasuredCameras>::write(file), fields_of(&file).info());
}

std::string rig_toml(const std::vector<CalibratedCamera>& cameras, const std::string& from,
                     const std::string& remark) {
  RigFile rig;
  if (!from.empty()) rig.camera = load_experiment(from).cameras();
  for (const CalibratedCamera& camera : cameras) {
    if (from.empty()) {
      CameraConfig& config = rig.camera.emplace_back();
      config.name = camera.name;
      config.mount.position = array_of(camera.pose.position);
      config.mount.rotation = array_of(quaternion_wxyz(camera.pose.rotation));
      put_lens(camera, config);
      continue;
    }
    const auto same = std::ranges::find(rig.camera, camera.name, &CameraConfig::name);
    if (same == rig.camera.end())
      throw input_error(
          from,
          fmt::format(
              "has no camera {}, which should get the lens: expected the name of one of its cameras (--name)",
              Node{camera.name, {}}.brief()));
    put_lens(camera, *same);
  }
  std::string text =
      fmt::format("# {}\n", remark) + write_toml(Codec<RigFile>::write(rig), fields_of(&rig).info());
  (void)read_as<RigFile>(parse_toml(text, "the rig file"));
  return text;
}

std::filesystem::path write_beside(const std::filesystem::path& desired, std::string_view text) {
  std::error_code error;
  for (int number = 1;; ++number) {
    std::filesystem::path file = desired;
    if (number > 1)
      file.replace_filename(
          fmt::format("{}-{}{}", desired.stem().string(), number, desired.extension().string()));
    // If the path cannot be checked, writing it fails with the system's error.
    const auto type = std::filesystem::symlink_status(file, error).type();
    if (!error && type != std::filesystem::file_type::not_found) continue;
    write_new_file(file, text);
    return file;
  }
}

Pose first_pose(const IntrinsicsArguments& arguments) {
  Pose X_WC;
  if (arguments.position.size() == 3) X_WC.position = Eigen::Vector3d(arguments.position.data());
  const auto& q = arguments.rotation;
  if (q.size() == 4) X_WC.rotation = rotation_of({q[0], q[1], q[2], q[3]});
  return X_WC;
}

std::vector<std::string> names_of_cameras(const IntrinsicsArguments& arguments,
                                          std::vector<std::string> usual) {
  if (arguments.names.empty()) return usual;
  if (arguments.names.size() != usual.size())
    throw input_error("--name", fmt::format("{} name{}: expected {}", arguments.names.size(),
                                            arguments.names.size() == 1 ? "" : "s", usual.size()));
  // Names are written to files that others include.
  for (std::size_t i = 0; i < usual.size(); ++i) {
    const bool is_plain = std::ranges::all_of(arguments.names[i], [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
             c == '_';
    });
    if (arguments.names[i].empty() || !is_plain ||
        std::ranges::count(arguments.names, arguments.names[i]) > 1)
      throw input_error("--name", fmt::format("{}: expected different names made of letters, digits, - and _",
                                              Node{arguments.names[i], {}}.brief()));
  }
  return arguments.names;
}

void write_files(const IntrinsicsArguments& arguments, const std::vector<CalibratedCamera>& cameras,
                 const FitRemarks& fit, Node::Table& answer) {
  const std::string remark = fmt::format(
      "Measured by flexura intrinsics: rms {:.4g} px over {} points of a board.", fit.rms, fit.points);
  std::string details = "\n# The estimates, as JSON:\n";
  for (const Node& one : fit.of_each) details += fmt::format("# {}\n", write_json(one));
  // Build both texts before writing either file.
  const std::string measured = arguments.out.empty() ? "" : measured_cameras_toml(cameras, remark) + details,
                    rig =
                        arguments.rig.empty() ? "" : rig_toml(cameras, arguments.rig_from, remark) + details;
  std::filesystem::path file;
  if (!measured.empty()) {
    file = write_beside(arguments.out, measured);
    answer.push_back({"file", {}, {file.string(), {}}});
  }
  if (rig.empty()) return;
  try {
    answer.push_back({"rig", {}, {write_beside(arguments.rig, rig).string(), {}}});
  } catch (...) {
    // Both files or neither: a failed run leaves nothing behind for the next one.
    std::error_code ignored;
    if (!file.empty()) std::filesystem::remove(file, ignored);
    throw;
  }
}

}  // namespace flexura
