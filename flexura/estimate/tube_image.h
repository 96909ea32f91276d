#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "flexura/estimate/curve_image.h"
#include "flexura/estimate/observation.h"
#include "flexura/estimate/shape_variables.h"
#include "flexura/estimate/space_curve.h"
#include "flexura/vision/rim_light.h"

namespace flexura {

/// The image of a cross-section of a tube.
struct TubeSection {
  ExpectedSection expected;         ///< Its rims in the picture.
  Eigen::Vector2d pixel = {0, 0};   ///< Image of the backbone, px.
  Eigen::Vector2d normal = {1, 0};  ///< Unit normal of the backbone's image, towards the second rim.
  bool is_measurable = false;       ///< Whether both rims are in the picture and not both are hidden.
};

/// The images of a shape's tube: its rims, and how far off they may be. A rim is where a line of sight
/// touches the tube: at the distance r n from the backbone, with n . t = 0 and n . c = -r (docs/vision.md,
/// "Where the backbone is seen"). This is exact for a constant radius.
class TubeImage {
 public:
  /// `observations`: their views; their view priors determine which views have an error.
  TubeImage(const ShapePrior& prior, std::span<const Observation> observations);

  /// Sets the shape and the covariance of the unknowns. Returns false if a lens cannot image the shape.
  bool set(const Shape& shape, const Eigen::MatrixXd& covariance);
  /// Computes the cross-sections in picture `i`, evenly spaced along the arm from base to tip. Their number
  /// depends only on the prior and the first shape.
  void sections(std::size_t i, std::vector<TubeSection>& result);

 private:
  struct Place {
    Eigen::Vector3d position, tangent;  // W
    double radius = 0, knot = 0;
  };
  void set_places(const Shape& shape);
  [[nodiscard]] TubeSection section(const Place& place, const View& view, const CurveImage& image);
  static void hide_overlaps(std::vector<TubeSection>& sections);

  ShapePrior prior_;
  std::span<const Observation> observations_;
  ShapeVariables variables_;
  SpaceCurve curve_;
  std::vector<CurveImage> images_;
  std::vector<View> views_;
  std::vector<Place> places_;
  Eigen::MatrixXd covariance_;
  Eigen::RowVectorXd row_;
  std::size_t count_ = 0;
};

}  // namespace flexura
