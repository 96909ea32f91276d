#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/view/state_message.h"

// What is drawn beside the arm and upon its pictures, of one instant (docs/viewer-protocol.md, "Extras").
// Whoever knows something to draw makes an Extras of it, as servo_extras.h does: there is one message for all
// of them.
namespace flexura {

/// Another arm in the 3D view.
struct GhostArm {
  std::string id, label;
  std::string color;               ///< "#rrggbb"
  std::vector<ArmSample> samples;  ///< Of its backbone, as arm_samples gives them.
};

/// What lies upon a camera's picture.
struct PictureLayers {
  std::string camera;
  /// Of the picture that it belongs to, as image messages number them; none: to any.
  std::optional<std::int64_t> number;
  std::string reason;  ///< Why nothing was found in it; "": something was.
  Node::Array layers;  ///< LAYER
};

/// A number at equal shares of the arm's length, from base to tip.
struct AlongCurve {
  std::string id, label;
  std::string color;  ///< "#rrggbb"
  std::vector<double> values;
};

/// A thing that is shown in more than one place has one name and one colour there.
struct ExtraName {
  const char *id, *label;
  const char* color;  ///< "#rrggbb"
};
/// The simulated truth.
inline constexpr ExtraName true_arm{"truth", "True", "#51cf66"};

struct Extras {
  double time = 0;          ///< s
  std::string title, text;  ///< What this is of, and how that stands, a line each.
  std::vector<GhostArm> ghosts;
  std::vector<PictureLayers> overlays;
  std::string along_label, along_unit;  ///< Of all curves.
  double length = 0;                    ///< Of the arm along which they lie, m.
  std::vector<AlongCurve> along;
  std::vector<std::pair<std::string, double>> values;  ///< Quantities by name, as series have them.
};

/// A line upon a picture, to a hundredth of a pixel. `id` and `color` as a ghost's of the same thing.
[[nodiscard]] Node line_layer(const std::string& id, const std::string& color,
                              const std::vector<Eigen::Vector2d>& points, bool is_dashed = false);

/// What layers that belong to a thing with an eye of its own have in common.
struct LayerMark {
  std::string id, label;
  std::string color;  ///< "#rrggbb"
  std::string of;     ///< The ghost whose eye hides it, too; "": none.
};
/// Crosses upon a picture, or lines that do not hang together, to a hundredth of a pixel.
[[nodiscard]] Node points_layer(const LayerMark& mark, const std::vector<Eigen::Vector2d>& points);
[[nodiscard]] Node lines_layer(const LayerMark& mark, const std::vector<std::vector<Eigen::Vector2d>>& lines,
                               bool is_dashed = false);

/// The stream of these messages to a client.
inline constexpr std::uint32_t extras_stream = 0xffffffff;
/// The binary message. Extras that hold nothing take away what was drawn before.
[[nodiscard]] std::string extras_message(const Extras& extras);

}  // namespace flexura
