#include "flexura/vision/edge_finder.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace flexura {

template <typename Value>
EdgeFinder<Value>::EdgeFinder(const Image<Value>& picture, int sign, BlurredSteps& steps, double widest_blur)
    : values_(picture.values().data()),
      width_(picture.width()),
      height_(picture.height()),
      sign_(sign),
      steps_(steps),
      widest_blur_(widest_blur) {}

template <typename Value>
double EdgeFinder<Value>::at(const Eigen::Vector2d& pixel) const {
  const int u = static_cast<int>(pixel.x()), v = static_cast<int>(pixel.y());
  const double right = pixel.x() - u, down = pixel.y() - v;
  const Value* top = values_ + static_cast<std::ptrdiff_t>(v) * width_ + u;
  const Value* bottom = top + width_;
  const double above = top[0] + right * (static_cast<double>(top[1]) - top[0]);
  const double below = bottom[0] + right * (static_cast<double>(bottom[1]) - bottom[0]);
  return above + down * (below - above);
}

template <typename Value>
std::optional<EdgeFit> EdgeFinder<Value>::look(const Eigen::Vector2d& from, const Eigen::Vector2d& normal,
                                               double blur, double room) const {
  // x: along the row or column; y: across. The border is assumed to be straight between `from` and the row.
  const bool by_row = std::abs(normal.x()) >= std::abs(normal.y());
  const double nx = by_row ? normal.x() : normal.y(), ny = by_row ? normal.y() : normal.x();
  const double x = by_row ? from.x() : from.y(), y = by_row ? from.y() : from.x();
  const bool is_near = std::abs(x) < 1e6 && std::abs(y) < 1e6;
  if (!is_near) return std::nullopt;
  const int line = static_cast<int>(std::floor(y + 0.5));
  const double crossing = x - (line - y) * ny / nx;
  const double share = std::abs(nx), spread = blur / share;
  const int stride = std::max(1, static_cast<int>(spread / widest_blur_)), way = nx > 0 ? stride : -stride;
  const int pixel = static_cast<int>(std::floor(crossing + 0.5));
  const int length = by_row ? width_ : height_, lines = by_row ? height_ : width_;
  const int first = std::clamp(static_cast<int>((room / share - spread) / stride), 1, BlurredStep::before);
  const int begin = pixel - BlurredStep::before * way, used = pixel - first * way,
            end = pixel + BlurredStep::after * way;
  if (line < 0 || line >= lines || std::min(used, end) < 0 || std::max(used, end) >= length)
    return std::nullopt;
  std::array<float, BlurredStep::taps> values{};
  const std::ptrdiff_t step = by_row ? 1 : width_;
  const Value* base = values_ + static_cast<std::ptrdiff_t>(line) * (by_row ? width_ : 1);
  if (begin >= 0 && begin < length) {
    for (int i = 0; i < BlurredStep::taps; ++i)
      values[static_cast<std::size_t>(i)] = base[(begin + i * way) * step];
  } else {
    for (int i = BlurredStep::before - first; i < BlurredStep::taps; ++i)
      values[static_cast<std::size_t>(i)] = base[(begin + i * way) * step];
  }
  const double phase = (crossing - pixel) / way;
  double at = 0;
  const BlurredStep& model = steps_.of(spread / stride, phase, first, at);
  const StepFit fit = model.fit(values);
  const double scale = stride * share;
  return EdgeFit{(fit.offset + at - phase) * scale, sign_ * fit.contrast, fit.residual,
                 model.sigma() * scale};
}

template class EdgeFinder<std::uint8_t>;
template class EdgeFinder<std::uint16_t>;

}  // namespace flexura
