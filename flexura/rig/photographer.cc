#include "flexura/rig/photographer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <variant>

#include "flexura/camera/sensor.h"
#include "flexura/rig/image_motion.h"

namespace flexura {
namespace {

// Returns the number of instants in an exposure: enough that nothing moves by more than half a pixel between
// two, up to `most`.
int instants_of(double pixels) {
  constexpr double largest_step = 0.5;  // In px.
  constexpr int most = 64;
  constexpr double rounding = 1e-9;
  return static_cast<int>(
      std::clamp(std::ceil(pixels / largest_step - rounding), 1.0, static_cast<double>(most)));
}

// Returns the view of row v alone.
View row_view(const View& view, int v) {
  Intrinsics lens = view.lens.intrinsics();
  lens.cy -= v;
  return {Lens(lens), view.X_WC, view.width, 1};
}

}  // namespace

Photographer::Photographer(const Setup& setup)
    : setup_(setup),
      maker_(setup.true_rig().arm.arm(), setup.true_rig().arm.look, setup.true_stand(), setup.obstacle) {}

const Sensor& Photographer::sensor(const Shot& shot) {
  const auto found = sensors_.find(shot.camera);
  return found != sensors_.end() ? found->second : sensors_.emplace(shot.camera, *shot.sensor).first->second;
}

const Image<float>& Photographer::backdrop(std::size_t camera) {
  const auto found = backdrops_.find(camera);
  if (found != backdrops_.end()) return found->second;
  return backdrops_.emplace(camera, backdrop_light(setup_, camera)).first->second;
}

// Before a white ground, a pixel has the light of the things plus the share of the ground that they leave
// visible. `first_row`: row of the backdrop that is the picture's first.
void Photographer::draw_backdrop(const Image<float>& behind, const View& view, PixelKind pixels,
                                 int first_row) {
  scene_.background = Color::Zero();
  renderer_.render(scene_, view, pixels, instant_);
  scene_.background = Color::Ones();
  renderer_.render(scene_, view, pixels, on_white_);
  for (int v = 0; v < view.height; ++v) {
    const auto things = instant_.light.row(v), white = on_white_.light.row(v);
    const auto ground = behind.row(first_row + v);
    for (std::size_t i = 0; i < things.size(); ++i) things[i] += (white[i] - things[i]) * ground[i];
  }
}

void Photographer::draw(const Shot& shot, double time, const Rows& rows, Image<float>& light) {
  const View view = shot.view(time);
  const bool is_one_row = rows.last == rows.first + 1;
  const View drawn = is_one_row ? row_view(view, rows.first) : view;
  scene_ = maker_.scene(shot.backbone(time));
  const Image<float>& behind = backdrop(shot.camera);
  if (behind.values().empty())
    renderer_.render(scene_, drawn, shot.sensor->pixels, instant_);
  else
    draw_backdrop(behind, drawn, shot.sensor->pixels, is_one_row ? rows.first : 0);
  for (int v = rows.first; v < rows.last; v += rows.step)
    std::ranges::copy(instant_.light.row(is_one_row ? 0 : v), light.row(v).begin());
}

// Collects the light of a shot in light_.
void Photographer::gather(const Shot& shot) {
  // Smaller motions are invisible, and all rows and instants have one picture.
  constexpr double is_still = 1e-3;  // In px.
  SensorConfig sensor = *shot.sensor;
  if (shot.is_covered) {
    light_ = Image<float>(static_cast<int>(sensor.width), static_cast<int>(sensor.height), sensor.channels());
    return;
  }
  double start = shot.start;
  const double speed = fastest_image_motion(shot, maker_.stand());
  if (speed * (sensor.exposure + last_row_delay(sensor)) <= is_still) {
    start = times_of_frame_at(sensor, start).middle;
    sensor.readout = Readout::global;
    sensor.exposure = 0;
  }
  const DrawLight draw_rows = [&](double time, const Rows& rows, Image<float>& light) {
    draw(shot, time, rows, light);
  };
  gather_light(sensor, start, instants_of(speed * sensor.exposure), draw_rows, light_, scratch_);
}

Picture Photographer::take(const Shot& shot) {
  gather(shot);
  const SensorConfig& config = *shot.sensor;
  const NoiseStream stream{shot.seed, shot.camera, static_cast<std::uint64_t>(shot.frame)};
  const auto read = [&]<typename Value>(Image<Value> image) -> Picture {
    sensor(shot).read(light_, stream, rows_, image);
    return image;
  };
  const auto width = static_cast<int>(config.width), height = static_cast<int>(config.height);
  if (config.bits <= 8) return read(Image<std::uint8_t>(width, height, light_.channels()));
  return read(Image<std::uint16_t>(width, height, light_.channels()));
}

}  // namespace flexura
