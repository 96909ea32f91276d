#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

// Decompositions of dense matrices of any size, compiled once: a source that includes Eigen's takes seconds
// longer to compile. For systems of a few rows in inner loops see small_cholesky.h. They allocate, like
// Eigen's of dynamic size. Matrices must not be empty. If a matrix is not finite or the method does not
// converge, results are not numbers, and the rank is 0.
namespace flexura {

/// Eigendecomposition of a symmetric n x n matrix; uses the lower triangle.
struct SymmetricEigen {
  Eigen::VectorXd values;   ///< n, ascending.
  Eigen::MatrixXd vectors;  ///< n x n: orthonormal columns, in the order of the values.
};
[[nodiscard]] SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A);

/// Returns the least eigenvalue.
[[nodiscard]] double least_eigenvalue(const Eigen::MatrixXd& symmetric);

/// Eigendecomposition of any real n x n matrix; conjugate pairs are consecutive.
struct GeneralEigen {
  Eigen::VectorXcd values;   ///< n.
  Eigen::MatrixXcd vectors;  ///< n x n: columns of norm 1.
};
[[nodiscard]] GeneralEigen general_eigen(const Eigen::MatrixXd& A);

/// A = L L^T for a symmetric n x n matrix; uses the lower triangle.
class Cholesky {
 public:
  Cholesky() = default;
  explicit Cholesky(const Eigen::MatrixXd& A) { compute(A); }
  /// Factors A. Returns false if A is not positive definite; solutions are then not numbers. Allocates only
  /// for a new size.
  bool compute(const Eigen::MatrixXd& A);
  [[nodiscard]] bool is_definite() const { return is_definite_; }
  /// Returns an estimate of 1 / (|A| |A^-1|) in 1-norms; 0 if A is not definite.
  [[nodiscard]] double rcond() const;
  /// Returns log |A|.
  [[nodiscard]] double log_determinant() const;
  /// Returns A^-1 B, n x columns.
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const;
  /// Replaces b by A^-1 b, without allocation.
  void solve_in_place(Eigen::VectorXd& b) const;
  /// Returns L^-1 B, n x columns.
  [[nodiscard]] Eigen::MatrixXd solve_lower(const Eigen::MatrixXd& B) const;
  /// Returns A^-1, n x n.
  [[nodiscard]] Eigen::MatrixXd inverse() const;

 private:
  Eigen::LLT<Eigen::MatrixXd> factors_;
  bool is_definite_ = false;
};

/// A = P^T L D L^T P for a symmetric n x n matrix that is semidefinite up to rounding; uses the lower
/// triangle. Unknowns with a zero pivot have the solution zero, as if they were known. For other matrices the
/// result is undefined.
class PivotedCholesky {
 public:
  PivotedCholesky() = default;
  explicit PivotedCholesky(const Eigen::MatrixXd& A) { compute(A); }
  /// Factors A. Allocates only for a new size.
  void compute(const Eigen::MatrixXd& A);
  /// Returns true if A is positive definite: all pivots are above `rounding` of the largest, and the
  /// reciprocal condition (as in Cholesky::rcond()) is above `rounding`.
  [[nodiscard]] bool is_definite(double rounding) const;
  /// Returns A^-1 B, n x columns.
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const;
  /// Replaces b by A^-1 b, without allocation.
  void solve_in_place(Eigen::VectorXd& b) const;
  /// Returns A^-1, n x n.
  [[nodiscard]] Eigen::MatrixXd inverse() const;

 private:
  Eigen::LDLT<Eigen::MatrixXd> factors_;
  bool is_finite_ = false;
};

/// Returns the singular values, descending; as many as the smaller of rows and columns.
[[nodiscard]] Eigen::VectorXd singular_values(const Eigen::MatrixXd& A);

/// Returns the x of least norm among those with the least |A x - b|.
[[nodiscard]] Eigen::VectorXd least_norm_solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

/// Returns the Moore-Penrose inverse, columns x rows.
[[nodiscard]] Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& A);

/// Returns the rank by QR with column pivoting. Pivots below `threshold` of the largest count as zero; 0:
/// below rounding.
[[nodiscard]] Eigen::Index rank_of(const Eigen::MatrixXd& A, double threshold = 0);

/// Returns orthonormal columns perpendicular to all columns of A, which together with them span the space:
/// rows x (rows - rank), with the rank by `rank_of`.
[[nodiscard]] Eigen::MatrixXd orthogonal_complement(const Eigen::MatrixXd& A, double threshold = 0);

/// Returns the rotation R of least |R - A|, by the singular value decomposition; any such rotation if it is
/// not unique.
[[nodiscard]] Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& A);

}  // namespace flexura
