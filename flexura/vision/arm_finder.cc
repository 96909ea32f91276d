#include "flexura/vision/arm_finder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "flexura/base/table.h"
#include "flexura/vision/arm_scene.h"
#include "flexura/vision/arm_search.h"
#include "flexura/vision/eight_bits.h"
#include "flexura/vision/picture_file.h"
#include "flexura/vision/picture_frame.h"

namespace flexura {
namespace {

double scale_of(const Image<std::uint8_t>&, int) { return 1; }
double scale_of(const Image<std::uint16_t>&, int white) { return white / 255.0; }

// Returns the picture blurred by a Gaussian of 1 px.
template <typename Value>
Image<Value> blurred(const Image<Value>& picture) {
  Image<Value> result(picture.width(), picture.height());
  const int type = std::is_same_v<Value, std::uint8_t> ? CV_8U : CV_16U;
  const cv::Mat from(picture.height(), picture.width(), type, const_cast<Value*>(picture.values().data()));
  cv::Mat to(result.height(), result.width(), type, result.values().data());
  constexpr double blur = 1;
  cv::GaussianBlur(from, to, {7, 7}, blur, blur, cv::BORDER_REPLICATE);
  return result;
}

}  // namespace

const std::vector<std::string>& names_of(const AxisEndKind*) {
  static const std::vector<std::string> names = {"free", "border", "lost"};
  return names;
}

struct ArmFinder::Work {
  ArmFinderConfig config;
  ArmSearch search;
  std::vector<Eigen::Vector2d> expected;  // Prediction for the next picture; empty: none.
  Image<std::uint8_t> bytes;              // Of a picture with more bits.
  Image<std::uint8_t> cut_bytes;          // The part of a picture in which the arm is searched.
  Image<std::uint16_t> cut_words;

  void begin();
  void search_from(const PixelBox& box);
  template <typename Value>
  bool run(const Image<Value>& picture, const Image<std::uint8_t>& gray, double scale,
           const ThresholdConfig& threshold);
  template <typename Value>
  bool try_methods(const Image<Value>& picture, const Image<std::uint8_t>& gray, double scale);
  template <typename Value>
  const ArmObservation& find(const Image<Value>& picture, const Image<std::uint8_t>& gray, double scale);
  const ArmObservation& find_in_scene(const Image<std::uint8_t>& picture, const Image<std::uint16_t>* words,
                                      int white);
  const ArmObservation& end();

