#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/vision/picture_frame.h"

namespace flexura {

/// Cues that separate the arm from its surroundings in the pictures of one camera (docs/vision.md, "Arms in
/// front of anything"). All cues are optional. A pixel belongs to the arm only if all given cues agree.
struct ArmScene {
  /// Corners of the polygon that the search for the arm covers, px; empty: the whole picture.
  std::vector<Eigen::Vector2d> region = {};
  /// Picture of the surroundings without the arm, with the same size as the pictures. Empty: not given.
  Image<std::uint8_t> background = {};
  /// Red, green and blue of the arm, from 0 to 255.
  std::optional<Eigen::Vector3d> color = {};
  /// Mask of the arm from another program, with one channel and the same size as the pictures. Pixels with
  /// values from 128 to 255 are the arm. Empty: not given.
  Image<std::uint8_t> mask = {};

  /// Returns whether a background, a colour or a mask is given.
  [[nodiscard]] bool has_cues() const {
    return !background.values().empty() || color || !mask.values().empty();
  }
};

/// The part of a picture that the search for the arm covers, and which of its pixels are the arm.
struct ScenePart {
  std::string reason;              ///< Reason why the cues cannot be used for this picture, or "".
  std::vector<std::string> notes;  ///< Messages for the user.
  PixelBox box;                    ///< Position of the part in the picture. All images below have its size.
  Image<std::uint8_t> inside;      ///< 0 outside the region; empty if the region is a whole rectangle.
  Image<std::uint8_t> gray;        ///< The gray picture; only if has_matte is false.
  /// The gray picture, in which each pixel outside the region has the value of a pixel near it inside the
  /// region; only if has_matte is false.
  Image<std::uint8_t> filled;
  bool has_matte =
      false;  ///< Whether the four members below are set: a background, a colour or a mask is given.
  Image<std::uint8_t> figures;  ///< Pixels of the arm (255) and of everything else (0).
  /// Share of each pixel that the arm covers, from 0 to 1, multiplied by 255 * matte_scale.
  Image<std::uint8_t> matte;
  double matte_scale = 1;
  Image<std::uint8_t> soft;  ///< `figures`, blurred by a pixel.
  double contrast = 255;     ///< Mean contrast between the arm and the surroundings, of 255.
};

/// Finds the pixels of the arm in a picture (gray or in colour) with the cues of `scene`.
[[nodiscard]] ScenePart part_in_scene(const ArmScene& scene, const Image<std::uint8_t>& picture);

}  // namespace flexura
