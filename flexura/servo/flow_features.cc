#include "flexura/servo/flow_features.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "flexura/servo/measured_places.h"
#include "flexura/vision/eight_bits.h"
#include "flexura/vision/picture_file.h"

namespace flexura {
namespace {

Image<std::uint8_t> gray_of(const Frame& frame, int white) {
  Image<std::uint8_t> image = eight_bits(*frame.picture, white);
  return image.channels() == 1 ? image : gray_picture(image);
}

std::vector<double> angles_of(const Eigen::Matrix2Xd& places) {
  std::vector<double> angles;
  for (Eigen::Index k = 0; k + 1 < places.cols(); ++k) {
    const Eigen::Vector2d way = places.col(k + 1) - places.col(k);
    angles.push_back(std::atan2(way.y(), way.x()));
  }
  return angles;
}

// Returns the unit tangent of the curve at one of its points, or zero if it is undefined.
Eigen::Vector2d heading_at(const Eigen::Matrix2Xd& places, Eigen::Index k) {
  const Eigen::Index last = places.cols() - 1;
  return (places.col(std::min(k + 1, last)) - places.col(std::max<Eigen::Index>(k - 1, 0))).normalized();
}

}  // namespace

FlowFeatures::FlowFeatures(Arm arm, std::unique_ptr<ChordFeatures> chords, double anchor,
                           std::array<int, 2> whites)
    : arm_(std::move(arm)), chords_(std::move(chords)), anchor_(anchor), whites_(whites) {}

void FlowFeatures::begin_anew() {
  time_.reset();
  for (Seen& seen : seen_) seen.integrator.reset();
}

// Uses only the flow across the curve. Along it, an arm without texture shows no motion; there the points
// move like the images of the estimated shapes.
std::vector<double> FlowFeatures::turns(const Seen& before, const Image<std::uint8_t>& gray,
                                        const Eigen::Matrix2Xd& places) {
  std::vector<Eigen::Vector2d> from;
  from.reserve(static_cast<std::size_t>(places.cols()));
  for (Eigen::Index k = 0; k < places.cols(); ++k) from.emplace_back(before.places.col(k));
  const auto flow = flow_at(before.gray, gray, from);
  std::vector<Eigen::Vector2d> to;
  to.reserve(from.size());
  for (Eigen::Index k = 0; k < places.cols(); ++k) {
    const Eigen::Vector2d along = heading_at(before.places, k), across(-along.y(), along.x());
    const auto& seen = flow[static_cast<std::size_t>(k)];
    const double side = seen ? across.dot(*seen) : std::numeric_limits<double>::quiet_NaN();
    to.emplace_back(from[static_cast<std::size_t>(k)] + side * across +
                    along.dot(places.col(k) - before.places.col(k)) * along);
  }
  std::vector<double> turns;
  turns.reserve(to.size());
  for (std::size_t k = 0; k + 1 < to.size(); ++k) {
    const Eigen::Vector2d was = from[k + 1] - from[k], is = to[k + 1] - to[k];
    turns.push_back(std::atan2(was.x() * is.y() - was.y() * is.x(), was.dot(is)));
  }
  return turns;
}

void FlowFeatures::look(const ServoObservation& observed) {
  std::array<Eigen::Matrix2Xd, 2> places;
  std::array<Image<std::uint8_t>, 2> grays;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto measured =
        measured_pixels(arm_, observed.estimate.shape.state, observed.seen[i], chords_->shares());
    if (!measured || !observed.frames[i].picture) {
      begin_anew();
      return;
    }
    places[i] = *measured;
    grays[i] = gray_of(observed.frames[i], whites_[i]);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    Seen& seen = seen_[i];
    Angles& angles = angles_[i];
    angles.measured = angles_of(places[i]);
    angles.turns.assign(angles.measured.size(), std::numeric_limits<double>::quiet_NaN());
    if (time_ && seen.integrator && seen.gray.width() == grays[i].width() &&
        seen.gray.height() == grays[i].height()) {
      angles.turns = turns(seen, grays[i], places[i]);
      seen.integrator->add(angles.turns);
      const double passed = std::max(0.0, observed.time - *time_);
      (void)seen.integrator->anchor(angles.measured, 1 - std::exp(-passed / anchor_));
    } else {
      seen.integrator.emplace(angles.measured);
    }
    angles.carried = seen.integrator->angles();
    pixels_[i] = places[i];
    for (Eigen::Index k = 0; k + 1 < places[i].cols(); ++k) {
      const auto at = static_cast<std::size_t>(k);
      const Eigen::Rotation2Dd turn(angles.carried[at] - angles.measured[at]);
      pixels_[i].col(k + 1) = pixels_[i].col(k) + turn * (places[i].col(k + 1) - places[i].col(k));
    }
    seen.gray = std::move(grays[i]), seen.places = places[i];
  }
  time_ = observed.time;
}

bool FlowFeatures::measured(const ArmState& estimate, const std::array<Observation, 2>& seen,
                            Eigen::VectorXd& values) {
  if (!time_) return chords_->measured(estimate, seen, values);
  return chords_->of_pixels(pixels_, estimate, {seen[0].view, seen[1].view}, values);
}

}  // namespace flexura
