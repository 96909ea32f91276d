#include "flexura/math/dense.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>

#include "flexura/math/small_cholesky.h"
#include "flexura/math/so3.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

MatrixXd random_matrix(TestRandom& random, Index rows, Index columns) {
  return MatrixXd::NullaryExpr(rows, columns, [&] { return random.uniform(-1, 1); });
}

TEST(Dense, EigenvectorsAreOnlyStretchedByTheirValues) {
  for_random_cases(100, [](TestRandom& random) {
    const Index n = random.integer(1, 9);
    const MatrixXd any = random_matrix(random, n, n), symmetric = any + any.transpose();
    const auto [values, vectors] = symmetric_eigen(symmetric);
    EXPECT_LT((symmetric * vectors - vectors * values.asDiagonal()).norm(), 1e-12);
    EXPECT_LT((vectors.transpose() * vectors - MatrixXd::Identity(n, n)).norm(), 1e-12);
    for (Index i = 1; i < n; ++i) EXPECT_LE(values[i - 1], values[i]);
    EXPECT_NEAR(least_eigenvalue(symmetric), values[0], 1e-12);
    const MatrixXd lower = symmetric.triangularView<Eigen::Lower>();
    EXPECT_EQ(symmetric_eigen(lower).values, values) << "the lower triangle counts";
    const auto [turned, ways] = general_eigen(any);
    EXPECT_LT((any * ways - ways * turned.asDiagonal()).norm(), 1e-10);
    EXPECT_NEAR(turned.prod().real(), any.determinant(), 1e-10);
    for (Index i = 0; i < n; ++i) {
      EXPECT_NEAR(ways.col(i).norm(), 1, 1e-12);
      const bool is_first = turned[i].imag() > 0;
      EXPECT_LT(is_first ? std::abs(turned[i + 1] - std::conj(turned[i])) : 0, 1e-12);
    }
  });
}

// A matrix of known rank, singular values and null space.
TEST(Dense, SolutionsOfSingularSystemsAreTheLeast) {
  for_random_cases(100, [](TestRandom& random) {
    const Index rows = random.integer(1, 8), columns = random.integer(1, 8);
    const Index rank = random.integer(0, static_cast<int>(std::min(rows, columns)));
    const MatrixXd A = random_matrix(random, rows, rank) * random_matrix(random, rank, columns);
    EXPECT_EQ(rank_of(A, 1e-9), rank);
    const MatrixXd inverse = pseudo_inverse(A);
    // The four conditions that define the Moore-Penrose inverse.
    EXPECT_LT((A * inverse * A - A).norm(), 1e-8);
    EXPECT_LT((inverse * A * inverse - inverse).norm(), 1e-8 * (1 + inverse.norm()));
    EXPECT_LT((A * inverse - (A * inverse).transpose()).norm(), 1e-8);
    EXPECT_LT((inverse * A - (inverse * A).transpose()).norm(), 1e-8);
    const VectorXd b = random_matrix(random, rows, 1);
    const VectorXd x = least_norm_solution(A, b);
    const double size = 1 + inverse.norm();
    EXPECT_LT((A.transpose() * (A * x - b)).norm(), 1e-8 * size) << "the least squares";
    EXPECT_LT((orthogonal_complement(A.transpose(), 1e-9).transpose() * x).norm(), 1e-8 * size)
        << "nothing of it could be left out";
    const MatrixXd square = orthogonal_complement(A, 1e-9);
    EXPECT_EQ(square.cols(), rows - rank);
    EXPECT_LT((square.transpose() * A).norm(), 1e-8);
    EXPECT_LT((square.transpose() * square - MatrixXd::Identity(rows - rank, rows - rank)).norm(), 1e-12);
    const VectorXd values = singular_values(A);
    EXPECT_EQ(values.size(), std::min(rows, columns));
    EXPECT_NEAR(values.squaredNorm(), A.squaredNorm(), 1e-10);
    for (Index i = 1; i < values.size(); ++i) EXPECT_GE(values[i - 1], values[i]);
  });
}

