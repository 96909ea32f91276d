#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "flexura/math/pose.h"
#include "flexura/math/se3.h"
#include "flexura/math/so3.h"
#include "flexura/mechanics/rod.h"

namespace flexura {

/// An independent reference for weightless rods whose tendons run straight between guide disks, by shooting
/// from disk to disk. Without friction a tendon has the same tension on both sides of a hole. So at a cut
/// between two disks the rod's own wrench and the tensions along the chords balance the load at the tip. Each
/// piece is a Cosserat rod under a constant wrench at its base, integrated by Runge and Kutta's method; the
/// wrench is corrected until the chords to the resulting next disk balance it. It shares no modes, nodes or
/// series with flexura/mechanics.
class ChordRod {
 public:
  /// `force`: dead, at the tip, in the base's frame, N. `steps`: of Runge and Kutta's method in a piece.
  ChordRod(Rod rod, std::vector<double> tensions, Eigen::Vector3d force, int steps = 32)
      : rod_(std::move(rod)), tensions_(std::move(tensions)), force_(std::move(force)), steps_(steps) {}

  /// Raises the load from zero in steps and returns the pose of the tip at full load; none where a step does
  /// not converge.
  std::optional<Pose> tip(int load_steps) {
    wrenches_.clear();
    at_ = Eigen::Vector3d(0, 0, rod_.length());
    std::optional<Pose> found;
    for (int step = 1; step <= load_steps; ++step) {
      found = aimed(static_cast<double>(step) / load_steps);
      if (!found) break;
    }
    return found;
  }

 private:
  static constexpr double settled_ = 1e-11;

  struct Piece {
    const RodSection* section;
    std::size_t index;
    double from, to, s_base;  // Parts of the section's length, and its arc length at the base.
  };

  static Vector6d wrench_at(const Eigen::Vector3d& at, const Eigen::Vector3d& force) {
    return (Vector6d() << force, at.cross(force)).finished();
  }

  // Returns the pose of the piece's end for the wrench of the rod at its base, in the base's frame.
  [[nodiscard]] Pose flown(const Piece& piece, const Vector6d& wrench) const {
    const auto counts = piece.section->modes.counts();
    Eigen::Matrix<double, 3, 4> y = Eigen::Matrix<double, 3, 4>::Zero();  // R, p.
    y.leftCols<3>().setIdentity();
    const auto slope = [&](double t, const Eigen::Matrix<double, 3, 4>& at) {
      const Eigen::Matrix3d R = at.leftCols<3>();
      const Eigen::Vector3d n = wrench.head<3>();
      Vector6d body;
      body << R.transpose() * n, R.transpose() * (wrench.tail<3>() - at.col(3).cross(n));
      Vector6d strain = piece.section->rest_strain_at(t);
      const Vector6d stiffness = piece.section->stiffness_at(t);
      for (int c = 0; c < 6; ++c)
        if (counts[static_cast<std::size_t>(c)] > 0) strain[c] += body[c] / stiffness[c];
      Eigen::Matrix<double, 3, 4> by;
      by << R * skew(strain.tail<3>()), R * strain.head<3>();
      return by;
    };
    const double part = (piece.to - piece.from) / steps_, h = part * piece.section->length;
    for (int i = 0; i < steps_; ++i) {
      const double t = piece.from + i * part;
      const Eigen::Matrix<double, 3, 4> a = slope(t, y), b = slope(t + 0.5 * part, y + 0.5 * h * a),
                                        c = slope(t + 0.5 * part, y + 0.5 * h * b),
                                        d = slope(t + part, y + h * c);
      y += h / 6 * (a + 2 * b + 2 * c + d);
    }
    return {y.leftCols<3>(), y.col(3)};
  }

  // Returns what is missing to the balance of the piece's cut at its base.
  [[nodiscard]] Vector6d miss(const Piece& piece, double share, const Pose& X, const Vector6d& wrench) const {
    const Pose end = flown(piece, wrench);
    const double length = piece.section->length;
    Vector6d sum = wrench - wrench_at(X.rotation.transpose() * (at_ - X.position),
                                      share * (X.rotation.transpose() * force_));
    for (std::size_t i = 0; i < tensions_.size(); ++i) {
      if (rod_.tendons[i].section < piece.index) continue;
      const Eigen::Vector3d a = rod_.tendons[i].at(piece.s_base + piece.from * length).value,
                            b = end * rod_.tendons[i].at(piece.s_base + piece.to * length).value;
      sum += wrench_at(a, share * tensions_[i] * (b - a).normalized());
    }
    return sum;
  }

  // Flies from piece to piece, the load acting at at_. Returns the tip.
  std::optional<Pose> shot(double share) {
    Pose X;
    double s_base = 0;
    std::size_t count = 0;
    for (std::size_t s = 0; s < rod_.sections.size(); s_base += rod_.sections[s].length, ++s) {
      const RodSection& section = rod_.sections[s];
      for (int k = 0; k < section.disks; ++k, ++count) {
        const Piece piece{&section, s, static_cast<double>(k) / section.disks,
                          static_cast<double>(k + 1) / section.disks, s_base};
        if (wrenches_.size() <= count) wrenches_.emplace_back(Vector6d::Zero());
        Vector6d& wrench = wrenches_[count];
        bool is_there = false;
        for (int i = 0; i < 12 && !is_there; ++i) {
          const Vector6d off = miss(piece, share, X, wrench);
          const Vector6d unit = unit_wrench(section);
          Matrix6d by;
          for (int c = 0; c < 6; ++c) {
            const Vector6d step = 1e-6 * unit[c] * Vector6d::Unit(c);
            by.col(c) = (miss(piece, share, X, wrench + step) - off) / (1e-6 * unit[c]);
          }
          const Vector6d change = by.partialPivLu().solve(off);
          if (!change.allFinite()) return {};
          wrench -= change;
          is_there = change.cwiseQuotient(unit).cwiseAbs().maxCoeff() < 1e-9;
        }
        if (!is_there) return {};
        X = X * flown(piece, wrench);
      }
    }
    return X;
  }

  // Finds where the tip's force acts: at the tip.
  std::optional<Pose> aimed(double share) {
    std::optional<Pose> tip;
    for (int i = 0; i < 12; ++i) {
      tip = shot(share);
      if (!tip) return {};
      const Eigen::Vector3d off = tip->position - at_;
      if (force_.isZero(0) || off.norm() < settled_ * rod_.length()) return tip;
      Eigen::Matrix3d by;
      const double step = 1e-6 * rod_.length();
      const Eigen::Vector3d at = at_;
      for (int c = 0; c < 3; ++c) {
        at_ = at + step * Eigen::Vector3d::Unit(c);
        const std::optional<Pose> beside = shot(share);
        if (!beside) return {};
        by.col(c) = (beside->position - at_ - off) / step;
      }
      at_ = at - by.partialPivLu().solve(off);
    }
    return {};
  }

  // Wrench that bends a section by a radian.
  static Vector6d unit_wrench(const RodSection& section) {
    const double moment = section.stiffness_at(0.5)[3] / section.length;
    return (Vector6d() << Eigen::Vector3d::Constant(moment / section.length),
            Eigen::Vector3d::Constant(moment))
        .finished();
  }

  Rod rod_;
  std::vector<double> tensions_;
  Eigen::Vector3d force_, at_ = Eigen::Vector3d::Zero();
  int steps_;
  std::vector<Vector6d> wrenches_;  // Of each piece; kept as start of the next shot.
};

}  // namespace flexura
