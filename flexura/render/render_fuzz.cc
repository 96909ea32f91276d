// Interprets any bytes as a scene and a view. The result must be an std::invalid_argument, or a picture and
// its true values. All pixels must be finite, no brighter than anything in the scene, and equal for both
// paths. The counts of these outcomes are printed at the end. The slow queries of true values run on the
// first hundred scenes and on every fourth.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "flexura/math/so3.h"
#include "flexura/model/backbone.h"
#include "flexura/render/silhouette.h"
#include "flexura/render/truth.h"

namespace {

using namespace flexura;

// Counts of the outcomes.
struct Tally {
  std::uint64_t drawn = 0, with_arm = 0, with_stand = 0, refused = 0;
  ~Tally() {
    std::printf("%llu scenes drawn, in %llu the arm is seen and in %llu something else; %llu refused\n",
                big(drawn), big(with_arm), big(with_stand), big(refused));
  }
  static unsigned long long big(std::uint64_t number) { return number; }
};
Tally tally;

// Reads numbers from the input; zeros after its end.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  int choice(int count) { return next() % count; }
  // Mostly ordinary numbers; sometimes special ones, or 8 raw bytes.
  double number(double low, double high) {
    const int kind = next();
    if (kind == 255) return raw();
    if (kind == 254) return 0;
    if (kind == 253) return low * 1e6;
    if (kind == 252) return 1e-9 * high;
    return low + (high - low) * (256 * next() + next()) / 65536.0;
  }
  Eigen::Vector3d vector(double low, double high) {
    const double x = number(low, high), y = number(low, high);
    return {x, y, number(low, high)};
  }

 private:
  int next() { return at_ < size_ ? data_[at_++] : 0; }
  double raw() {
    double value = 0;
    if (size_ - at_ >= sizeof value) {
      std::memcpy(&value, data_ + at_, sizeof value);
      at_ += sizeof value;
    }
    return value;
  }

  const std::uint8_t* data_;
  std::size_t size_, at_ = 0;
};

