#include "flexura/vision/arm_matte.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <span>
#include <vector>

#include "flexura/math/median.h"
#include "flexura/vision/picture_file.h"
#include "flexura/vision/threshold.h"

namespace flexura {
namespace {

// Standard deviations per median absolute deviation of normal numbers.
constexpr double sigma_of_mad = 1.4826;

cv::Mat view_of(const Image<std::uint8_t>& image) {
  return {image.height(), image.width(), image.channels() == 1 ? CV_8UC1 : CV_8UC3,
          const_cast<std::uint8_t*>(image.values().data())};
}

Image<std::uint8_t> image_of(const cv::Mat& mat) {
  Image<std::uint8_t> image(mat.cols, mat.rows);
  cv::Mat to = view_of(image);
  mat.convertTo(to, CV_8U);
  return image;
}

// Returns a part of a picture, with the same number of channels as `like`: gray if either is gray.
cv::Mat floats_of(const Image<std::uint8_t>& picture, const PixelBox& box, bool is_gray) {
  cv::Mat result;
  const cv::Rect rect(box.left, box.top, box.width(), box.height());
  if (is_gray) {
    const Image<std::uint8_t> gray = gray_picture(picture);
    view_of(gray)(rect).convertTo(result, CV_32F);
  } else {
    view_of(picture)(rect).convertTo(result, CV_32F);
  }
  return result;
}

// Gain and offset of the light since the background was photographed.
struct LightChange {
  double gain = 1, offset = 0, sigma = 0;
};

// Fits picture = gain * background + offset to most of the pixels, by least squares over those whose
// residuals are within 2.5 standard deviations of the median, repeatedly. A background without contrast
// determines no gain: it stays near 1.
LightChange light_change(std::span<const float> background, std::span<const float> picture) {
  const std::size_t n = background.size();
  LightChange light;
  std::vector<double> residuals(n), sorted;
  double least = 0;
  constexpr int rounds = 12;
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < n; ++i) residuals[i] = picture[i] - light.gain * background[i] - light.offset;
    sorted = residuals;
    const double middle = median(std::span(sorted));
    for (double& value : sorted) value = std::abs(value - middle);
    light.sigma = std::max(0.3, sigma_of_mad * median(std::span(sorted)));
    constexpr double inlying = 2.5;
    least = inlying * light.sigma;
    // A prior: the gain is 1 within 0.2.
    constexpr double gain_sigma = 0.2;
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < n; ++i) {
      if (std::abs(residuals[i] - middle) > least) continue;
      const Eigen::Vector2d row(background[i], 1);
      normal += row * row.transpose(), right += picture[i] * row;
    }
    const double prior = light.sigma * light.sigma / (gain_sigma * gain_sigma);
    normal(0, 0) += prior, right[0] += prior;
    normal(1, 1) += 1e-9;
    const Eigen::Vector2d solution = normal.inverse() * right;
    // Of the brightest pixels, which change the most.
    constexpr double brightest = 255, settled = 1e-3;
    const double change =
        std::abs(solution[0] - light.gain) * brightest + std::abs(solution[1] - light.offset);
    light.gain = solution[0], light.offset = solution[1];
    if (change < settled) break;
  }
  return light;
}

// The surroundings in the light of the picture, and the picture's noise relative to them.
struct Surroundings {
  cv::Mat ground;
  double sigma = 1;
};

Surroundings in_this_light(const cv::Mat& background, const cv::Mat& picture, const cv::Mat& inside) {
  std::vector<cv::Mat> grounds, pictures;
  cv::split(background, grounds), cv::split(picture, pictures);
  Surroundings result;
  double variance = 0;
  constexpr int samples = 10000;
  const int step = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(picture.total()) / samples)));
  for (std::size_t c = 0; c < grounds.size(); ++c) {
    std::vector<float> from, to;
    for (int v = step / 2; v < picture.rows; v += step) {
      for (int u = step / 2; u < picture.cols; u += step) {
        const float value = pictures[c].at<float>(v, u), ground = grounds[c].at<float>(v, u);
        constexpr float darkest = 2, brightest = 253;
        const bool is_clipped =
            value < darkest || value > brightest || ground < darkest || ground > brightest;
        if (is_clipped || (!inside.empty() && inside.at<std::uint8_t>(v, u) == 0)) continue;
        from.push_back(ground), to.push_back(value);
      }
    }
    constexpr std::size_t enough = 100;
    const LightChange light =
        from.size() < enough ? LightChange{.gain = 1, .offset = 0, .sigma = 1} : light_change(from, to);
    grounds[c] = cv::min(cv::max(light.gain * grounds[c] + light.offset, 0), 255);
    variance += light.sigma * light.sigma / static_cast<double>(grounds.size());
  }
  cv::merge(grounds, result.ground);
  result.sigma = std::sqrt(variance);
  return result;
}

