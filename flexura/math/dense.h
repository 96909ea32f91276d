#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

// Decompositions of dense matrices of any size, compiled once: a source that names Eigen's own takes seconds
// longer to compile (for systems of a few rows in inner loops: small_cholesky.h). They allocate, as those of
// dynamic size do. Matrices are not empty; of what is not finite, or does not converge, all that is returned
// is not a number, and the rank is 0.
namespace flexura {

/// Of a symmetric n x n matrix, of which the lower triangle counts.
struct SymmetricEigen {
  Eigen::VectorXd values;   ///< n, ascending.
  Eigen::MatrixXd vectors;  ///< n x n: orthonormal columns, in the values' order.
};
[[nodiscard]] SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A);

/// The least eigenvalue alone.
[[nodiscard]] double least_eigenvalue(const Eigen::MatrixXd& symmetric);

/// Of any real n x n matrix: pairs that are conjugate follow each other.
struct GeneralEigen {
  Eigen::VectorXcd values;   ///< n
  Eigen::MatrixXcd vectors;  ///< n x n: columns of norm 1.
};
[[nodiscard]] GeneralEigen general_eigen(const Eigen::MatrixXd& A);

/// A = L L^T of a symmetric n x n matrix, of which the lower triangle counts.
class Cholesky {
 public:
  Cholesky() = default;
  explicit Cholesky(const Eigen::MatrixXd& A) { compute(A); }
  /// Whether A is positive definite; if not, what is solved with it is not a number. Allocates where the size
  /// is a new one.
  bool compute(const Eigen::MatrixXd& A);
  [[nodiscard]] bool is_definite() const { return is_definite_; }
  /// 1 / (|A| |A^-1|) in 1-norms, estimated; 0 where A is not definite.
  [[nodiscard]] double rcond() const;
  /// log |A|
  [[nodiscard]] double log_determinant() const;
  /// A^-1 B, n x columns.
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const;
  /// b becomes A^-1 b, without an allocation.
  void solve_in_place(Eigen::VectorXd& b) const;
  /// L^-1 B, n x columns.
  [[nodiscard]] Eigen::MatrixXd solve_lower(const Eigen::MatrixXd& B) const;
  /// n x n
  [[nodiscard]] Eigen::MatrixXd inverse() const;

 private:
  Eigen::LLT<Eigen::MatrixXd> factors_;
  bool is_definite_ = false;
};

/// A = P^T L D L^T P of a symmetric n x n matrix that is semidefinite but for rounding, of which the lower
/// triangle counts. Where a pivot is none, what is solved has zero for that unknown, as if it were known; of
/// other matrices nothing is promised.
class PivotedCholesky {
 public:
  PivotedCholesky() = default;
  explicit PivotedCholesky(const Eigen::MatrixXd& A) { compute(A); }
  /// Allocates where the size is a new one.
  void compute(const Eigen::MatrixXd& A);
  /// Whether A is positive definite, with all pivots above `rounding` of the greatest, and the reciprocal
  /// condition that Cholesky::rcond() is.
  [[nodiscard]] bool is_definite(double rounding) const;
  /// A^-1 B, n x columns.
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const;
  /// b becomes A^-1 b, without an allocation.
  void solve_in_place(Eigen::VectorXd& b) const;
  /// n x n
  [[nodiscard]] Eigen::MatrixXd inverse() const;

 private:
  Eigen::LDLT<Eigen::MatrixXd> factors_;
  bool is_finite_ = false;
};

/// Descending; as many as the smaller of rows and columns.
[[nodiscard]] Eigen::VectorXd singular_values(const Eigen::MatrixXd& A);

/// Of the x that make |A x - b| least, the one of least norm.
[[nodiscard]] Eigen::VectorXd least_norm_solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

/// Moore and Penrose's, columns x rows.
[[nodiscard]] Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& A);

/// By QR with column pivoting: pivots below `threshold` of the greatest count for nothing; 0: below rounding.
[[nodiscard]] Eigen::Index rank_of(const Eigen::MatrixXd& A, double threshold = 0);

/// Orthonormal columns that are square to all columns of A, and together with them span everything: rows x
/// (rows - rank), the rank as `rank_of` tells.
[[nodiscard]] Eigen::MatrixXd orthogonal_complement(const Eigen::MatrixXd& A, double threshold = 0);

/// The rotation R of least |R - A|, by the singular value decomposition; some rotation where it is not
/// unique.
[[nodiscard]] Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& A);

}  // namespace flexura
