#include "flexura/calibrate/arcs_loop.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>

#include "flexura/calibrate/zoom_correlation.h"
#include "flexura/vision/eight_bits.h"
#include "flexura/vision/picture_file.h"

namespace flexura {

LookLoop::Error ArcsLoop::run(bool aims_at_centers) {
  if (auto error = loop_.begin()) return error;
  if (auto why = plan_arcs(loop_, aims_at_centers, plan_)) return why;
  loop_.result().target = plan_.target;
  for (std::size_t i = 0; i < 2; ++i)
    if (auto error = loop_.begin_zoomed(i, plan_.zoom[i], "zoom as planned",
                                        "zoom to {:.5g}, the zoom in the simulator"))
      return error;
  if (auto error = align()) return error;
  return equalize_zooms();
}

LookLoop::Error ArcsLoop::look_at(const std::vector<std::size_t>& arcs,
                                  const std::vector<std::size_t>& cameras) {
  for (const std::size_t arc : arcs) {
    if (auto error = loop_.show(plan_.arcs[arc])) return error;
    for (const std::size_t i : cameras)
      if (auto error = look(i)) return error;
  }
  return std::nullopt;
}

LookLoop::Error ArcsLoop::settle(const std::vector<std::size_t>& numbers) {
  for (;;) {
    if (auto error = look_at(numbers, numbers)) return error;
    if (auto error = learn()) return error;
    bool is_moved = false;
    for (const std::size_t i : numbers) {
      std::optional<RigStance> next;
      if (auto error = decide(i, next)) return error;
      if (!next) continue;
      if (auto error = loop_.go(i, *next)) return error;
      is_moved = true;
    }
    if (!is_moved) return std::nullopt;
  }
}

// Step 13: sets the zooms for which each camera shows its arc as large as the simulator's picture, by
// normalised cross-correlation.
LookLoop::Error ArcsLoop::equalize_zooms() {
  std::array<double, 2> last = {1, 1};
  for (std::size_t i = 0; i < 2; ++i) {
    if (auto error = loop_.show(plan_.arcs[i])) return error;
    constexpr int rounds = 3;
    std::string end;
    for (int round = 1; end.empty(); ++round) {
      ZoomCorrelation seen;
      auto error = loop_.look(i, [&](CameraObservation& observed) {
        const Image<std::uint8_t> bytes = eight_bits(*observed.frame.picture, loop_.model(i).sensor.white());
        seen = correlate_zoom(bytes.channels() == 1 ? bytes : gray_picture(bytes), plan_.pictures[i]);
        observed.seen.reason = seen.reason;
        observed.values = {{"zoom relative to the ideal picture", seen.ratio}, {"correlation", seen.peak}};
      });
      if (error) return error;
      if (!seen.reason.empty()) return fmt::format("zoom of camera {}: {}", loop_.name(i), seen.reason);
      last[i] = seen.ratio;
      const RigStance next = loop_.zoomed(i, 1 / seen.ratio);
      const double off = std::abs(std::log(seen.ratio)), accepted = loop_.config().zoom_accepted;
      if (off <= accepted)
        end = "within the tolerance";
      else if (loop_.stands_there(i, next))
        end = "at the resolution of the commands";
      else if (round == rounds)
        end = fmt::format(
            "stopped after {} observations: the correlation cannot resolve smaller changes of the zoom",
            rounds);
      loop_.decide(i, "zoom", seen.ratio - 1, accepted, "share",
                   end.empty()
                       ? fmt::format("zoom to {:.5g}, for a correlation of {:.3f}", next.head.zoom, seen.peak)
                       : fmt::format("the correlation is {:.3f}: {}", seen.peak, end));
      if (!end.empty() && off > accepted)
        loop_.result().notes.push_back(
            fmt::format("zoom of camera {}: the last correlation gives a size error of {:.2g} % relative "
                        "to the ideal picture (tolerance {:.2g} %): {}",
                        loop_.name(i), 100 * off, 100 * accepted, end));
      if (!end.empty()) break;
      if (auto moved = loop_.go(i, next)) return moved;
    }
  }
  loop_.result().zoom_ratio = last[0] / last[1];
  return std::nullopt;
}

}  // namespace flexura
