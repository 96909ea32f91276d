#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "flexura/base/image.h"

namespace flexura {

/// A border of a tube where a model expects it in a picture.
struct ExpectedRim {
  Eigen::Vector2d pixel = {0, 0};
  Eigen::Vector2d outward = {1, 0};  ///< Unit normal, away from the tube.
  bool is_visible = true;            ///< Whether no other part of the tube is there.
};

/// A cross-section of a tube where a model expects it in a picture.
struct ExpectedSection {
  std::array<ExpectedRim, 2> rims;
  double width = 0;  ///< Distance of the rims, px; > 0.
  double reach = 0;  ///< Standard deviation of the section's place across the tube, px; > 0.
};

/// Light along the normals of a tube's rims, and how much likelier it is the tube's than the surroundings'.
/// The tube's light is normally distributed. Its mean and variance are those of pixels that surely belong to
/// the tube, on the same stretch of the tube. The surroundings' mean and variance are local, too, and differ
/// on both sides. Both models allow for a share of outliers (docs/vision.md, "Model-based").
class RimLight {
 public:
  static constexpr std::size_t most_planes = 4;
  /// Samples along a rim's normal, one per pixel, from inside to outside.
  struct Profile {
    bool is_seen = false;
    int reach = 0;             ///< Largest shift of the rim, px.
    int inner = 0, outer = 0;  ///< Samples that are compared inside and outside a rim.
    std::size_t first = 0;     ///< Of the sums in log_ratio_sums().
    [[nodiscard]] int count() const { return 2 * reach + inner + outer; }
  };

  /// Samples the planes of a picture. Pixels where `inside` is 0 are not used; it may be empty. If it
  /// `keeps_light`, the light of tube and surroundings is that of the last call, with the same sections.
  void measure(std::span<const Image<std::uint8_t>> planes, const Image<std::uint8_t>& inside,
               std::span<const ExpectedSection> sections, bool keeps_light = false);

  /// Returns the profile at a rim.
  [[nodiscard]] const Profile& profile(std::size_t section, std::size_t rim) const {
    return profiles_[2 * section + rim];
  }
  /// Returns the sums of the logarithms of likelihood ratios (tube to surroundings) of the samples before
  /// each sample of a profile: count() + 1 numbers.
  [[nodiscard]] std::span<const float> log_ratio_sums(const Profile& profile) const {
    return {sums_.data() + profile.first, static_cast<std::size_t>(profile.count()) + 1};
  }

 private:
  using Values = std::array<float, most_planes>;
  // Number, sum and sum of squares of samples, by plane.
  struct Moments {
    double count = 0;
    std::array<double, most_planes> sum = {}, square = {};
    void add(const Values& value, std::size_t planes);
    void add(const Moments& other, double sign, std::size_t planes);
  };
  struct Normal {
    Values mean = {}, factor = {};  // Factor: 1 / (sqrt(2) sigma).
    float scale = 1;                // Density at the mean, relative to that of evenly distributed light.
  };
  [[nodiscard]] Normal normal_of(const Moments& moments, double least_sigma) const;
  void sample(std::span<const Image<std::uint8_t>> planes, const Image<std::uint8_t>& inside,
              const ExpectedSection& section, std::size_t rim, Profile& profile);
  void add_moments(std::span<const ExpectedSection> sections);
  void leave_out_strangers();
  [[nodiscard]] Moments inside_near(std::size_t section) const;
  [[nodiscard]] Moments outside_near(std::size_t section, std::size_t rim) const;
  [[nodiscard]] float log_ratio(const Values& value, const Normal& tube, const Normal& around) const;

  std::size_t planes_ = 1;
  std::vector<Profile> profiles_;
  std::vector<Values> values_;
  std::vector<std::uint8_t> is_known_;  // Whether a sample is in the picture and its region.
  std::vector<float> sums_;
  // Sums over all sections before a section: of the pixels inside, and outside each rim.
  std::vector<Moments> inside_, middle_;
  std::vector<Moments> own_;  // Of the pixels inside, by section.
  std::vector<double> means_;
  std::array<std::vector<Moments>, 2> outside_;
};

}  // namespace flexura
