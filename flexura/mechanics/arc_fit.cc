#include "flexura/mechanics/arc_fit.h"

#include <stdexcept>
#include <utility>

#include "flexura/math/se3.h"
#include "flexura/math/so3.h"

namespace flexura {
namespace {

using Eigen::Index;

}  // namespace

ArcFit::ArcFit(const ArmVariables& variables, std::vector<MaterialPoint> places)
    : parts_(variables.parts()),
      size_(variables.size()),
      places_(std::move(places)),
      single_(parts_.size()),
      jacobians_(parts_.size()),
      arcs_(parts_.size()),
      spots_(places_.size()),
      positions_(places_.size()) {
  std::size_t next = 0;
  for (std::size_t k = 0; k < arcs_.size(); ++k) {
    arcs_[k].first = next;
    while (next < places_.size() && places_[next].section == k) ++next;
    arcs_[k].count = next - arcs_[k].first;
    single_[k].sections.resize(1);
  }
}

// Sets the columns of what is no variable to 0.
ArcFit::Columns ArcFit::masked(Columns columns, std::size_t arc) const {
  if (!parts_[arc].is_spatial) columns.col(1).setZero();
  if (!parts_[arc].is_stretchable) columns.col(2).setZero();
  return columns;
}

// Sets the arcs one after another. A Jacobian of the whole arm at a place has columns of all arcs before it.
void ArcFit::stand(const Arm& arm, const ArmState& state) {
  require_fit(arm, state);
  if (state.bends.size() != arcs_.size())
    throw std::invalid_argument("the state and the fit have different numbers of arcs");
  Pose X_WS = arm.X_WB;
  for (std::size_t k = 0; k < arcs_.size(); ++k) {
    single_[k].X_WB = X_WS;
    single_[k].kind = arm.kind;
    single_[k].sections[0].length = arm.sections[k].length;
    single_state_.bends[0] = state.bends[k];
    single_state_.stretches[0] = state.stretches[k];
    jacobians_[k].set(single_[k], single_state_);
    X_WS = jacobians_[k].pose({0, 1.0});
  }
}

void ArcFit::set(const Arm& arm, const ArmState& state) {
  stand(arm, state);
  // Information about the twist of an arc's base, from all places after it.
  Matrix66 after = Matrix66::Zero();
  for (std::size_t k = arcs_.size(); k-- > 0;) {
    Arc& arc = arcs_[k];
    const BackboneJacobian::Part& part = jacobians_[k].parts()[0];
    arc.end_by_base.setIdentity();
    arc.end_by_base.topRightCorner<3, 3>() = -skew(part.p_end - part.X_WS.position);
    arc.end_by_own = masked(part.V_end, k);
    const Eigen::Matrix<double, 3, 6> by_end = arc.end_by_own.transpose() * after;
    arc.coupling = by_end * arc.end_by_base;
    Eigen::Matrix3d own = by_end * arc.end_by_own;
    for (std::size_t p = arc.first; p < arc.first + arc.count; ++p) {
      Spot& spot = spots_[p];
      const MaterialPoint there{0, places_[p].fraction};
      positions_[p] = jacobians_[k].pose(there).position;
      Columns twist;
      jacobians_[k].at(there, twist);
      spot.by_base.leftCols<3>().setIdentity();
      spot.by_base.rightCols<3>() = -skew(positions_[p] - part.X_WS.position);
      spot.by_own = masked(twist, k).topRows<3>();
      arc.coupling += spot.by_own.transpose() * spot.by_base;
      own += spot.by_own.transpose() * spot.by_own;
    }
    if (!parts_[k].is_spatial) own(1, 1) = 1;
    if (!parts_[k].is_stretchable) own(2, 2) = 1;
    arc.information.compute(own);
    // A sum of squares of what remains, which rounding leaves semidefinite.
    const Matrix36 answer = arc.information.solve(arc.coupling);
    const Matrix66 end_left = arc.end_by_base - arc.end_by_own * answer;
    Matrix66 here = end_left.transpose() * after * end_left;
    for (std::size_t p = arc.first; p < arc.first + arc.count; ++p) {
      const Matrix36 left = spots_[p].by_base - spots_[p].by_own * answer;
      here += left.transpose() * left;
    }
    after = 0.5 * (here + here.transpose());
  }
}

Eigen::MatrixXd ArcFit::solve(const Eigen::MatrixXd& moved, Eigen::MatrixXd* reached) const {
  Eigen::MatrixXd change(size_, moved.cols());
  if (reached != nullptr) reached->resize(moved.rows(), moved.cols());
  std::vector<Eigen::Vector3d> slopes(arcs_.size());
  for (Index c = 0; c < moved.cols(); ++c) {
    const auto displacement = [&](std::size_t p) {
      return moved.col(c).segment<3>(3 * static_cast<Index>(p));
    };
    Vector6d after = Vector6d::Zero();
    for (std::size_t k = arcs_.size(); k-- > 0;) {
      const Arc& arc = arcs_[k];
      Vector6d here = arc.end_by_base.transpose() * after;
      slopes[k] = arc.end_by_own.transpose() * after;
      for (std::size_t p = arc.first; p < arc.first + arc.count; ++p) {
        here += spots_[p].by_base.transpose() * displacement(p);
        slopes[k] += spots_[p].by_own.transpose() * displacement(p);
      }
      after = here - arc.coupling.transpose() * arc.information.solve(slopes[k]);
    }
    Vector6d twist = Vector6d::Zero();
    for (std::size_t k = 0; k < arcs_.size(); ++k) {
      const Arc& arc = arcs_[k];
      const Eigen::Vector3d own = arc.information.solve(slopes[k] - arc.coupling * twist);
      const ArmVariables::Part& part = parts_[k];
      change(part.at, c) = own[0];
      if (part.is_spatial) change(part.at + 1, c) = own[1];
      if (part.is_stretchable) change(part.stretch_at(), c) = own[2];
      if (reached != nullptr)
        for (std::size_t p = arc.first; p < arc.first + arc.count; ++p)
          reached->col(c).segment<3>(3 * static_cast<Index>(p)) =
              spots_[p].by_base * twist + spots_[p].by_own * own;
      twist = (arc.end_by_base * twist + arc.end_by_own * own).eval();
    }
  }
  return change;
}

}  // namespace flexura
