#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "flexura/math/dormand_prince.h"
#include "flexura/math/pose.h"
#include "flexura/math/se3.h"
#include "flexura/math/so3.h"
#include "flexura/mechanics/rod.h"

namespace flexura {

/// An independent reference solver for rods, by shooting. It integrates the differential equations of a
/// Cosserat rod with tendons from the base with a guessed wrench of rod and tendons together. The guess is
/// corrected until the wrench at the tip equals the load there. Source: D. C. Rucker, R. J. Webster III,
/// "Statics and dynamics of continuum robots with general tendon routing and external loading", 2011. It
/// shares no modes, nodes or series with flexura/mechanics. Tendons run in channels.
class ShootingRod {
 public:
  struct Shot {
    bool hit = false;
    Pose tip;
    std::vector<double> lengths;  // Tendon lengths, m.
    Vector6d base_wrench = Vector6d::Zero();
    double miss = 0;  // Wrench error at the tip, N; moments are divided by the length.
  };

  ShootingRod(const Rod& rod, std::vector<double> tensions, RodLoads loads)
      : rod_(rod), tensions_(std::move(tensions)), loads_(std::move(loads)) {}

  /// Solves from a guess of the base wrench about the origin.
  Shot shoot(const Vector6d& guess, int most = 30) {
    Shot shot;
    Vector6d wrench = guess;
    Vector6d miss = fly(wrench, shot);
    for (int i = 0; i < most && miss.allFinite(); ++i) {
      shot.miss = miss.norm();
      if (shot.miss < hit_) {
        shot.hit = true;
        break;
      }
      Matrix6d by_wrench;
      const double size = 1e-6 * std::max(1e-3, scaled(wrench).norm());
      for (int c = 0; c < 6; ++c) {
        Shot ignored;
        Vector6d plus = Vector6d::Zero();
        plus[c] = c < 3 ? size : size * rod_.length();
        by_wrench.col(c) = (fly(wrench + plus, ignored) - fly(wrench - plus, ignored)) / (2 * plus[c]);
      }
      const Vector6d step = -by_wrench.partialPivLu().solve(miss);
      double part = 1;
      for (; part > 1e-3; part *= 0.5) {
        const Vector6d next = fly(wrench + part * step, shot);
        if (next.allFinite() && next.norm() < miss.norm()) {
          miss = next;
          break;
        }
      }
      if (part <= 1e-3) break;
      wrench += part * step;
    }
    shot.base_wrench = wrench;
    return shot;
  }

 private:
  static constexpr double hit_ = 1e-9;

  [[nodiscard]] Vector6d scaled(const Vector6d& wrench) const {
    Vector6d result = wrench;
    result.tail<3>() /= rod_.length();
    return result;
  }

  // Returns the wrench of the strained rod and its tendons on a cross-section, in its frame.
  Vector6d wrench_of(const RodSection& section, std::size_t index, double t, double s,
                     const Vector6d& strain) const {
    Vector6d wrench = section.stiffness_at(t).cwiseProduct(strain - section.rest_strain_at(t));
    for (std::size_t i = 0; i < tensions_.size(); ++i) {
      if (rod_.tendons[i].section < index) continue;
      const TendonRoute::Offset at = rod_.tendons[i].at(s);
      const Eigen::Vector3d along =
          (strain.head<3>() + strain.tail<3>().cross(at.value) + at.slope).normalized() * tensions_[i];
      wrench.head<3>() += along;
      wrench.tail<3>() += at.value.cross(along);
    }
    return wrench;
  }

  // Returns the strain at which the section carries the given wrench.
  Vector6d strain_for(const RodSection& section, std::size_t index, double t, double s,
                      const Vector6d& wrench, Vector6d strain) const {
    const auto counts = section.modes.counts();
    for (int i = 0; i < 20; ++i) {
      Vector6d excess = wrench_of(section, index, t, s, strain) - wrench;
      Matrix6d slope;
      for (int c = 0; c < 6; ++c) {
        Vector6d plus = strain, minus = strain;
        const double step = c < 3 ? 1e-6 : 1e-4;
        plus[c] += step;
        minus[c] -= step;
        slope.col(c) =
            (wrench_of(section, index, t, s, plus) - wrench_of(section, index, t, s, minus)) / (2 * step);
      }
      for (int c = 0; c < 6; ++c) {
        if (counts[static_cast<std::size_t>(c)] > 0) continue;  // This strain is fixed.
        slope.row(c).setZero();
        slope(c, c) = 1;
        excess[c] = strain[c] - section.rest_strain_at(t)[c];
      }
      const Vector6d change = slope.partialPivLu().solve(excess);
      strain -= change;
      if (change.cwiseAbs().maxCoeff() < 1e-11) break;
    }
    return strain;
  }

