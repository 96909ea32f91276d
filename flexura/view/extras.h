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
// of drawings creates an Extras (for example servo_extras.h); one message serves all of them.
namespace flexura {

/// Another arm in the 3D view.
struct GhostArm {
  std::string id, label;
  std::string color;               ///< "#rrggbb"
  std::vector<ArmSample> samples;  ///< Samples of its backbone, as returned by arm_samples().
};

/// Layers on a camera's picture.
struct PictureLayers {
  std::string camera;
  /// Number of the picture, as in image messages; missing: any picture.
  std::optional<std::int64_t> number;
  std::string reason;  ///< Why nothing was found in the picture; "" if something was found.
  Node::Array layers;  ///< LAYER
};

/// Values at equally spaced points along the arm, from base to tip.
struct AlongCurve {
  std::string id, label;
  std::string color;  ///< "#rrggbb"
  std::vector<double> values;
};

/// Name and colour of an item that is shown in several places.
struct ExtraName {
  const char *id, *label;
  const char* color;  ///< "#rrggbb"
};
/// The simulated truth.
inline constexpr ExtraName true_arm{"truth", "True", "#51cf66"};

struct Extras {
  double time = 0;          ///< s
  std::string title, text;  ///< What this shows, and its status, one line each.
  std::vector<GhostArm> ghosts;
  std::vector<PictureLayers> overlays;
  std::string along_label, along_unit;  ///< Label and unit of all curves.
  double length = 0;                    ///< Length of the arm along which the curves run, m.
  std::vector<AlongCurve> along;
  std::vector<std::pair<std::string, double>> values;  ///< Quantities by the names used in series.
};

/// Returns a line on a picture, rounded to a hundredth of a pixel. `id` and `color` match those of the ghost
/// that shows the same item.
[[nodiscard]] Node line_layer(const std::string& id, const std::string& color,
                              const std::vector<Eigen::Vector2d>& points, bool is_dashed = false);

/// Common properties of layers that have their own visibility button.
struct LayerMark {
  std::string id, label;
  std::string color;  ///< "#rrggbb"
  std::string of;     ///< Ghost layer whose visibility button also hides this layer; "": none.
};
/// Returns crosses, or separate lines, on a picture, rounded to a hundredth of a pixel.
[[nodiscard]] Node points_layer(const LayerMark& mark, const std::vector<Eigen::Vector2d>& points);
[[nodiscard]] Node lines_layer(const LayerMark& mark, const std::vector<std::vector<Eigen::Vector2d>>& lines,
                               bool is_dashed = false);

/// Stream number of these messages to a client.
inline constexpr std::uint32_t extras_stream = 0xffffffff;
/// Returns the binary message. Empty extras remove the previous drawings.
[[nodiscard]] std::string extras_message(const Extras& extras);

}  // namespace flexura
