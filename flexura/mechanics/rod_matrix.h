#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "flexura/math/screw.h"
#include "flexura/mechanics/rod_layout.h"
#include "flexura/mechanics/rod_motion.h"

namespace flexura {

/// Matrices of a rod's modes that nodes and strains make: the sum over the nodes of A^T H A, where A is how
/// the modes move a node and H a symmetric 6 x 6 matrix, and a block for each section. Such is the mass
/// matrix, and the matrix of an implicit step. Systems with it are solved at a cost that grows with the
/// number of sections alone: from tip to base each section's modes are eliminated, and those before it feel
/// of it a 6 x 6 inertia (R. Featherstone's articulated bodies). Nothing is allocated after the constructor.
class RodMatrix {
 public:
  explicit RodMatrix(const RodLayout& layout);

  /// How the modes move the nodes, where the rod was last placed.
  void find_columns(const RodMotion<double>& motion);

  /// What is added up: mass + damping_factor damping + stiffness_factor (stiffness + that of the tendons
  /// under tension) - stiffness_factor by_pose - damping_factor by_twist of the surroundings, of which the
  /// symmetric part is taken.
  struct Factors {
    double damping = 0, stiffness = 0;
  };
  /// Adds up and factors it. False: it is not positive definite. `tensions`: of tendons in channels; or null.
  [[nodiscard]] bool factor(const RodMotion<double>& motion, const Factors& factors, const double* tensions,
                            bool is_surrounded);
  /// Whether it has the columns of all points that are pulled at now: those that were when it was factored.
  [[nodiscard]] bool has_columns_of(const RodMotion<double>& motion) const;
  /// Adds to the forces of the modes what surroundings, as they pulled last, change by changes x of the rates
  /// and `stretch` x of the modes. It has the columns, and no pull is coupled.
  void add_pull_change(const RodMotion<double>& motion, double stretch, const double* x, double* force) const;
  /// x becomes what the matrix makes to x.
  void solve(double* x) const;
  /// The matrix itself, dense; allocates. The columns are there.
  [[nodiscard]] Eigen::MatrixXd dense_mass(const RodMotion<double>& motion) const;
  /// Twists of a node by the modes of all sections, 6 x modes; allocates.
  [[nodiscard]] Eigen::MatrixXd node_columns(std::size_t node) const;
  /// The twist of the last node by changes x of the modes.
  [[nodiscard]] Vector6d tip_change(const double* x) const;

 private:
  using Block = std::array<double, 36>;  // 6 x 6, symmetric.
  struct Part {
    std::size_t stride = 0;       // Modes, rounded up to what one instruction takes.
    std::vector<double> columns;  // Of each node: 6 rows of `stride`.
    std::vector<double> fixed;    // stride x stride: space.
    std::vector<double> matrix;   // stride x stride, its lower triangle by rows; factored.
    std::vector<double> by_base;  // 6 rows of `stride`; solved.
    std::vector<double> space;    // 6 rows of `stride`.
    std::vector<double> inverse;  // Of the pivots.
  };
  static Block block_of(const RodLayout::Body& body, const Placement<double>& at);
  static void add_product(Part& part, const double* A, const Block& H, bool has_base);
  void add_tendons(std::size_t s, const RodMotion<double>& motion, const double* tensions, double factor);
  static void add_pull(Block& H, const NodePull& pull, const Factors& factors);
  void find_point_columns(const RodMotion<double>& motion);
  [[nodiscard]] bool factor_ties(const RodMotion<double>& motion, const Factors& factors);
  void solve_sections(double* x) const;
  // A node's twist by changes x of the modes of its section.
  [[nodiscard]] Vector6d node_twist(std::size_t section, std::size_t node, const double* x) const;
  [[nodiscard]] Vector6d twist_of(std::size_t section, const double* columns, const double* x) const;
  static bool factor_part(Part& part, std::size_t modes, bool has_base);

  const RodLayout& layout_;
  std::vector<Part> parts_;
  std::vector<double> by_moments_;  // 18 rows of 3 numbers of each interval.
  // Of points that are pulled at: which of the chosen, which of all, and how its section's modes move it, 6
  // rows of the section's stride.
  struct Pulled {
    std::size_t chosen, point, section, first;
  };
  std::vector<Pulled> pulled_;
  std::vector<double> point_columns_;
  // Points that are tied: the matrix has rows_^T rows_ beside the sections' part, of which answers_ is the
  // solution for rows_^T (M. A. Woodbury).
  std::vector<PointTie> ties_;
  Eigen::MatrixXd rows_, answers_;
  Eigen::LLT<Eigen::MatrixXd> tied_;
  mutable Eigen::VectorXd tensions_;
};

}  // namespace flexura
