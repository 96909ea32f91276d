#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "flexura/kinematics/bounded_least_squares.h"
#include "flexura/mechanics/inverse_statics.h"
#include "flexura/mechanics/statics.h"

namespace flexura {

/// Deviation r of a rod from a target, as a function of the tensions x. x is in units of `unit` N, r in
/// lengths of the rod. Each evaluation computes an equilibrium and its exact derivatives, starting from the
/// nearest earlier equilibrium.
class RodTargetProblem final : public BoundedProblem {
 public:
  /// `most`: maximum of each tension, N. Tendons with maximum 0 are omitted.
  RodTargetProblem(RodStatics& statics, const RodTarget& target, const RodLoads& loads,
                   std::span<const double> most, double tolerance);

  [[nodiscard]] Eigen::Index row_count() const override { return rows_; }
  void linearise(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd& J) override;
  [[nodiscard]] bool is_met(const Eigen::VectorXd& r) const override;

  /// Sets the start of the next search: `near`, or the undeformed rod if `near` did not converge.
  void begin(const Equilibrium& near);
  /// Returns the equilibrium at x, computed from `near`. Sets r and J as in linearise().
  Equilibrium at(const Eigen::VectorXd& x, const Equilibrium& near, Eigen::VectorXd& r, Eigen::MatrixXd& J);
  /// The following functions return the largest distance of a place, m, and the angle error, rad, that belong
  /// to r.
  [[nodiscard]] double position_error(const Eigen::VectorXd& r) const;
  [[nodiscard]] double angle_error(const Eigen::VectorXd& r) const;

  double unit = 1;      ///< N
  int evaluations = 0;  ///< Number of equilibria computed.

 private:
  struct Node {
    std::size_t element, node;
    Eigen::Vector3d position;
  };
  void turn_rows(Eigen::VectorXd& r, Eigen::MatrixXd& J) const;

  RodStatics& statics_;
  const RodTarget& target_;
  const RodLoads& loads_;
  std::vector<double> most_;
  double length_, tolerance_;
  std::vector<Node> nodes_;
  Eigen::Index rows_ = 0, angles_ = 0;  // Rows of angles come last.
  TendonInput input_;
  Equilibrium near_;
  double near_square_ = 0;
  EquilibriumSlopes slopes_;
  RodElement::Columns columns_, twist_;
};

/// Returns the node of a rod at a place; std::nullopt if there is none.
[[nodiscard]] std::optional<RodNode> node_of(const RodChain& chain, const RodPlace& place);

}  // namespace flexura
