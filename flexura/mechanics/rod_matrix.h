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

/// Matrices of the size modes x modes, such as the mass matrix and the matrix of an implicit step. Each
/// matrix is the sum over the nodes of A^T H A, plus a block for each section. A is the derivative of a
/// node's twist with respect to the modes, and H a symmetric 6 x 6 matrix. Linear systems are solved at a
/// cost linear in the number of sections. Each section's modes are eliminated from tip to base, which leaves
/// a 6 x 6 inertia for the proximal sections (Featherstone's articulated bodies). Allocates only in the
/// constructor.
class RodMatrix {
 public:
  explicit RodMatrix(const RodLayout& layout);

  /// Computes the derivatives of node twists with respect to the modes, at the last placement of the rod.
  void find_columns(const RodMotion<double>& motion);

  /// Factors d and k (`damping`, `stiffness`) of the matrix M + d (D - B_v) + k (K + K_t - B_p). M, D and K
  /// are the rod's mass, damping and stiffness. K_t is the geometric stiffness of tendons under tension. B_v
  /// and B_p are the symmetric parts of by_twist and by_pose of the surroundings.
  struct Factors {
    double damping = 0, stiffness = 0;
  };
  /// Assembles and factors the matrix. Returns false if the matrix is not positive definite. `tensions`:
  /// tensions of the tendons in channels, N; null: no tendon stiffness.
  [[nodiscard]] bool factor(const RodMotion<double>& motion, const Factors& factors, const double* tensions,
                            bool is_surrounded);
  /// Returns whether all points that have wrenches now also had wrenches when the matrix was factored.
  /// Columns are known only for these points.
  [[nodiscard]] bool has_columns_of(const RodMotion<double>& motion) const;
  /// Adds to the generalized forces `force` the change of the last wrenches of the surroundings when the
  /// rates change by x and the modes change by stretch * x. Requires find_columns(), and that no wrenches are
  /// coupled (RodSurroundings).
  void add_pull_change(const RodMotion<double>& motion, double stretch, const double* x, double* force) const;
  /// Replaces the right-hand side x by its solution.
  void solve(double* x) const;
  /// Returns the dense matrix; allocates. Requires the columns.
  [[nodiscard]] Eigen::MatrixXd dense_mass(const RodMotion<double>& motion) const;
  /// Returns the derivatives of a node's twist with respect to the modes of all sections, 6 x modes;
  /// allocates.
  [[nodiscard]] Eigen::MatrixXd node_columns(std::size_t node) const;
  /// Returns the twist of the last node caused by changes x of the modes.
  [[nodiscard]] Vector6d tip_change(const double* x) const;

 private:
  using Block = std::array<double, 36>;  // 6 x 6, symmetric.
  struct Part {
    std::size_t stride = 0;       // Modes, rounded up to an instruction's lanes.
    std::vector<double> columns;  // For each node: 6 rows of `stride`.
    std::vector<double> fixed;    // stride x stride: work space.
    std::vector<double> matrix;   // stride x stride, lower triangle by rows; factored.
    std::vector<double> by_base;  // 6 rows of `stride`; solved.
    std::vector<double> space;    // 6 rows of `stride`, work space.
    std::vector<double> inverse;  // Inverse pivots.
  };
  static Block block_of(const RodLayout::Body& body, const Placement<double>& at);
  static void add_product(Part& part, const double* A, const Block& H, bool has_base);
  void add_tendons(std::size_t s, const RodMotion<double>& motion, const double* tensions, double factor);
  static void add_pull(Block& H, const NodePull& pull, const Factors& factors);
  void find_point_columns(const RodMotion<double>& motion);
  [[nodiscard]] bool factor_ties(const RodMotion<double>& motion, const Factors& factors);
  void solve_sections(double* x) const;
  // Returns a node's twist by changes x of the modes of its section.
  [[nodiscard]] Vector6d node_twist(std::size_t section, std::size_t node, const double* x) const;
  [[nodiscard]] Vector6d twist_of(std::size_t section, const double* columns, const double* x) const;
  static bool factor_part(Part& part, std::size_t modes, bool has_base);

  const RodLayout& layout_;
  std::vector<Part> parts_;
  std::vector<double> by_moments_;  // 18 rows of 3 numbers for each interval.
  // Points with wrenches: index among the chosen, index among all, and the twist by its section's modes, 6
  // rows of the section's stride.
  struct Pulled {
    std::size_t chosen, point, section, first;
  };
  std::vector<Pulled> pulled_;
  std::vector<double> point_columns_;
  // Coupled points: the matrix has rows_^T rows_ in addition to the sections' part, and answers_ is its
  // solution for rows_^T (Woodbury).
  std::vector<PointTie> ties_;
  Eigen::MatrixXd rows_, answers_;
  Eigen::LLT<Eigen::MatrixXd> tied_;
  mutable Eigen::VectorXd tensions_;
};

}  // namespace flexura
