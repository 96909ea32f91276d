// Fuzzes the estimation. The input is a file of cameras, a zero byte, the search settings, and the picture
// files, each after the mark below. Missing pictures default to a bent tube. Required: an error, or one JSON
// document without null if a shape was found, and the same result when run again.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/app/estimate.h"
#include "flexura/base/node.h"
#include "flexura/base/source.h"
#include "flexura/estimate/shape_estimator.h"
#include "flexura/store/json.h"
#include "flexura/store/toml.h"
#include "flexura/vision/threshold.h"

namespace {

constexpr std::string_view mark = "\n--\n";

// Returns a PGM file of 48 x 40 px: a dark arc 6 px wide that is cut by the lower border and ends within the
// picture.
std::string bent_tube() {
  constexpr int width = 48, height = 40;
  std::string file = "P5\n48 40\n255\n";
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const double beside = std::abs(std::hypot(u - 52, v - 42) - 30) - 3,
                   share = u > 40 ? 0 : std::clamp(0.5 - beside, 0.0, 1.0);
      file += static_cast<char>(static_cast<std::uint8_t>(220 - 190 * share));
    }
  }
  return file;
}

// Returns the text before `end`, or all of it, and removes both from `text`.
std::string_view take(std::string_view& text, std::string_view end) {
  const std::size_t at = text.find(end);
  const std::string_view piece = text.substr(0, at);
  text.remove_prefix(at == std::string_view::npos ? text.size() : at + end.size());
  return piece;
}

struct Asked {
  std::string cameras;
  std::vector<flexura::PictureFile> pictures;
  flexura::EstimateConfig config;
};

// Bits of `ways`: known base, known length, known sections, thresholds by block, markers, few sections, as
// thorough as the program. The last two take most of the time and are used in few cases. With few sections
// the last one is tried with many bends if no shape explains the pictures. A thorough search goes on if
// nothing is found.
flexura::EstimateConfig config_of(unsigned ways) {
  flexura::EstimateConfig config;
  std::optional<Eigen::Vector3d> base;
  std::optional<double> length;
  if ((ways & 1U) != 0) base = Eigen::Vector3d::Zero();
  if ((ways & 2U) != 0) length = 1;
  config.has_bends = (ways & 4U) != 0;
  if (config.has_bends)
    config.prior.arm.sections.resize((ways & 32U) != 0 ? 2 : 5, {.length = 0.2, .radius = {0.02, 0.02}});
  else
    config.prior = flexura::unknown_arm(base, length, 6);
  if ((ways & 8U) != 0) config.threshold.method = flexura::ThresholdMethod::by_block;
  if ((ways & 16U) != 0) config.prior.markers = {0.25, 0.5};
  config.points = 5;
  if ((ways & 64U) == 0) config.estimator.most_points = 24, config.estimator.most_iterations = 12;
  return config;
}

Asked asked(std::string_view input) {
  static const std::string tube = bent_tube();
  Asked result;
  result.cameras = take(input, std::string_view("\0", 1));
  const std::string_view ways = take(input, mark);
  result.config = config_of(ways.empty() ? 3U : static_cast<unsigned char>(ways[0]));
  constexpr std::size_t most = 3;
  while (!input.empty() && result.pictures.size() < most)
    result.pictures.push_back({"picture", std::string(take(input, mark))});
  while (result.pictures.size() < 2) result.pictures.push_back({"tube", tube});
  return result;
}

std::string answer(const Asked& asked) {
  try {
    const flexura::Node file = flexura::parse_toml(asked.cameras, "cameras.toml");
    const auto cameras = flexura::standing_cameras(file, asked.pictures.size());
    const auto found = flexura::estimate_shape(asked.pictures, cameras, asked.config);
    const bool has_shape = found.answer.find("backbone") != nullptr;
    if (found.is_found != has_shape || has_shape == (found.answer.find("reason") != nullptr)) std::abort();
    const std::string text = flexura::write_json(found.answer);
    if (has_shape && text.find("null") != std::string::npos) std::abort();
    return text;
  } catch (const flexura::InputError& error) {
    return std::string("\"") + (error.problems().empty() ? "" : "problem") + "\"";
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 20000) return 0;
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  const Asked what = asked(input);
  const std::string once = answer(what);
  (void)flexura::parse_json(once, "answer");
  if (size % 16 == 0 && once != answer(what)) std::abort();
  return 0;
}
