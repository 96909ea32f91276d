#include "flexura/calibrate/etalon_observer.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "flexura/base/degree.h"
#include "flexura/vision/eight_bits.h"

namespace flexura {
namespace {

// Smallest standard deviations, px: of a border; of the middle of a wide red line, or of a rim.
constexpr double least_sigma = 0.02, least_red_sigma = 0.05;
// Rows where lines are measured, as shares of the silhouette's height from its middle row.
constexpr std::array<double, 2> places = {-0.25, 0.25};

Eigen::Vector2d at(const UprightLine& line, const EtalonObservation& seen, double share) {
  const double v = share * (seen.bottom - seen.top);
  return {line.at + line.slope * v, seen.middle_row + v};
}

void add(EtalonPart part, std::size_t number, const UprightLine& line, const EtalonObservation& seen,
         std::vector<EtalonPoint>& points) {
  // Standard deviation at either place of a line fitted through n points.
  const double of_fit = 1.4 * line.rms / std::sqrt(std::max(1, line.count));
  const double least = part == EtalonPart::red_line ? least_red_sigma : least_sigma;
  for (const double share : places)
    points.push_back({part, number, at(line, seen, share), std::max(least, of_fit)});
}

// Returns the angle of a line around the cylinder's axis, from the direction to the camera, positive to the
// right. Computed from the line's distance to the silhouette's middle. Needs no view.
double bearing_of(const UprightLine& line, const EtalonObservation& seen) {
  const double half = 0.5 * (seen.right.at - seen.left.at);
  return std::asin(std::clamp((line.at - seen.middle(seen.middle_row)) / half, -1.0, 1.0));
}

}  // namespace

std::vector<EtalonPoint> etalon_points(const EtalonObservation& seen, const EtalonFigure& etalon,
                                       const View& view) {
  std::vector<EtalonPoint> points;
  // For a camera upside down, left and right are exchanged, and up and down.
  const bool hangs = view.X_WC.rotation.col(1).dot(etalon.up()) > 0;
  add(EtalonPart::left_side, 0, hangs ? seen.right : seen.left, seen, points);
  add(EtalonPart::right_side, 0, hangs ? seen.left : seen.right, seen, points);
  const auto add_rim = [&](EtalonPart part, const std::optional<double>& v) {
    if (v) points.push_back({part, 0, {seen.middle(*v), *v}, least_red_sigma});
  };
  add_rim(EtalonPart::upper_rim, hangs ? seen.lower_edge : seen.upper_edge);
  add_rim(EtalonPart::lower_rim, hangs ? seen.upper_edge : seen.lower_edge);
  // Beyond `facing`, the middle of the visible part of a line is not its true middle. Lines are 90 degrees
  // apart.
  constexpr double facing = std::numbers::pi / 3, known = 40 * degree;
  constexpr std::size_t lines = 4;
  for (const UprightLine& line : seen.lines) {
    const double bearing = (hangs ? -1 : 1) * bearing_of(line, seen);
    if (std::abs(bearing) > facing) continue;
    for (std::size_t i = 0; i < lines; ++i)
      if (std::abs(etalon.bearing(i, view.X_WC.position) - bearing) < known)
        add(EtalonPart::red_line, i, line, seen, points);
  }
  return points;
}

SeenArm drawn_etalon(const EtalonObservation& seen, const EtalonConfig& etalon, const View& view) {
  const EtalonFigure figure(etalon);
  SeenArm drawn;
  for (const EtalonPoint& point : etalon_points(seen, figure, view)) {
    if (point.part != EtalonPart::red_line) continue;
    const auto place = figure.nearest(point, view);
    const double up = place ? (*place - figure.middle()).y() + 0.5 * etalon.height : 0;
    drawn.markers.push_back({point.pixel, up, point.sigma});
  }
  if (drawn.markers.empty()) drawn.reason = "no red line can be identified";
  for (const auto& [line, share] :
       {std::pair{&seen.left, -0.5}, {&seen.left, 0.5}, {&seen.right, 0.5}, {&seen.right, -0.5}})
    drawn.points.push_back({at(*line, seen, share), least_sigma});
  return drawn;
}

namespace {

class EtalonObserver : public RigObserver {
 public:
  EtalonObserver(const RigModel& nominal, const RigPrior& prior, const RigSessionConfig& config)
      : RigObserver(nominal), prior_(prior), config_(config), etalon_(config.etalon.value()) {}