// By default only rounding errors count as zero.
TEST(Dense, RankByDefaultIsThatToRounding) {
  for_random_cases(100, [](TestRandom& random) {
    const Index n = random.integer(2, 8);
    MatrixXd A = random_matrix(random, n, n);
    EXPECT_EQ(rank_of(A), n);
    EXPECT_EQ(orthogonal_complement(A).cols(), 0);
    A.col(0) = A.col(1);
    EXPECT_EQ(rank_of(A), n - 1);
    EXPECT_EQ(orthogonal_complement(A).cols(), 1);
    A.col(0)[0] += 1e-6;
    EXPECT_EQ(rank_of(A), n);
  });
}

TEST(Dense, FactorsOfDefiniteMatricesSolve) {
  for_random_cases(100, [](TestRandom& random) {
    const Index n = random.integer(1, 12), columns = random.integer(1, 4);
    const MatrixXd root = random_matrix(random, n, n) + 3 * MatrixXd::Identity(n, n),
                   A = root * root.transpose(), B = random_matrix(random, n, columns),
                   lower = A.triangularView<Eigen::Lower>();
    const VectorXd b = B.col(0);
    Cholesky factors;
    EXPECT_TRUE(factors.compute(lower)) << "the lower triangle counts";
    const double size = 1e-10 * A.norm();
    EXPECT_LT((A * factors.solve(B) - B).norm(), size);
    EXPECT_LT((A * factors.inverse() - MatrixXd::Identity(n, n)).norm(), size);
    const MatrixXd reduced = factors.solve_lower(B);
    EXPECT_LT((reduced.transpose() * reduced - B.transpose() * factors.solve(B)).norm(), size);
    EXPECT_NEAR(factors.log_determinant(), std::log(A.determinant()), 1e-9);
    VectorXd x = b;
    factors.solve_in_place(x);
    EXPECT_LT((A * x - b).norm(), size);
    const double condition =
        A.cwiseAbs().colwise().sum().maxCoeff() * factors.inverse().cwiseAbs().colwise().sum().maxCoeff();
    EXPECT_GE(factors.rcond(), (1 - 1e-9) / condition) << "an estimate, of the norm from below";
    EXPECT_LT(factors.rcond(), 10 / condition);

    const PivotedCholesky pivoted(lower);
    EXPECT_TRUE(pivoted.is_definite(1e-12));
    EXPECT_LT((pivoted.solve(B) - factors.solve(B)).norm(), size);
    EXPECT_LT((pivoted.inverse() - factors.inverse()).norm(), size);
    x = b;
    pivoted.solve_in_place(x);
    EXPECT_LT((A * x - b).norm(), size);
  });
}

TEST(Dense, FactorsTellWhatIsNotDefinite) {
  for_random_cases(100, [](TestRandom& random) {
    const Index n = random.integer(2, 9);
    const MatrixXd root = random_matrix(random, n, n), few = root.leftCols(n - 1);
    const MatrixXd singular = few * few.transpose(), definite = root * root.transpose(),
                   indefinite = definite - (least_eigenvalue(definite) + 0.1) * MatrixXd::Identity(n, n);
    const Cholesky factors(indefinite);
    EXPECT_FALSE(factors.is_definite());
    EXPECT_TRUE(factors.solve(MatrixXd::Ones(n, 1)).array().isNaN().all());
    EXPECT_TRUE(std::isnan(factors.log_determinant()));
    EXPECT_FALSE(PivotedCholesky(indefinite).is_definite(0));
    EXPECT_FALSE(PivotedCholesky(singular).is_definite(1e-14));
  });
  // Zero for an unknown with a zero pivot.
  const MatrixXd first = Eigen::Vector2d(1, 0).asDiagonal();
  EXPECT_EQ(PivotedCholesky(first).solve(Eigen::Vector2d(3, 4)), VectorXd(Eigen::Vector2d(3, 0)));
}

