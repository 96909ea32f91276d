#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "flexura/base/degree.h"
#include "flexura/base/reader.h"
#include "flexura/calibrate/etalon_figure.h"
#include "flexura/kinematics/shape.h"
#include "flexura/rig/setup.h"
#include "flexura/tasks/calibrate/calibrate_config.h"
#include "flexura/tasks/camera_names.h"

namespace flexura {
namespace {

bool is_plain_file(const std::string& name) {
  const bool is_plain = std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.';
  });
  return is_plain && name.size() > 5 && name.ends_with(".toml") && name.front() != '.';
}

void check_markers(const ArmConfig& arm, const std::string& path, Reader& reader) {
  constexpr std::size_t fewest = 4;
  if (arm.look.markers(arm.arm()).size() < fewest)
    reader.problem_at(
        path,
        fmt::format("this method needs at least {} markers on the arm to identify positions along the arm: "
                    "expected arm.look.bands or arm.look.marker",
                    fewest));
}

// Checks that the cylinder is alone and upright.
void check_etalon(const CalibrateTask& task, const StandConfig& stand, const std::string& path,
                  Reader& reader) {
  if (!stand.etalon) {
    reader.problem_at(path, "this method needs the calibration cylinder: expected [stand.etalon]");
    return;
  }
  if (stand.arm)
    reader.problem_at(path,
                      "this method needs a scene with the calibration cylinder but without the arm: expected "
                      "stand.arm = false");
  constexpr double upright = 0.01;  // In m, for half a height of 1 m.
  EtalonConfig unit = *stand.etalon;
  unit.position = {0, 0, 0}, unit.height = 2;
  if ((EtalonFigure(unit).middle() - Eigen::Vector3d::UnitY()).norm() > upright)
    reader.problem_at(
        path,
        "this method needs an upright cylinder: expected a rotation about Y only in stand.etalon.rotation");
  if (!is_loop(task)) {
    if (!task.pose.empty() || task.zooms != CalibrateTask{}.zooms)
      reader.problem_at(path,
                        "this method uses neither poses nor zooms: expected neither key pose nor key zooms");
  } else if (!task.pose.empty() || task.target || !task.stages) {
    reader.problem_at(
        path,
        "this method uses neither poses nor a target, and always moves the stages: expected none "
        "of the keys pose, target and stages");
  }
}

void check_arcs(const CalibrateTask& task, const ArmConfig& arm, const std::string& path, Reader& reader) {
  if (arm.mechanics != ArmMechanics::kinematic)
    reader.problem_at(
        path + ".method",
        "this method needs an arm model of arcs, but an elastic arm sags: expected the method bundle, or the "
        "elastic arm only in [truth.arm]");
  constexpr std::size_t arcs = 4;
  if (calibration_poses(task, arm.arm()).size() < arcs)
    reader.problem_at(
        path,
        fmt::format("this method needs an arm that can bend into arcs of {:.0f} deg in the planes XOY and "
                    "ZOY: expected a spatial, upright arm, or a smaller loop.arc",
                    arc_bend(task) / degree));
  if (!task.pose.empty() || task.target || !task.stages)
    reader.problem_at(
        path,
        "this method uses neither poses nor a target, and always moves the stages: expected none "
        "of the keys pose, target and stages");
}

// Refuses keys of other methods, which would have no effect.
void check_idle_keys(const CalibrateTask& task, const std::string& path, Reader& reader) {
  const auto refuse = [&](const char* key, bool is_given, const char* whose) {
    if (is_given)
      reader.problem_at(path + key, fmt::format("this key applies only to {}: expected no such key", whose));
  };
  const CalibrateTask usual;
  const CalibrateLoopConfig &loop = task.loop, &loop_usual = usual.loop;
  const bool is_counting = task.method == CalibrateMethod::etalon_paper;
  refuse(".loop.turn", !is_counting && loop.turn != loop_usual.turn, "the method etalon-paper");
  refuse(".loop.slide", !is_counting && loop.slide != loop_usual.slide, "the method etalon-paper");
  refuse(".loop.zoom_step", !is_counting && loop.zoom_step != loop_usual.zoom_step,
         "the method etalon-paper");
  refuse(".loop.arc", is_before_etalon(task) && loop.arc.has_value(), "the methods arcs and arcs-paper");
  refuse(".zooms", task.zooms != usual.zooms, "the method bundle");
  if (task.method != CalibrateMethod::arcs) return;
  constexpr const char* bundles = "the methods bundle and bundle-etalon";
  refuse(".camera_prior.focal_std", task.camera_prior.focal_std != usual.camera_prior.focal_std, bundles);
  refuse(".camera_prior.principal_point_std",
         task.camera_prior.principal_point_std != usual.camera_prior.principal_point_std, bundles);
  refuse(".camera_prior.zero_std", task.camera_prior.zero_std != usual.camera_prior.zero_std, bundles);
}

// Checks everything that needs no shape of the arm.
void check_calibration(const CalibrateTask& task, const ArmConfig& arm,
                       const std::vector<CameraConfig>& cameras, const StandConfig& stand,
                       const std::string& path, Reader& reader) {
  check_two_cameras(task.cameras, cameras, path, reader);
  for (std::size_t i = 0; i < task.pose.size(); ++i)
    check_shape(task.pose[i], arm.kind, arm.section.size(), fmt::format("{}.pose[{}]", path, i), reader);
  const bool is_bundle = !is_loop(task);
  if (!is_bundle && task.required_std != CalibrateRequiredStd{})
    reader.problem_at(path + ".required_std",
                      "this key applies only to the methods bundle and bundle-etalon: expected no such key");
  if (!is_bundle && task.method != CalibrateMethod::arcs && task.camera_prior != CalibrateCameraPrior{})
    reader.problem_at(
        path + ".camera_prior",
        "this key applies only to the methods bundle, bundle-etalon and arcs: expected no such key");
  if (task.method != CalibrateMethod::bundle && task.arm_prior != CalibrateArmPrior{})
    reader.problem_at(path + ".arm_prior",
                      "this key applies only to the method bundle: expected no such key");
  if (is_bundle && task.loop != CalibrateLoopConfig{})
    reader.problem_at(path + ".loop", "this key applies only to the paper's methods: expected no such key");
  if (!is_bundle) check_idle_keys(task, path, reader);
  if (task.method == CalibrateMethod::bundle || task.method == CalibrateMethod::arcs)
    check_markers(arm, path, reader);
  if (is_loop(task) && !is_before_etalon(task)) check_arcs(task, arm, path, reader);
  if (is_before_etalon(task)) check_etalon(task, stand, path, reader);
  if (!task.save.empty() && !is_plain_file(task.save))
    reader.problem_at(
        path + ".save",
        fmt::format("{}: expected a file name made of letters, digits, -, _ and ., ending in .toml",
                    Node{task.save, {}}.brief()));
}

}  // namespace

void check_keys(const CalibrateTask& task, const Setup& setup, const std::string& path, Reader& reader) {
  const std::size_t before = reader.problems().size();
  check_calibration(task, setup.arm, setup.cameras(), setup.stand, path, reader);
  if (reader.problems().size() > before) return;  // From here on, poses fit the arm.
  const Arm arm = setup.arm.arm();
  for (std::size_t i = 0; i < task.pose.size(); ++i)
    check_bends(arm, task.pose[i], fmt::format("{}.pose[{}]", path, i), reader);
}

}  // namespace flexura
