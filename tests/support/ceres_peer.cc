#include "tests/support/ceres_peer.h"

#include <ceres/ceres.h>
#include <ceres/normal_prior.h>
#include <ceres/rotation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace flexura {
namespace {

constexpr int camera_numbers = 24, sections = 3, arm_numbers = 2 * sections, pose_numbers = 2 * sections,
              stance_numbers = 2;

template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;
template <class T>
using Matrix3 = Eigen::Matrix<T, 3, 3>;

template <class T>
Matrix3<T> turn(const Vector3<T>& by) {
  Matrix3<T> R;
  ceres::AngleAxisToRotationMatrix(by.data(), R.data());  // Both matrices are stored by columns.
  return R;
}

// Known quantities of an observation. Ceres optimises corrections in units of their standard deviations.
struct Known {
  const RigModel* guess = nullptr;
  std::size_t camera = 0;
  RigStance stance;
  ArmState pose;
  std::array<double, camera_numbers> camera_sigmas{};
  std::array<double, arm_numbers> arm_sigmas{};
  std::array<double, pose_numbers> pose_sigmas{};
  std::array<double, stance_numbers> stance_sigmas{};
};

// Returns the orientation of the camera and the position of its pupil in W.
template <class T>
std::pair<Matrix3<T>, Vector3<T>> camera_pose(const Known& known, const T* z, const T* stance) {
  const CameraConfig& camera = known.guess->cameras[known.camera];
  std::array<T, camera_numbers> x{};
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = known.camera_sigmas[i] * z[i];
  const Pose X_WM = camera.mount.pose();
  const Matrix3<T> R_WM = turn(Vector3<T>(x[3], x[4], x[5])) * X_WM.rotation.cast<T>();
  const Vector3<T> p_WM = X_WM.position.cast<T>() + Vector3<T>(x[0], x[1], x[2]);
  const HeadConfig& head = camera.head;
  const T pan = x[6] + head.pan.zero + known.stance.head.pan + known.stance_sigmas[0] * stance[0];
  const T tilt = x[7] + head.tilt.zero + known.stance.head.tilt + known.stance_sigmas[1] * stance[1];
  const Matrix3<T> R_pan = turn(Vector3<T>(T(0), -pan, T(0))), R_tilt = turn(Vector3<T>(tilt, T(0), T(0)));
  const T forward = (head.pupil_shift + x[14]) * (known.stance.head.zoom - 1);
  const Vector3<T> axis(x[8] + head.tilt_axis[0], x[9] + head.tilt_axis[1], x[10] + head.tilt_axis[2]);
  const Vector3<T> pupil(x[11] + head.pupil[0], x[12] + head.pupil[1], x[13] + head.pupil[2] + forward);
  const Vector3<T> p_MC = known.stance.stage.offset.cast<T>() + R_pan * (axis + R_tilt * pupil);
  return {R_WM * R_pan * R_tilt, p_WM + R_WM * p_MC};
}

// Returns the position in W of the point at the share `fraction` of a section.
template <class T>
Vector3<T> arm_point(const Known& known, const T* arm, const T* pose, int section, double fraction) {
  const Arm& guess = known.guess->arm;
  Matrix3<T> R = guess.X_WB.rotation.cast<T>();
  Vector3<T> p = guess.X_WB.position.cast<T>();
  for (int i = 0; i <= section; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double share = i < section ? 1 : fraction;
    if (share == 0) break;
    const T length =
        share * known.pose.stretches[k] * guess.sections[k].length * exp(known.arm_sigmas[k] * arm[i]);
    const T gain = known.guess->bend_gains[k] + known.arm_sigmas[k + sections] * arm[i + sections];
    const T x = share * (gain * known.pose.bends[k].x() + known.pose_sigmas[2 * k] * pose[2 * k]);
    const T y = share * (gain * known.pose.bends[k].y() + known.pose_sigmas[2 * k + 1] * pose[2 * k + 1]);
    const T angle = sqrt(x * x + y * y), out = length * (1.0 - cos(angle)) / (angle * angle);
    p += R * Vector3<T>(out * x, out * y, length * sin(angle) / angle);
    R = R * turn(Vector3<T>(-y, x, T(0)));
  }
  return p;
}

// Projects a point of the arm into a picture.
struct Shows {
  Known known;
  int section = 0;
  double fraction = 0;