// Returns the root mean square over the channels.
cv::Mat size_of(const cv::Mat& difference) {
  std::vector<cv::Mat> channels;
  cv::split(difference.mul(difference), channels);
  cv::Mat sum = channels[0].clone();
  for (std::size_t c = 1; c < channels.size(); ++c) sum += channels[c];
  sum /= static_cast<double>(channels.size());
  cv::sqrt(sum, sum);
  return sum;
}

// Returns the distance of each pixel from a colour in CIELAB. Lightness counts half, because a round arm is
// shaded.
cv::Mat distance_from(const cv::Mat& picture, const Eigen::Vector3d& color) {
  cv::Mat lab, one(1, 1, CV_32FC3, cv::Scalar(color[0], color[1], color[2]));
  constexpr double full = 255, shading = 0.5;
  cv::cvtColor(picture / full, lab, cv::COLOR_RGB2Lab);
  cv::cvtColor(one / full, one, cv::COLOR_RGB2Lab);
  const auto own = one.at<cv::Vec3f>(0, 0);
  std::vector<cv::Mat> channels;
  cv::split(lab, channels);
  cv::Mat sum = cv::Mat::zeros(picture.size(), CV_32F);
  for (int c = 0; c < 3; ++c) {
    const cv::Mat off = (channels[static_cast<std::size_t>(c)] - own[c]) * (c == 0 ? shading : 1);
    sum += off.mul(off);
  }
  cv::sqrt(sum, sum);
  return sum;
}

// The colour distance that separates the arm: Otsu's, within the differences that one surface shows.
double color_bound(const cv::Mat& distance, const cv::Mat& candidates) {
  Histogram histogram{};
  for (int v = 0; v < distance.rows; ++v)
    for (int u = 0; u < distance.cols; ++u)
      if (candidates.at<std::uint8_t>(v, u) != 0)
        ++histogram[static_cast<std::size_t>(std::clamp(2 * distance.at<float>(v, u), 0.0F, 255.0F))];
  constexpr double least = 10, most = 30;
  return std::clamp(0.5 * threshold_of(histogram).level, least, most);
}

cv::Mat disc(int size) { return cv::getStructuringElement(cv::MORPH_ELLIPSE, {size, size}); }

// Mean of `values` over the pixels of `mask` in a window around each pixel; the mean of all where the window
// has none.
cv::Mat local_mean(const cv::Mat& values, const cv::Mat& mask, int window) {
  cv::Mat weight, sum, count, weighted = cv::Mat::zeros(values.size(), values.type());
  mask.convertTo(weight, CV_32F, 1.0 / 255);
  values.copyTo(weighted, mask);
  cv::boxFilter(weighted, sum, -1, {window, window}, {-1, -1}, false, cv::BORDER_CONSTANT);
  cv::boxFilter(weight, count, -1, {window, window}, {-1, -1}, false, cv::BORDER_CONSTANT);
  const cv::Scalar all = cv::mean(values, mask);
  std::vector<cv::Mat> channels;
  cv::split(sum, channels);
  constexpr double some = 0.5;
  const cv::Mat is_empty = count < some;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    channels[c] /= cv::max(count, 1);
    channels[c].setTo(all[static_cast<int>(c)], is_empty);
  }
  cv::Mat result;
  cv::merge(channels, result);
  return result;
}

cv::Mat sum_of_channels(const cv::Mat& values) {
  std::vector<cv::Mat> channels;
  cv::split(values, channels);
  cv::Mat sum = channels[0].clone();
  for (std::size_t c = 1; c < channels.size(); ++c) sum += channels[c];
  return sum;
}