template <int n>
void expect_that_few_are_solved(TestRandom& random) {
  const Eigen::Matrix<double, n, n> root = random_matrix(random, n, n), A = root * root.transpose(),
                                    lower = A.template triangularView<Eigen::Lower>();
  const Eigen::Vector<double, n> b = random.vector<n>(-1, 1), x = solve_definite(lower, b);
  EXPECT_LT((A * x - b).norm(), 1e-12 * A.norm() * x.norm());
  const Eigen::Matrix<double, n, n> off = A - (least_eigenvalue(A) + 0.1) * MatrixXd::Identity(n, n);
  EXPECT_FALSE(solve_definite<n>(off, b).allFinite());
  EXPECT_FALSE(solve_definite<n>(Eigen::Matrix<double, n, n>::Zero(), b).allFinite());
}

TEST(SmallCholesky, SolvesDefiniteSystemsAndNoOthers) {
  for_random_cases(100, [](TestRandom& random) {
    expect_that_few_are_solved<1>(random);
    expect_that_few_are_solved<2>(random);
    expect_that_few_are_solved<3>(random);
    expect_that_few_are_solved<6>(random);
  });
}

TEST(Dense, OfWhatIsNotFiniteNothingIsKnown) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    MatrixXd A = MatrixXd::Identity(3, 3);
    A(1, 1) = bad;
    EXPECT_TRUE(symmetric_eigen(A).values.array().isNaN().all());
    EXPECT_TRUE(symmetric_eigen(A).vectors.array().isNaN().all());
    EXPECT_TRUE(std::isnan(least_eigenvalue(A)));
    EXPECT_TRUE(general_eigen(A).values.real().array().isNaN().all());
    EXPECT_TRUE(singular_values(A).array().isNaN().all());
    EXPECT_TRUE(least_norm_solution(A, VectorXd::Ones(3)).array().isNaN().all());
    EXPECT_TRUE(pseudo_inverse(A).array().isNaN().all());
    EXPECT_TRUE(orthogonal_complement(A).array().isNaN().all());
    EXPECT_TRUE(nearest_rotation(A).array().isNaN().all());
    EXPECT_EQ(rank_of(A), 0);
    for (const auto& [row, column] : {std::pair{1, 1}, {2, 0}}) {
      MatrixXd B = 2 * MatrixXd::Identity(3, 3);
      B(row, column) = bad;
      const Cholesky factors(B);
      EXPECT_FALSE(factors.is_definite());
      EXPECT_EQ(factors.rcond(), 0);
      EXPECT_TRUE(std::isnan(factors.log_determinant()));
      EXPECT_TRUE(factors.inverse().array().isNaN().all());
      EXPECT_TRUE(factors.solve_lower(A).array().isNaN().all());
      const PivotedCholesky pivoted(B);
      EXPECT_FALSE(pivoted.is_definite(0));
      EXPECT_TRUE(pivoted.inverse().array().isNaN().all());
      VectorXd x = VectorXd::Ones(3), y = x;
      factors.solve_in_place(x), pivoted.solve_in_place(y);
      EXPECT_TRUE(x.array().isNaN().all() && y.array().isNaN().all());
      const bool counts_as_definite = std::isinf(bad) && row == column;
      EXPECT_EQ(solve_definite<3>(B, Eigen::Vector3d(1, 2, 3)).allFinite(), counts_as_definite);
    }
  }
}

TEST(Dense, NoRotationIsNearerThanTheNearest) {
  for_random_cases(100, [](TestRandom& random) {
    Eigen::Matrix3d A = random_matrix(random, 3, 3);
    if (random.integer(0, 4) == 0) A.col(2) = A.col(1);  // Of rank 2: not unique, but any rotation.
    const Eigen::Matrix3d R = nearest_rotation(A);
    EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(R.determinant(), 1, 1e-12);
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d turn = random.uniform(0, 3) * random.vector<3>(-1, 1);
      EXPECT_GE((R * so3_exp(turn) - A).norm(), (R - A).norm() - 1e-12);
    }
    const Eigen::Matrix3d itself = so3_exp(random.vector<3>(-3, 3));
    EXPECT_LT((nearest_rotation(2 * itself) - itself).norm(), 1e-12);
  });
}

}  // namespace
}  // namespace flexura