  template <class T>
  bool operator()(const T* camera, const T* arm, const T* pose, const T* stance, T* pixel) const {
    const auto [R_WC, p_WC] = camera_pose(known, camera, stance);
    const Vector3<T> p = R_WC.transpose() * (arm_point(known, arm, pose, section, fraction) - p_WC);
    if (p.z() <= T(0)) return false;
    const T a = p.x() / p.z(), b = p.y() / p.z(), r = a * a + b * b;
    const LensConfig& lens = known.guess->cameras[known.camera].lens;
    const SensorConfig& sensor = known.guess->cameras[known.camera].sensor;
    const auto number = [&](std::size_t i) { return known.camera_sigmas[i] * camera[i]; };
    const T k1 = number(19) + lens.distortion[0], k2 = number(20) + lens.distortion[1],
            p1 = number(21) + lens.distortion[2], p2 = number(22) + lens.distortion[3],
            k3 = number(23) + lens.distortion[4];
    const T radial = 1.0 + r * (k1 + r * (k2 + r * k3));
    const T fx = lens.fx * known.stance.head.zoom * exp(number(15));
    const T fy = lens.fy.value_or(lens.fx) * known.stance.head.zoom * exp(number(15) + number(16));
    const double cx = lens.cx.value_or(0.5 * static_cast<double>(sensor.width - 1)),
                 cy = lens.cy.value_or(0.5 * static_cast<double>(sensor.height - 1));
    pixel[0] = fx * (a * radial + 2.0 * p1 * a * b + p2 * (r + 2.0 * a * a)) + cx + number(17);
    pixel[1] = fy * (b * radial + p1 * (r + 2.0 * b * b) + 2.0 * p2 * a * b) + cy + number(18);
    return true;
  }
};

struct MarkerOff {
  Shows shows;
  SeenMarker seen;

  template <class T>
  bool operator()(const T* camera, const T* arm, const T* pose, const T* stance, T* off) const {
    if (!shows(camera, arm, pose, stance, off)) return false;
    for (int i = 0; i < 2; ++i) off[i] = (off[i] - seen.pixel[i]) / seen.sigma;
    return true;
  }
};

// A block of parameters in units of their standard deviations. The residuals of the prior are the parameters
// themselves.
struct Block {
  std::vector<double> z, sigmas;

  template <std::size_t n>
  void set(const std::array<double, n>& known) {
    z.assign(n, 0), sigmas.assign(known.begin(), known.end());
  }
};

class Own {
 public:
  Own(const RigModel& guess, const RigPrior& prior, const RigObservations& seen)
      : seen_(seen),
        cameras_(guess.cameras.size()),
        poses_(seen.poses.size()),
        stances_(seen.stances.size()) {
    known_.guess = &guess;
    for (std::size_t i = 0; i < cameras_.size(); ++i) cameras_[i].set(of_camera(prior.cameras[i]));
    for (std::size_t k = 0; k < sections; ++k)
      known_.arm_sigmas[k] = prior.arm.length, known_.arm_sigmas[k + sections] = prior.arm.bend_gain;
    arm_.set(known_.arm_sigmas);
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      std::array<double, pose_numbers> sigmas{};
      for (std::size_t k = 0; k < sigmas.size(); ++k)
        sigmas[k] = std::hypot(prior.arm.bend, prior.arm.bend_share * seen.poses[i].bends[k / 2].norm());
      poses_[i].set(sigmas);
    }
    for (std::size_t i = 0; i < stances_.size(); ++i) {
      const std::size_t camera = seen.stances[i].camera;
      const HeadConfig& head = guess.cameras[camera].head;
      const double steps = prior.cameras[camera].steps;
      stances_[i].set(std::array{steps * head.pan.resolution, steps * head.tilt.resolution});
    }
  }

  // Optimises from the present values. `bound` 0: squared loss.
  ceres::Solver::Summary solve(double bound) {
    ceres::Problem problem;
    add_all(problem, bound);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    options.max_num_iterations = 500;
    options.function_tolerance = 1e-16, options.gradient_tolerance = 1e-9,
    options.parameter_tolerance = 1e-12;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    return summary;
  }

