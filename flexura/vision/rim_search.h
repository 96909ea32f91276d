#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/vision/arm_scene.h"
#include "flexura/vision/blurred_step.h"
#include "flexura/vision/rim_light.h"

namespace flexura {

/// Result of the search for one cross-section of a tube.
struct SeenSection {
  int rims = 0;      ///< Number of measured borders; 0: the section was not found.
  double shift = 0;  ///< Distance of the tube from its expected place, along the second rim's normal, px.
  double sigma = 0;  ///< Standard deviation of `shift`, px.
};

/// Measures in a picture how far a tube is from where a model expects it (docs/vision.md, "Model-based").
/// Not thread-safe.
class RimSearch {
 public:
  /// Prepares for a picture, gray or RGB. `scene`: what separates the arm from its surroundings; may be null.
  void begin(const Image<std::uint8_t>& picture, const ArmScene* scene);
  /// Returns why the scene could not be used with the picture, or "".
  [[nodiscard]] const std::string& complaint() const { return complaint_; }

  /// Searches the sections, which are in order along the arm, by the statistics of the light on both sides of
  /// the rims. The search covers 2.5 standard deviations (ExpectedSection::reach), at most 60 px. The result
  /// is accurate to about half a pixel.
  void look(std::span<const ExpectedSection> sections, std::vector<SeenSection>& seen);
  /// Measures the rims of sections that are expected within 2 px, by their edges, with subpixel accuracy.
  void refine(std::span<const ExpectedSection> sections, std::vector<SeenSection>& seen);
  /// Returns for each section whether something beside it, within `reach` px, looks much more like the tube.
  /// The light of the tube is that of the last look(), which had the same sections.
  [[nodiscard]] std::vector<bool> looks_elsewhere(std::span<const ExpectedSection> sections, double reach);
  /// Returns the width of the tube in the picture, divided by its expected width, as of the last refine().
  [[nodiscard]] double width_ratio() const { return width_ratio_; }

 private:
  struct Edge {
    bool is_seen = false;
    double offset = 0, sigma = 0;  // Outward, px.
  };
  [[nodiscard]] Edge edge(const ExpectedRim& rim, double room, double blur, double& misfit);
  // Sets score_ by shift, from -reach to reach. Returns the number of visible rims.
  int score(std::size_t i, int& pixels);
  [[nodiscard]] SeenSection match(std::size_t i, const ExpectedSection& section);
  void find_blur(std::span<const ExpectedSection> sections);

  std::vector<Image<std::uint8_t>> planes_;  // Channels of the picture, and the matte of the scene.
  Image<std::uint8_t> inside_;               // 0 outside the region; empty: no region.
  std::string complaint_;
  RimLight light_;
  BlurredSteps steps_;
  double blur_ = 0;  // px; 0: not known.
  double width_ratio_ = 1;
  std::vector<double> score_, ratios_;
  std::vector<std::array<Edge, 2>> edges_;
};

}  // namespace flexura