// Returns the pixels at which all cues agree on the arm, and sets `ground` if the surroundings are known.
cv::Mat figures_of(const ArmScene& scene, const Image<std::uint8_t>& picture, const cv::Mat& values,
                   const cv::Mat& inside, cv::Mat& ground, ScenePart& part) {
  cv::Mat figures = inside.empty() ? cv::Mat(values.size(), CV_8U, cv::Scalar(255)) : inside.clone();
  const cv::Rect rect(part.box.left, part.box.top, part.box.width(), part.box.height());
  if (!scene.background.values().empty()) {
    const Surroundings known =
        in_this_light(floats_of(scene.background, part.box, values.channels() == 1), values, inside);
    ground = known.ground;
    constexpr double sigmas = 6, least = 12, noisiest = 20;
    if (known.sigma > noisiest) {
      part.reason = fmt::format(
          "most of the picture differs from the picture of the background, by about {:.0f} of 255 "
          "after gain and offset: has the camera moved?",
          known.sigma);
      return figures;
    }
    figures &= size_of(values - ground) > std::max(sigmas * known.sigma, least);
  }
  if (scene.color) {
    if (picture.channels() != 3) {
      part.reason = "the arm's colour is given, but the picture is gray";
      return figures;
    }
    const cv::Mat distance = distance_from(floats_of(picture, part.box, false), *scene.color);
    figures &= distance < color_bound(distance, figures);
  }
  if (!scene.mask.values().empty()) {
    constexpr int half = 127;
    figures &= view_of(scene.mask)(rect) > half;
  }
  // Fills pinholes: single pixels of the colour of the surroundings.
  cv::morphologyEx(figures, figures, cv::MORPH_CLOSE, disc(3));
  if (!inside.empty()) figures &= inside;
  return figures;
}

}  // namespace

void make_matte(const ArmScene& scene, const Image<std::uint8_t>& picture, ScenePart& part) {
  part.has_matte = true;
  const bool is_gray =
      picture.channels() == 1 || (!scene.background.values().empty() && scene.background.channels() == 1);
  const cv::Mat values = floats_of(picture, part.box, is_gray);
  const cv::Mat inside = part.inside.values().empty() ? cv::Mat() : view_of(part.inside);
  cv::Mat ground;
  const cv::Mat figures = figures_of(scene, picture, values, inside, ground, part);
  if (!part.reason.empty()) return;
  if (cv::countNonZero(figures) == 0) {
    part.reason = "no pixel belongs to the arm by all that is given: background, colour, mask and region";
    return;
  }
  // Pixels that belong to one side for sure; the rest is mixed.
  constexpr int sure = 5, window = 9, wide_window = 15;
  cv::Mat core, outside;
  cv::erode(figures, core, disc(sure), {-1, -1}, 1, cv::BORDER_REPLICATE);
  if (cv::countNonZero(core) == 0) cv::erode(figures, core, disc(3), {-1, -1}, 1, cv::BORDER_REPLICATE);
  if (cv::countNonZero(core) == 0) core = figures;
  cv::dilate(figures, outside, disc(sure));
  outside = ~outside;
  const bool is_ground_known = !ground.empty();
  const cv::Mat arm = local_mean(values, core, window);
  if (!is_ground_known) ground = local_mean(values, outside, wide_window);
  const cv::Mat contrast = arm - ground;
  cv::Mat square = sum_of_channels(contrast.mul(contrast));
  const cv::Mat along = sum_of_channels((values - ground).mul(contrast));
  constexpr double scale = 170, faintest = 12;
  const cv::Mat is_faint = square < faintest * faintest * values.channels();
  cv::Mat share = along / cv::max(square, 1.0) * scale;
  cv::Mat soft;
  cv::GaussianBlur(figures, soft, {5, 5}, 1);
  cv::Mat soft_share;
  soft.convertTo(soft_share, CV_32F, scale / 255);
  soft_share.copyTo(share, is_faint);
  if (!is_ground_known) share.setTo(0, outside);
  part.figures = image_of(figures), part.soft = image_of(soft);
  part.matte = image_of(share), part.matte_scale = scale / 255;
  cv::Mat border;
  cv::subtract(figures, core, border);
  const double mean_square = cv::mean(square, border)[0] / values.channels();
  part.contrast = std::max(1.0, std::sqrt(mean_square));
}

}  // namespace flexura
