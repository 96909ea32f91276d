#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "flexura/camera/view.h"
#include "flexura/estimate/observation.h"
#include "flexura/estimate/space_curve.h"

namespace flexura {

/// The image of a backbone: a cubic curve through the images of the backbone's knots, with their tangents.
/// For arcs of 1/8 rad between knots, the curve is accurate to 1e-6 of the arc's radius.
class CurveImage {
 public:
  /// Sets the curve. Returns false if the lens cannot image a knot.
  bool set(const View& view, const SpaceCurve& curve) { return set(view, {}, curve, -1, -1); }
  /// Sets the curve for a view with this `error`. `count`: number of columns of derivatives. Columns from
  /// `own` on are derivatives with respect to the error; `own` = -1: there are no such columns.
  bool set(const View& view, const ViewError& error, const SpaceCurve& curve, Eigen::Index own,
           Eigen::Index count);

  /// Returns the position of the last knot. Positions are fractional indices of knots, from 0 at the base.
  [[nodiscard]] double last() const { return static_cast<double>(pieces_.size()); }

  /// A point of the image.
  struct Point {
    double place = 0;         ///< Position along the curve: fractional index of knots.
    Eigen::Vector2d pixel;    ///< Image point of the curve, px.
    Eigen::Vector2d tangent;  ///< Unit tangent.
    double speed = 0;         ///< Speed along the curve, px per knot.
    double scale = 0;         ///< Scale perpendicular to the line of sight, px per metre.
  };
  /// Returns the point at the position `place`, from 0 to last(). Outside this range, the cubic of the
  /// nearest piece is extended.
  [[nodiscard]] Point at(double place) const;
  /// Range of a search, as indices of knots. The search begins with the interval after the knot `likely`.
  struct Window {
    std::size_t first = 0, last = 0, likely = 0;
  };
  /// Returns the range of the whole curve. The search begins at the first knot.
  [[nodiscard]] Window everywhere() const { return {0, pieces_.size(), 0}; }
  /// Returns the curve's point nearest to a pixel, among the points in a window whose tangent is similar to
  /// the unit vector `heading`. Thus `heading` selects the right branch of a hairpin curve.
  [[nodiscard]] Point nearest(const Eigen::Vector2d& pixel, const Eigen::Vector2d& heading,
                              const Window& window) const;
  /// Sets `row` to the derivative of the pixel with respect to the unknowns, projected on `direction`, at a
  /// position.
  void along(const Eigen::Vector2d& direction, double place, Eigen::Ref<Eigen::RowVectorXd> row) const;

 private:
  // Piece from one knot to the next: a + f (da + f (c2 + f c3)) for f from 0 to 1. The piece is inside a
  // disc.
  struct Piece {
    Eigen::Vector2d a, da, c2, c3, middle;
    double radius = 0;
    [[nodiscard]] Eigen::Vector2d at(double f) const { return a + f * (da + f * (c2 + f * c3)); }
    [[nodiscard]] Eigen::Vector2d slope(double f) const { return da + f * (2 * c2 + 3 * f * c3); }
    [[nodiscard]] Eigen::Vector2d bend(double f) const { return 2 * c2 + 6 * f * c3; }
  };
  [[nodiscard]] static Piece piece(const Eigen::Vector2d& a, const Eigen::Vector2d& da,
                                   const Eigen::Vector2d& b, const Eigen::Vector2d& db);
  [[nodiscard]] static double foot(const Piece& piece, const Eigen::Vector2d& pixel);

  using Unknowns = Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::RowMajor>;
  std::vector<Piece> pieces_;
  std::vector<Unknowns> unknowns_;  // Derivatives of the knots' pixels.
  std::vector<double> scales_;      // Image scales at the knots, px per metre.
  std::size_t in_section_ = 2;      // Pieces in each section.
};

}  // namespace flexura