  void report(double bound, CeresBundle& result) {
    ceres::Problem problem;
    add_all(problem, bound);
    ceres::Covariance::Options options;
    options.algorithm_type = ceres::DENSE_SVD;
    ceres::Covariance covariance(options);
    std::vector<const double*> blocks;
    std::vector<double> sigmas, x;
    for (Block* block : all()) {
      blocks.push_back(block->z.data());
      for (std::size_t i = 0; i < block->z.size(); ++i)
        sigmas.push_back(block->sigmas[i]), x.push_back(block->sigmas[i] * block->z[i]);
    }
    const auto count = static_cast<Eigen::Index>(x.size());
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> of_z(count, count);
    result.is_settled &=
        covariance.Compute(blocks, &problem) && covariance.GetCovarianceMatrix(blocks, of_z.data());
    std::vector<Eigen::Index> free;
    for (Eigen::Index i = 0; i < count; ++i)
      if (sigmas[static_cast<std::size_t>(i)] > 0) free.push_back(i);
    const auto scales = Eigen::Map<Eigen::VectorXd>(sigmas.data(), count);
    result.x = Eigen::Map<Eigen::VectorXd>(x.data(), count)(free);
    result.covariance = (scales.asDiagonal() * of_z * scales.asDiagonal())(free, free);
    for (std::size_t i = 0; i < stances_.size(); ++i) {
      const Known known = of(i, 0);
      result.axes.emplace_back(
          camera_pose(known, cameras_[known.camera].z.data(), stances_[i].z.data()).first.col(2));
    }
  }

 private:
  static std::array<double, camera_numbers> of_camera(const CameraPrior& prior) {
    std::array<double, camera_numbers> sigmas = {
        prior.position,  prior.position, prior.position,        prior.rotation,       prior.rotation,
        prior.rotation,  prior.pan_zero, prior.tilt_zero,       prior.tilt_axis,      prior.tilt_axis,
        prior.tilt_axis, prior.pupil,    prior.pupil,           prior.pupil,          prior.pupil_shift,
        prior.focal,     prior.aspect,   prior.principal_point, prior.principal_point};
    constexpr std::ptrdiff_t coefficients = 5;  // Of the lens model brown.
    std::copy_n(prior.distortion.begin(), coefficients, sigmas.begin() + 19);
    return sigmas;
  }

  [[nodiscard]] Known of(std::size_t stance, std::size_t pose) const {
    Known known = known_;
    known.stance = seen_.stances[stance], known.camera = known.stance.camera, known.pose = seen_.poses[pose];
    std::ranges::copy(cameras_[known.camera].sigmas, known.camera_sigmas.begin());
    std::ranges::copy(poses_[pose].sigmas, known.pose_sigmas.begin());
    std::ranges::copy(stances_[stance].sigmas, known.stance_sigmas.begin());
    return known;
  }

  std::vector<Block*> all() {
    std::vector<Block*> blocks;
    blocks.reserve(cameras_.size() + 1 + poses_.size() + stances_.size());
    for (Block& block : cameras_) blocks.push_back(&block);
    blocks.push_back(&arm_);
    for (Block& block : poses_) blocks.push_back(&block);
    for (Block& block : stances_) blocks.push_back(&block);
    return blocks;
  }

  void add_all(ceres::Problem& problem, double bound) {
    for (Block* block : all()) {
      const auto count = static_cast<int>(block->z.size());
      ceres::Vector none = ceres::Vector::Zero(count);
      problem.AddResidualBlock(new ceres::NormalPrior(ceres::Matrix::Identity(count, count), none), nullptr,
                               block->z.data());
    }
    const auto loss = [&]() -> ceres::LossFunction* {
      return bound > 0 ? new ceres::HuberLoss(bound) : nullptr;
    };
    for (const RigImage& image : seen_.images) {
      const Known known = of(image.stance, image.pose);
      double* const camera = cameras_[known.camera].z.data();
      double *const arm = arm_.z.data(), *const pose = poses_[image.pose].z.data(),
                    *const stance = stances_[image.stance].z.data();
      using Cost = ceres::AutoDiffCostFunction<MarkerOff, 2, camera_numbers, arm_numbers, pose_numbers,
                                               stance_numbers>;
      for (const SeenMarker& marker : image.markers)
        problem.AddResidualBlock(new Cost(new MarkerOff{shows(known, marker.s), marker}), loss(), camera, arm,
                                 pose, stance);
    }
  }

  static Shows shows(const Known& known, double s) {
    Shows shows{known};
    for (const Section& section : known.guess->arm.sections) {
      shows.fraction = s / section.length;
      if (s <= section.length * (1 + 1e-12) || shows.section == sections - 1) break;
      s -= section.length, ++shows.section;
    }
    return shows;
  }

  const RigObservations& seen_;
  Known known_;
  std::vector<Block> cameras_, poses_, stances_;
  Block arm_;
};

}  // namespace

CeresBundle ceres_bundle(const RigModel& guess, const RigPrior& prior, const RigObservations& seen,
                         double bound) {
  Own own(guess, prior, seen);
  CeresBundle result;
  (void)own.solve(0);
  const ceres::Solver::Summary summary = own.solve(bound);
  result.is_settled = summary.termination_type == ceres::CONVERGENCE;
  result.cost = summary.final_cost;
  own.report(bound, result);
  return result;
}

}  // namespace flexura