  std::optional<Eigen::Vector2d> seen_at() const override { return last_.centroid; }
  // Identifies the red lines by the rig found before or, if that fails, by the initial guess; then by the rig
  // just found.
  RigReading read(const RigModel* found) const override {
    std::vector<RigReading> readings;
    readings.push_back(read_by(model(found)));
    if (found != nullptr && !readings.back().is_whole()) readings.push_back(read_by(nominal_));
    return best_of(readings);
  }
  RigImage image_of_observed(const RigModel& model, const CameraObservation& observed) const override {
    RigImage image;
    const auto last = std::ranges::find_if(looks_.rbegin(), looks_.rend(), [&](const Look& look) {
      return stances_[look.stance].camera == observed.stance.camera;
    });
    if (last != looks_.rend())
      image.etalon = etalon_points(last->seen, etalon_, view_of(model, observed.stance));
    return image;
  }

 private:
  std::vector<ArmState>& poses() override { return poses_; }
  std::vector<RigStance>& stances() override { return stances_; }
  bool look(std::size_t i, const Picture& picture) override {
    const CameraConfig& camera = nominal_.cameras.at(config_.cameras.at(i));
    last_ = view_etalon(eight_bits(picture, camera.sensor.white()),
                        Camera(camera).lens().at(Camera(camera).initial_head().zoom), config_.etalon->radius);
    return last_.reason.empty();
  }
  SeenArm unkept(const View& /*view*/) const override {
    SeenArm nothing;
    nothing.reason = last_.reason;
    return nothing;
  }
  SeenArm keep(std::size_t stance, std::size_t pose, const RigModel* found) override {
    looks_.push_back({stance, pose, last_.observation});
    return drawn_etalon(last_.observation, *config_.etalon, view_of(model(found), stances_.at(stance)));
  }

  [[nodiscard]] RigObservations observations(const RigModel& model) const {
    RigObservations result{.poses = poses_, .stances = stances_, .images = {}, .etalon = config_.etalon};
    for (const Look& look : looks_)
      result.images.push_back(
          {.stance = look.stance,
           .pose = look.pose,
           .etalon = etalon_points(look.seen, etalon_, view_of(model, stances_[look.stance]))});
    return result;
  }

  [[nodiscard]] RigReading read_by(const RigModel& first) const {
    RigReading reading;
    RigModel model = first;
    constexpr int rounds = 2;
    for (int round = 0; round < rounds; ++round) {
      reading.problem.emplace(nominal_, prior_, observations(model));
      reading.found = calibrate_rig(*reading.problem);
      if (!reading.found.is_found) break;
      model = reading.found.model;
    }
    for (const RigImage& image : reading.problem->observations().images)
      reading.things += static_cast<double>(image.things());
    reading.unexplained = static_cast<double>(reading.found.outliers.size());
    reading.explained = reading.things - 2 * reading.unexplained;
    return reading;
  }

  struct Look {
    std::size_t stance = 0, pose = 0;
    EtalonObservation seen;
  };
  const RigPrior& prior_;
  const RigSessionConfig& config_;
  EtalonFigure etalon_;
  std::vector<ArmState> poses_;
  std::vector<RigStance> stances_;
  std::vector<Look> looks_;
  EtalonView last_;
};

}  // namespace

std::unique_ptr<RigObserver> etalon_observer(const RigModel& nominal, const RigPrior& prior,
                                             const RigSessionConfig& config) {
  return std::make_unique<EtalonObserver>(nominal, prior, config);
}

}  // namespace flexura