  // Integrates from the base to the tip and returns the wrench error there.
  Vector6d fly(const Vector6d& wrench, Shot& shot) const {
    const auto count = static_cast<Eigen::Index>(tensions_.size());
    Eigen::VectorXd y = Eigen::VectorXd::Zero(18 + count);  // State vector: p, R, N, M, tendon lengths.
    Eigen::Map<Eigen::Matrix3d>(y.data() + 3).setIdentity();
    y.segment<6>(12) = wrench;
    double s_base = 0;
    OdeTolerance tolerance{.relative = 1e-11, .absolute = 1e-12, .first_step = 0.01 * rod_.length()};
    tolerance.most_steps = 20000;
    for (std::size_t index = 0; index < rod_.sections.size(); ++index) {
      const RodSection& section = rod_.sections[index];
      std::vector<std::pair<double, PointMass>> masses;
      for (const PointMass& mass : section.masses) masses.emplace_back(mass.at, mass);
      std::ranges::stable_sort(masses, {}, &std::pair<double, PointMass>::first);
      Vector6d strain = section.rest_strain_at(0);
      const auto slope = [&](double s, const Eigen::VectorXd& at, Eigen::VectorXd& by) {
        const Eigen::Map<const Eigen::Matrix3d> R(at.data() + 3);
        const double t = std::clamp((s - s_base) / section.length, 0.0, 1.0);
        Vector6d body;
        body << R.transpose() * at.segment<3>(12), R.transpose() * at.segment<3>(15);
        strain = strain_for(section, index, t, s, body, strain);
        by.setZero(at.size());
        const Eigen::Vector3d p_slope = R * strain.head<3>();
        by.segment<3>(0) = p_slope;
        Eigen::Map<Eigen::Matrix3d>(by.data() + 3) = R * skew(strain.tail<3>());
        by.segment<3>(12) = -(section.mass_per_length_at(t) * loads_.gravity + loads_.per_length);
        by.segment<3>(15) = -p_slope.cross(Eigen::Vector3d(at.segment<3>(12)));
        for (std::size_t i = 0; i < tensions_.size(); ++i) {
          if (rod_.tendons[i].section < index) continue;
          const TendonRoute::Offset offset = rod_.tendons[i].at(s);
          by[18 + static_cast<Eigen::Index>(i)] =
              (strain.head<3>() + strain.tail<3>().cross(offset.value) + offset.slope).norm();
        }
      };
      DormandPrince solver(y.size(), tolerance);
      double s = s_base;
      masses.emplace_back(1, PointMass{});  // End of the section.
      for (const auto& [at, mass] : masses) {
        if (!solver.advance(slope, s, y, s_base + at * section.length).is_there)
          return Vector6d::Constant(std::nan(""));
        const Eigen::Map<const Eigen::Matrix3d> R(y.data() + 3);
        const Eigen::Vector3d force = mass.mass * loads_.gravity;
        y.segment<3>(12) -= force;
        y.segment<3>(15) -= (R * mass.offset).cross(force);
      }
      const Eigen::Map<const Eigen::Matrix3d> R(y.data() + 3);
      for (const EndLoad& end : loads_.ends) {
        if (end.section != index) continue;
        y.segment<3>(12) -= end.following ? Eigen::Vector3d(R * end.force) : end.force;
        y.segment<3>(15) -= end.following ? Eigen::Vector3d(R * end.moment) : end.moment;
      }
      s_base += section.length;
    }
    shot.tip = {Eigen::Map<const Eigen::Matrix3d>(y.data() + 3), y.head<3>()};
    shot.lengths.assign(y.data() + 18, y.data() + y.size());
    return scaled(y.segment<6>(12));
  }

  Rod rod_;
  std::vector<double> tensions_;
  RodLoads loads_;
};

}  // namespace flexura