  Image<std::uint8_t>& cut_of(const Image<std::uint8_t>&) { return cut_bytes; }
  Image<std::uint16_t>& cut_of(const Image<std::uint16_t>&) { return cut_words; }
};

ArmFinder::ArmFinder(ArmFinderConfig config) : work_(std::make_unique<Work>()) {
  work_->config = std::move(config);
}
ArmFinder::~ArmFinder() = default;
ArmFinder::ArmFinder(ArmFinder&&) noexcept = default;
ArmFinder& ArmFinder::operator=(ArmFinder&&) noexcept = default;

void ArmFinder::Work::begin() {
  search.config = config;
  search.origin = {0, 0};
  search.inside = nullptr;
  search.stops_at_frame = true;
  search.expected.set(expected, {0, 0});
}

// Searches in a part of the picture from now on.
void ArmFinder::Work::search_from(const PixelBox& box) {
  search.origin = {box.left, box.top};
  if (config.base) search.config.base = *config.base - search.origin;
  search.expected.set(expected, search.origin);
  search.stops_at_frame = false;
}

// Searches the arm. The border model does not hold for lines of one or two pixels without blur: these are
// blurred first, which moves no centerline.
template <typename Value>
bool ArmFinder::Work::run(const Image<Value>& picture, const Image<std::uint8_t>& gray, double scale,
                          const ThresholdConfig& threshold) {
  if (!search.run(picture, gray, scale, threshold)) return false;
  constexpr double thin = 4.5, sigma = 0.06;
  if (search.seen.is_found() || search.thinnest() > thin) return true;
  ArmObservation first = search.seen;
  search.config.least_sigma = std::max(config.least_sigma, sigma);
  search.run(blurred(picture), blurred(gray), scale, threshold);
  search.config.least_sigma = config.least_sigma;
  if (!search.is_clear()) search.seen = std::move(first);
  return true;
}

// Finds the arm by the method in the settings. If this is Otsu's and shows no arm, tries the other methods:
// Otsu's classes depend on their areas, so that an uneven ground or a thin arm misleads it. Returns false if
// the search stopped at a frame.
template <typename Value>
bool ArmFinder::Work::try_methods(const Image<Value>& picture, const Image<std::uint8_t>& gray,
                                  double scale) {
  if (!run(picture, gray, scale, config.threshold)) return false;
  if (search.seen.is_found() || config.threshold.method != ThresholdMethod::otsu ||
      !config.tries_other_methods)
    return true;
  ArmObservation first = search.seen;
  bool is_plain = !first.threshold.reason.empty();
  std::string reasons;
  for (const ThresholdMethod method : {ThresholdMethod::two_mode, ThresholdMethod::by_block}) {
    ThresholdConfig other = config.threshold;
    other.method = method;
    search.stops_at_frame = false;
    run(picture, gray, scale, other);
    if (search.is_clear()) {
      search.seen.notes.push_back(fmt::format("the threshold method {} shows the arm; otsu does not: {}",
                                              name_of(method), first.reason));
      return true;
    }
    is_plain = is_plain && !search.seen.threshold.reason.empty();
    reasons += fmt::format("; {}: {}", name_of(method),
                           search.seen.is_found() ? "shows a tube without clear ends" : search.seen.reason);
  }
  if (!is_plain)
    first.reason = fmt::format(
        "no threshold shows an arm: otsu: {}{}. Try a fixed level, a region, a picture of the background, or "
        "the arm's colour",
        first.reason, reasons);
  search.seen = std::move(first);
  return true;
}

template <typename Value>
const ArmObservation& ArmFinder::Work::find(const Image<Value>& picture, const Image<std::uint8_t>& gray,
                                            double scale) {
  begin();
  if (try_methods(picture, gray, scale)) return end();
  const PixelBox box = search.part;
  search_from(box);
  Image<Value>& part = cut_of(picture);
  cut_out(picture, box, part);
  if constexpr (std::is_same_v<Value, std::uint8_t>) {
    try_methods(part, part, scale);
  } else {
    cut_out(gray, box, cut_bytes);
    try_methods(part, cut_bytes, scale);
  }
  search.seen.notes.push_back(fmt::format("the picture has a frame: searched columns {} to {}, rows {} to {}",
                                          box.left, box.right - 1, box.top, box.bottom - 1));
  return end();
}

// Shifts the result from the searched part to the whole picture.
const ArmObservation& ArmFinder::Work::end() {
  ArmObservation& seen = search.seen;
  expected.clear();
  if (search.origin.isZero()) return seen;
  for (AxisSample& sample : seen.axis) sample.pixel += search.origin;
  for (AxisEnd& end : seen.ends) end.pixel += search.origin;
  for (BorderPoint& point : seen.unexplained) point.pixel += search.origin;
  for (Eigen::Vector2d& place : seen.places) place += search.origin;
  return seen;
}

const ArmObservation& ArmFinder::Work::find_in_scene(const Image<std::uint8_t>& picture,
                                                     const Image<std::uint16_t>* words, int white) {
  begin();
  const ScenePart part = part_in_scene(*config.scene, picture);
  search_from(part.box);
  search.inside = part.inside.values().empty() ? nullptr : &part.inside;
  if (!part.reason.empty()) {
    search.seen = {};
    search.seen.reason = part.reason;
    return end();
  }
  if (!part.has_matte) {
    if (words == nullptr) {
      try_methods(part.gray, part.filled, 1);
    } else {
      cut_out(*words, part.box, cut_words);
      try_methods(cut_words, part.filled, scale_of(*words, white));
    }
    search.inside = nullptr;
    return end();
  }
  ThresholdConfig threshold;
  threshold.method = ThresholdMethod::fixed, threshold.level = 127.5, threshold.figure = Figure::bright;
  search.run(part.matte, part.figures, part.matte_scale, threshold);
  // The mask alone is less accurate, but always has clear borders.
  if (!search.is_clear()) {
    const ArmObservation by_matte = search.seen;
    search.config.least_sigma = std::max(config.least_sigma, mask_sigma);
    search.run(part.soft, part.figures, 1, threshold);
    if (!search.seen.is_found() || (by_matte.is_found() && by_matte.covered >= search.seen.covered))
      search.seen = by_matte;
    else
      search.seen.notes.emplace_back(
          "the arm's borders are unclear in the picture: only the mask of the arm was measured");
  }
  search.inside = nullptr;
  search.seen.noise *= part.contrast / 255, search.seen.contrast *= part.contrast / 255;
  search.seen.notes.insert(search.seen.notes.end(), part.notes.begin(), part.notes.end());
  return end();
}

void ArmFinder::set_methods(ThresholdMethod first, bool tries_others) {
  work_->config.threshold.method = first, work_->config.tries_other_methods = tries_others;
}

void ArmFinder::expect(std::span<const Eigen::Vector2d> axis) {
  work_->expected.assign(axis.begin(), axis.end());
}

const ArmObservation& ArmFinder::find(const Image<std::uint8_t>& gray) {
  if (work_->config.scene) return work_->find_in_scene(gray, nullptr, 255);
  return work_->find(gray, gray, scale_of(gray, 255));
}

const ArmObservation& ArmFinder::find(const Image<std::uint16_t>& gray, int white) {
  Work& work = *work_;
  work.bytes = eight_bits(gray, white);
  if (work.config.scene) return work.find_in_scene(work.bytes, &gray, white);
  return work.find(gray, work.bytes, scale_of(gray, white));
}

const ArmObservation& ArmFinder::find(const Picture& picture, int white) {
  const auto* words = std::get_if<Image<std::uint16_t>>(&picture);
  if (work_->config.scene) {
    const Image<std::uint8_t> bytes = eight_bits(picture, white);
    if (words == nullptr) return work_->find_in_scene(bytes, nullptr, 255);
    const Image<std::uint16_t> gray = gray_picture(*words);
    return work_->find_in_scene(bytes, &gray, white);
  }
  if (words != nullptr)
    return words->channels() == 1 ? find(*words, white) : find(gray_picture(*words), white);
  const auto& bytes = std::get<Image<std::uint8_t>>(picture);
  if (white != 255) return find(eight_bits(picture, white), 255);
  return bytes.channels() == 1 ? find(bytes) : find(gray_picture(bytes));
}

const ArmObservation& ArmFinder::find(const Photograph& photograph) {
  const ArmFinderConfig asked = work_->config;
  if (photograph.is_mask) work_->config.least_sigma = std::max(asked.least_sigma, mask_sigma);
  const bool has_words = !photograph.words.values().empty();
  const ArmObservation* seen = nullptr;
  if (asked.scene) {
    const Image<std::uint16_t> words = has_words ? gray_picture(photograph.words) : Image<std::uint16_t>();
    seen = &work_->find_in_scene(photograph.bytes, has_words ? &words : nullptr, photograph.white);
  } else {
    seen = has_words ? &find(gray_picture(photograph.words), photograph.white)
                     : &find(gray_picture(photograph.bytes));
  }
  work_->config = asked;
  return *seen;
}

}  // namespace flexura