std::array<double, 3> listed(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

void add_arm(Bytes& bytes, Scene& scene) {
  Arm arm;
  arm.kind = ArmKind::spatial;
  const int count = bytes.choice(4);
  if (count == 0) return;
  ArmState state = ArmState::straight(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const double radius = bytes.number(0.005, 0.1);
    arm.sections.push_back({.length = bytes.number(0.05, 1),
                            .radius = {radius, bytes.choice(2) == 0 ? radius : bytes.number(0.005, 0.1)}});
    state.bends[static_cast<std::size_t>(i)] = {bytes.number(-4, 4), bytes.number(-4, 4)};
  }
  const Backbone backbone(arm, state);
  scene.arm.tube = tube_of(backbone);
  if (bytes.choice(4) == 0) {
    const double from = bytes.number(0, 1);
    scene.arm.markers.push_back({from, from + bytes.number(0.01, 0.3), {1, 0, 0}});
  }
  if (bytes.choice(4) == 0)
    scene.arm.disks.push_back({bytes.number(0, 1), bytes.number(0.01, 0.2), bytes.number(0.001, 0.1)});
  if (bytes.choice(3) == 0) scene.arm.tip = TipKind::round;
}

void add_screen(Bytes& bytes, Scene& scene) {
  Screen& screen = scene.screens.emplace_back();
  screen.X_WS = {so3_exp(bytes.vector(-2, 2)), bytes.vector(-2, 2)};
  screen.size = {bytes.number(0.1, 3), bytes.number(0.1, 3)};
}

// In front of or behind others, across them, in their plane.
void add_more_screens(Bytes& bytes, Scene& scene) {
  for (int count = bytes.choice(8) - 4; count > 0; --count) {
    add_screen(bytes, scene);
    Screen& screen = scene.screens.back();
    screen.brightness = Color::Constant(bytes.choice(256) / 255.0);
    for (double& gradient : screen.gradient) gradient = bytes.choice(201) / 100.0 - 1;
    if (bytes.choice(4) == 0) screen.X_WS.rotation = scene.screens.front().X_WS.rotation;
    if (bytes.choice(4) == 0) screen.X_WS.position = scene.screens.front().X_WS.position;
  }
}

void add_stand(Bytes& bytes, Scene& scene) {
  if (bytes.choice(2) == 0) add_screen(bytes, scene);
  if (bytes.choice(3) == 0) {
    Etalon etalon;
    etalon.X_WE = {so3_exp(bytes.vector(-2, 2)), bytes.vector(-1, 1)};
    etalon.radius = bytes.number(0.02, 0.3);
    etalon.height = bytes.number(0.05, 1);
    scene.etalon = etalon;
  }
  for (int count = bytes.choice(3); count > 0; --count) {
    VisibleObstacle& obstacle = scene.obstacles.emplace_back();
    const auto place = listed(bytes.vector(-1, 1));
    switch (bytes.choice(4)) {
      case 0:
        obstacle.shape = SphereConfig{.center = place, .radius = bytes.number(0.02, 0.5)};
        break;
      case 1:
        obstacle.shape = CapsuleConfig{
            .from = place, .to = listed(bytes.vector(-1, 1)), .radius = bytes.number(0.02, 0.3)};
        break;
      case 2:
        obstacle.shape = BoxConfig{.center = place, .half_sizes = listed(bytes.vector(0.02, 0.5))};
        break;
      default:
        obstacle.shape = PlaneConfig{.point = place, .normal = listed(bytes.vector(-1, 1))};
    }
  }
  scene.light.shadow = bytes.choice(4) == 0 ? 0.5 : 0;
  add_more_screens(bytes, scene);
}

// A point on the arm, or in the middle of another body.
Eigen::Vector3d place_in(Bytes& bytes, const Scene& scene) {
  if (!scene.arm.tube.empty()) {
    const Arc& arc =
        scene.arm.tube[static_cast<std::size_t>(bytes.choice(static_cast<int>(scene.arm.tube.size())))];
    return arc.pose(bytes.number(0, 1) * arc.length).position;
  }
  if (scene.etalon) return scene.etalon->X_WE.position;
  return scene.screens.empty() ? bytes.vector(-1, 1) : scene.screens.front().X_WS.position;
}

View view_from(Bytes& bytes, const Scene& scene) {
  View view;
  Intrinsics intrinsics;
  intrinsics.fx = bytes.number(5, 60);
  intrinsics.fy = bytes.number(5, 60);
  intrinsics.cx = bytes.number(0, 30);
  intrinsics.cy = bytes.number(0, 10);
  if (bytes.choice(3) == 0)
    intrinsics.distortion = {bytes.number(-0.4, 0.4), bytes.number(-0.2, 0.2), 0.001, 0, 0};
  view.lens = Lens(intrinsics);
  view.X_WC = {so3_exp(bytes.vector(-3, 3)), bytes.vector(-1.5, 1.5)};
  // Cameras with random directions rarely see anything.
  if (bytes.choice(8) != 0) {
    const Eigen::Vector3d ahead = place_in(bytes, scene) - view.X_WC.position;
    if (ahead.allFinite() && ahead.norm() > 0)
      view.X_WC.rotation = rotation_from_z(ahead) * so3_exp({0, 0, bytes.number(-3, 3)});
  }
  // Few pixels, as a million scenes under AddressSanitizer already take hours; mostly as many in a row as the
  // fast path needs.
  view.width = bytes.choice(4) == 0 ? bytes.choice(24) : 32 + bytes.choice(4);
  view.height = bytes.choice(16) == 0 ? bytes.choice(10) : 1 + bytes.choice(8) / 7;
  return view;
}

// Returns a bound on the brightness of all surfaces.
double brightest(const Scene& scene) {
  double result = scene.background.maxCoeff();
  for (const Screen& screen : scene.screens) {
    const double rise = std::abs(screen.gradient[0]) + std::abs(screen.gradient[1]);
    result = std::max(result, (1 + rise) * screen.brightness.maxCoeff());
  }
  double albedo = std::max(scene.arm.albedo.maxCoeff(), scene.arm.disk_albedo.maxCoeff());
  for (const MarkerRing& ring : scene.arm.markers) albedo = std::max(albedo, ring.albedo.maxCoeff());
  if (scene.etalon)
    albedo = std::max({albedo, scene.etalon->albedo.maxCoeff(), scene.etalon->line_albedo.maxCoeff()});
  for (const VisibleObstacle& obstacle : scene.obstacles)
    albedo = std::max(albedo, obstacle.albedo.maxCoeff());
  return std::max(result, albedo * (scene.light.ambient + scene.light.directional));
}

// Where three borders meet in a pixel, even the reference path samples.
bool is_close(const LightImage& quick, const LightImage& exact) {
  for (std::size_t i = 0; i < exact.light.values().size(); ++i)
    if (std::abs(quick.light.values()[i] - exact.light.values()[i]) > 0.1F) return false;
  for (std::size_t i = 0; i < exact.depth.values().size(); ++i) {
    const float a = quick.depth.values()[i], b = exact.depth.values()[i];
    if (a != b && !(std::abs(a - b) <= 1e-5F * b)) return false;
  }
  return true;
}

void count(const TruthMaps& maps) {
  bool sees_arm = false, sees_more = false;
  for (const std::uint16_t value : maps.label.values()) {
    const SurfaceKind kind = label_from_value(value).kind;
    const bool is_arm = kind >= SurfaceKind::section && kind <= SurfaceKind::disk;
    sees_arm = sees_arm || is_arm;
    sees_more = sees_more || (!is_arm && kind != SurfaceKind::background);
  }
  ++tally.drawn;
  if (sees_arm) ++tally.with_arm;
  if (sees_more) ++tally.with_stand;
}

// Returns whether both paths can represent the scene: sections of nonzero length, and a lens that is almost
// linear within a pixel.
bool is_comparable(const Scene& scene, const View& view) {
  constexpr double shortest = 1e-6, widest = 1.0 / 16;  // m; of a pixel, rad
  const Intrinsics& lens = view.lens.intrinsics();
  const bool is_linear = !lens.is_distorted() || std::min(lens.fx, lens.fy) * widest > 1;
  return is_linear &&
         std::ranges::all_of(scene.arm.tube, [](const Arc& arc) { return arc.length > shortest; });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  try {
    Scene scene;
    add_arm(bytes, scene);
    add_stand(bytes, scene);
    const View view = view_from(bytes, scene);
    Renderer renderer;
    LightImage quick, picture;
    const PixelKind pixels = bytes.choice(2) == 0 ? PixelKind::gray : PixelKind::color;
    renderer.render(scene, view, pixels, quick);
    renderer.render(scene, view, pixels, picture, true);
    const auto limit = static_cast<float>(1.001 * brightest(scene) + 1e-3);
    if (is_comparable(scene, view) && !is_close(quick, picture)) std::abort();
    for (const LightImage* one : {&quick, &picture}) {
      for (const float value : one->light.values())
        if (!std::isfinite(value) || value < -1e-4F || value > limit) std::abort();
      for (const float value : one->depth.values())
        if (!(value >= 0)) std::abort();  // With a focal length of 1e-115 px, depths round to 0.
    }
    TruthMaps maps;
    truth_maps(renderer, maps);
    for (std::size_t i = 0; i < maps.depth.values().size(); ++i)
      if (maps.depth.values()[i] != picture.depth.values()[i]) std::abort();
    const bool is_asked_all = tally.drawn < 100 || tally.drawn % 4 == 0;
    count(maps);
    if (!is_asked_all) return 0;
    (void)marker_views(renderer);
    (void)optical_flow(renderer, scene, view);
    for (const Outline& outline : outlines(renderer, 5))
      if (outline.points.size() < 2) std::abort();
  } catch (const std::invalid_argument&) {
    ++tally.refused;
  }
  return 0;
}
