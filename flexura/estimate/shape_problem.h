#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "flexura/estimate/curve_image.h"
#include "flexura/estimate/observation.h"
#include "flexura/estimate/shape_variables.h"
#include "flexura/estimate/space_curve.h"

namespace flexura {

/// A band that was identified as one of the arm's markers.
struct BandObservation {
  std::size_t observation = 0, band = 0;  ///< Indices of the observation and of its band.
  std::size_t marker = 0;   ///< Number of the marker, from 0. All observations of a marker have its number.
  std::optional<double> s;  ///< Arc length of the marker on the unstretched arm, m, if known.
};

/// Residuals of a shape, each in units of its standard deviation. The residuals of observations are distances
/// in pictures: between points and the shape's image, between borders and the shape's silhouette, and between
/// ends or markers and their images. Further residuals compare the unknowns with the prior or a prediction.
class ShapeProblem {
 public:
  /// `observations` must outlive the problem. Only the bands in `band_observations` are used. A marker with a
  /// known position is compared with this position. A marker with an unknown position is compared between
  /// pictures. `prediction` also replaces the priors of the observations' views. `prediction` is ignored if
  /// its covariance is not positive definite.
  ShapeProblem(const ShapePrior& prior, std::span<const Observation> observations,
               std::vector<BandObservation> band_observations = {},
               const ShapePrediction* prediction = nullptr);

  /// Kind of a row of residuals. The last two kinds are not observations.
  enum class RowKind { point, border, end, marker, prior, prediction };

  /// Linearises at a shape. Returns false if a part of the shape is outside a lens's field of view.
  bool linearise(const Shape& shape);

  [[nodiscard]] const ShapeVariables& variables() const { return variables_; }
  [[nodiscard]] Eigen::Index rows() const { return count_; }
  [[nodiscard]] auto residuals() const { return residuals_.head(count_); }
  [[nodiscard]] auto derivatives() const { return derivatives_.topRows(count_); }
  [[nodiscard]] bool is_seen(Eigen::Index row) const { return kind(row) < RowKind::prior; }
  [[nodiscard]] RowKind kind(Eigen::Index row) const { return kinds_[static_cast<std::size_t>(row)]; }
  /// Returns the standard deviation by which a row was divided, px. Rows of the prior have other units.
  [[nodiscard]] double sigma(Eigen::Index row) const { return sigmas_[static_cast<std::size_t>(row)]; }
  /// Returns the index of the observation to which a row belongs.
  [[nodiscard]] std::size_t observation(Eigen::Index row) const {
    return of_observation_[static_cast<std::size_t>(row)];
  }
  /// Returns whether a prediction that is no guess is used.
  [[nodiscard]] bool is_filtered() const { return is_filtered_; }
  [[nodiscard]] const SpaceCurve& curve() const { return curve_; }
  [[nodiscard]] std::span<const Observation> observations() const { return observations_; }
  [[nodiscard]] std::span<const BandObservation> band_observations() const { return band_observations_; }

 private:
  void add_points(const Observation& seen);
  void add_borders(const Observation& seen, const Arm& arm);
  void add_ends(const Observation& seen);
  void add_markers(const Observation& seen, const Arm& arm);
  void add_bands(std::size_t observation, const Arm& arm);
  void add_prior(const Shape& shape);
  void add_prediction(const Shape& shape);
  void add_view_prior(std::size_t observation, const ViewError& error);
  // residual = direction . (pixel - curve).
  void add_row(RowKind kind, const Eigen::Vector2d& direction, const Eigen::Vector2d& off, double place,
               double sigma);

  ShapePrior prior_;
  ShapeVariables variables_;
  std::span<const Observation> observations_;
  std::vector<BandObservation> band_observations_;
  std::optional<Shape> predicted_;
  bool is_filtered_ = false;
  Eigen::MatrixXd prediction_;  // R, with R^T R the inverse of its covariance.
  SpaceCurve curve_;
  CurveImage image_;
  Eigen::Index count_ = 0;
  Eigen::VectorXd residuals_;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> derivatives_;
  std::vector<RowKind> kinds_;
  std::vector<double> sigmas_;
  std::vector<std::size_t> of_observation_;
  Eigen::RowVectorXd row_;
  // Position along the curve of a marker's first observation.
  struct FirstObservation {
    bool is_there = false;
    double place = 0, sigma = 0;  // In knots.
    Eigen::RowVectorXd unknowns;  // Derivative of the position.
  };
  std::vector<FirstObservation> first_observations_;
};

}  // namespace flexura
