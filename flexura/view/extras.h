#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/view/state_message.h"

// Drawings beside the arm and on its pictures at one instant (docs/viewer-protocol.md, "Extras"). Each source
// of drawings, such as servo_extras.h, creates an Extras. All sources use one kind of message.
namespace flexura {

/// A second arm drawn in the 3D view, such as the target shape.
struct GhostArm {
  std::string id, label;
  std::string color;               ///< "#rrggbb"
  std::vector<ArmSample> samples;  ///< Samples of the arm's backbone, as returned by arm_samples().
};

/// Layers on a camera's picture.
struct PictureLayers {
  std::string camera;
  /// Number of the picture to which the layers belong, as in image messages; missing: any picture.
  std::optional<std::int64_t> number;
  std::string reason;  ///< Why nothing was found in the picture, or "".
  Node::Array layers;  ///< Layers, as LAYER of the protocol (docs/viewer-protocol.md).
};

/// Values at equally spaced points along the arm, from base to tip.
struct AlongCurve {
  std::string id, label;
  std::string color;  ///< "#rrggbb"
  std::vector<double> values;
};

/// Name and colour of an item that several drawings show, for example the true arm.
struct ExtraName {
  const char *id, *label;
  const char* color;  ///< "#rrggbb"
};
/// The true arm of the simulation.
inline constexpr ExtraName true_arm{"truth", "True", "#51cf66"};

struct Extras {
  double time = 0;          ///< Time, s.
  std::string title, text;  ///< Title of the drawings in one line, and their status in one line.
  std::vector<GhostArm> ghosts;
  std::vector<PictureLayers> overlays;
  std::string along_label, along_unit;  ///< Label and unit of all curves.
  double length = 0;                    ///< Length of the arm along which the curves are drawn, m.
  std::vector<AlongCurve> along;
  /// Names and values of quantities; the names are those in series.
  std::vector<std::pair<std::string, double>> values;
};

/// Returns a line on a picture, rounded to 0.01 px. `id` and `color` are equal to the `id` and `color` of the
/// ghost that shows the same item in 3D.
[[nodiscard]] Node line_layer(const std::string& id, const std::string& color,
                              const std::vector<Eigen::Vector2d>& points, bool is_dashed = false);

/// Properties of a layer that the user can hide by a button.
struct LayerMark {
  std::string id, label;
  std::string color;  ///< "#rrggbb"
  std::string of;     ///< `id` of the ghost that is hidden together with this layer, or "".
};
/// Returns crosses or separate lines on a picture, rounded to 0.01 px.
[[nodiscard]] Node points_layer(const LayerMark& mark, const std::vector<Eigen::Vector2d>& points);
[[nodiscard]] Node lines_layer(const LayerMark& mark, const std::vector<std::vector<Eigen::Vector2d>>& lines,
                               bool is_dashed = false);

/// Number of the stream with extras messages.
inline constexpr std::uint32_t extras_stream = 0xffffffff;
/// Returns the binary message with the extras. Empty extras remove the previous drawings.
[[nodiscard]] std::string extras_message(const Extras& extras);

}  // namespace flexura
