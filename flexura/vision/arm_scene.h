#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/vision/picture_frame.h"

namespace flexura {

/// What separates the arm from its surroundings in one camera's pictures (docs/vision.md, "Arms in front of
/// anything"). A pixel belongs to the arm only if everything that is given agrees.
struct ArmScene {
  /// Corners of the polygon in which the arm is searched, px; empty: the whole picture.
  std::vector<Eigen::Vector2d> region = {};
  /// Picture of the surroundings without the arm, with the size of the pictures; empty: none.
  Image<std::uint8_t> background = {};
  /// Red, green and blue of the arm, from 0 to 255.
  std::optional<Eigen::Vector3d> color = {};
  /// Mask of the arm, made elsewhere, with one channel and the size of the pictures; empty: none. Values from
  /// 128 are the arm.
  Image<std::uint8_t> mask = {};

  /// Returns whether something besides the region is given.
  [[nodiscard]] bool has_cues() const {
    return !background.values().empty() || color || !mask.values().empty();
  }
};

/// The part of a picture in which the arm is searched.
struct ScenePart {
  std::string reason;              ///< Why the scene does not fit the picture; otherwise "".
  std::vector<std::string> notes;  ///< Messages for the user.
  PixelBox box;                    ///< The part in the whole picture. All images below have its size.
  Image<std::uint8_t> inside;      ///< 0 outside the region; empty if the region is a whole rectangle.
  Image<std::uint8_t> gray;        ///< The gray picture; without matte only.
  /// The gray picture in which pixels outside the region repeat their neighbours inside; without matte only.
  Image<std::uint8_t> filled;
  bool has_matte = false;
  Image<std::uint8_t> figures;  ///< Pixels of the arm (255) and of everything else (0).
  /// Share of the arm in the light of each pixel, 1 being 255 * matte_scale.
  Image<std::uint8_t> matte;
  double matte_scale = 1;
  Image<std::uint8_t> soft;  ///< `figures`, blurred by a pixel.
  double contrast = 255;     ///< Mean contrast between the arm and the surroundings, of 255.
};

/// Applies a scene to a picture, gray or in colour.
[[nodiscard]] ScenePart part_in_scene(const ArmScene& scene, const Image<std::uint8_t>& picture);

}  // namespace flexura
