#include "flexura/render/screen_pixels.h"

#include <algorithm>
#include <utility>

namespace flexura {
namespace {

bool is_same(const View& a, const View& b) {
  const Intrinsics &one = a.lens.intrinsics(), &other = b.lens.intrinsics();
  return a.width == b.width && a.height == b.height && a.X_WC.position == b.X_WC.position &&
         a.X_WC.rotation == b.X_WC.rotation && one.fx == other.fx && one.fy == other.fy &&
         one.cx == other.cx && one.cy == other.cy && one.distortion == other.distortion;
}

bool is_same(const Screen& a, const Screen& b) {
  return a.X_WS.position == b.X_WS.position && a.X_WS.rotation == b.X_WS.rotation && a.size == b.size &&
         a.brightness == b.brightness && a.gradient == b.gradient && a.falloff == b.falloff;
}

}  // namespace

void ScreenPixels::begin(const Scene& scene, const View& view, PixelKind pixels) {
  const auto fits = [&](const Known& known) {
    return known.pixels == pixels && known.background == scene.background && is_same(known.view, view) &&
           std::ranges::equal(known.screens, scene.screens,
                              [](const Screen& a, const Screen& b) { return is_same(a, b); });
  };
  const auto found = std::ranges::find_if(known_, fits);
  now_ = static_cast<std::size_t>(found - known_.begin());
  if (found == known_.end()) {
    constexpr std::size_t most = 4;
    Known here{view, scene.screens, scene.background, pixels, {}};
    now_ = next_;
    next_ = (next_ + 1) % most;
    if (now_ == known_.size())
      known_.push_back(std::move(here));
    else
      known_[now_] = std::move(here);
  }
  at_ = 0;
  merged_.clear();
}

const ScreenPixels::Pixel* ScreenPixels::find(int u, int v) {
  const std::vector<Pixel>& list = known_[now_].list;
  while (at_ < list.size() && std::pair(list[at_].v, list[at_].u) < std::pair(v, u))
    merged_.push_back(list[at_++]);
  return at_ < list.size() && list[at_].v == v && list[at_].u == u ? &list[at_] : nullptr;
}

void ScreenPixels::end() {
  if (merged_.size() == at_) return;  // Nothing was added.
  std::vector<Pixel>& list = known_[now_].list;
  merged_.insert(merged_.end(), list.begin() + static_cast<std::ptrdiff_t>(at_), list.end());
  list.swap(merged_);
}

}  // namespace flexura
