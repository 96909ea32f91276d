#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

// Decompositions of dense matrices of any size. They are compiled once, because a source that includes
// Eigen's decompositions takes seconds longer to compile. For systems of a few rows in inner loops see
// small_cholesky.h. The functions allocate memory. Matrices must not be empty. If a matrix is not finite or a
// method does not converge, results are NaN and the rank is 0.
namespace flexura {

/// Eigendecomposition of a symmetric n x n matrix; uses the lower triangle.
struct SymmetricEigen {
  Eigen::VectorXd values;   ///< n eigenvalues, ascending.
  Eigen::MatrixXd vectors;  ///< n x n: orthonormal eigenvectors as columns, in the order of `values`.
};
[[nodiscard]] SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A);

/// Returns the smallest eigenvalue of a symmetric matrix.
[[nodiscard]] double least_eigenvalue(const Eigen::MatrixXd& symmetric);

/// Eigendecomposition of any real n x n matrix. Complex conjugate pairs are consecutive.
struct GeneralEigen {
  Eigen::VectorXcd values;   ///< n eigenvalues.
  Eigen::MatrixXcd vectors;  ///< n x n: eigenvectors of norm 1 as columns, in the order of `values`.
};
[[nodiscard]] GeneralEigen general_eigen(const Eigen::MatrixXd& A);

/// Cholesky decomposition A = L L^T of a symmetric n x n matrix; uses the lower triangle.
class Cholesky {
 public:
  Cholesky() = default;
  explicit Cholesky(const Eigen::MatrixXd& A) { compute(A); }
  /// Decomposes A. Returns false if A is not positive definite; solutions are then NaN. Allocates only for a
  /// new size.
  bool compute(const Eigen::MatrixXd& A);
  [[nodiscard]] bool is_definite() const { return is_definite_; }
  /// Returns an estimate of 1 / (|A| |A^-1|) in 1-norms; 0 if A is not definite.
  [[nodiscard]] double rcond() const;
  /// Returns the natural logarithm of det A.
  [[nodiscard]] double log_determinant() const;
  /// Returns A^-1 B, for B of n rows.
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const;
  /// Replaces b by A^-1 b, without allocation.
  void solve_in_place(Eigen::VectorXd& b) const;
  /// Returns L^-1 B, for B of n rows.
  [[nodiscard]] Eigen::MatrixXd solve_lower(const Eigen::MatrixXd& B) const;
  /// Returns A^-1, n x n.
  [[nodiscard]] Eigen::MatrixXd inverse() const;

 private:
  Eigen::LLT<Eigen::MatrixXd> factors_;
  bool is_definite_ = false;
};

/// Pivoted Cholesky decomposition A = P^T L D L^T P of a symmetric n x n matrix that is positive semidefinite
/// up to rounding. Uses the lower triangle. In a solution, unknowns with a zero pivot are zero. For matrices
/// that are not positive semidefinite, the result is undefined.
class PivotedCholesky {
 public:
  PivotedCholesky() = default;
  explicit PivotedCholesky(const Eigen::MatrixXd& A) { compute(A); }
  /// Decomposes A. Allocates only for a new size.
  void compute(const Eigen::MatrixXd& A);
  /// Returns whether A is positive definite: all pivots are above `rounding` times the largest pivot, and the
  /// reciprocal condition number (see Cholesky::rcond()) is above `rounding`.
  [[nodiscard]] bool is_definite(double rounding) const;
  /// Returns A^-1 B, for B of n rows.
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const;
  /// Replaces b by A^-1 b, without allocation.
  void solve_in_place(Eigen::VectorXd& b) const;
  /// Returns A^-1, n x n.
  [[nodiscard]] Eigen::MatrixXd inverse() const;

 private:
  Eigen::LDLT<Eigen::MatrixXd> factors_;
  bool is_finite_ = false;
};

/// Returns the singular values in descending order. The number of singular values is the smaller of the
/// numbers of rows and columns.
[[nodiscard]] Eigen::VectorXd singular_values(const Eigen::MatrixXd& A);

/// Returns the minimum-norm least-squares solution: the x of smallest norm that minimizes |A x - b|.
[[nodiscard]] Eigen::VectorXd least_norm_solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

/// Returns the Moore-Penrose inverse; for an m x n matrix the inverse is n x m.
[[nodiscard]] Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& A);

/// Returns the rank, computed by QR decomposition with column pivoting. Pivots below `threshold` times the
/// largest pivot count as zero. Threshold 0 means the rounding error of the decomposition.
[[nodiscard]] Eigen::Index rank_of(const Eigen::MatrixXd& A, double threshold = 0);

/// Returns an orthonormal basis, as columns, of the orthogonal complement of the column space of A. The
/// result has rows(A) rows and rows(A) - rank columns, where the rank is rank_of(A, threshold).
[[nodiscard]] Eigen::MatrixXd orthogonal_complement(const Eigen::MatrixXd& A, double threshold = 0);

/// Returns the rotation R that minimizes |R - A|, computed by singular value decomposition. If the minimum is
/// not unique, the result is any such rotation.
[[nodiscard]] Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& A);

}  // namespace flexura
