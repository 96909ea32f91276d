#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "flexura/calibrate/arc_plan.h"
#include "flexura/calibrate/arm_picture.h"
#include "flexura/calibrate/look_loop.h"
#include "flexura/calibrate/rig_quantities.h"
#include "flexura/calibrate/rig_reader.h"
#include "flexura/calibrate/rig_sights.h"

namespace flexura {

/// How wrong a rig may be that is calibrated with arcs, by how wrong one may be beside: its lenses are known
/// but for 1 px of the principal point, its heads but for their steps, and a section's bends are wrong by the
/// same factor in every arc.
[[nodiscard]] RigPrior arcs_prior(RigPrior prior);

/// Calibrates with arcs of the arm (section 3.4), made well posed: both cameras see both arcs, by their
/// markers and axes; what moves a camera from where all these pictures put it to where the simulator has it
/// is commanded, until nothing finer can be, or pictures tell nothing finer. Then both look once with a
/// longer focal length, which tells principal points, and go on from what is known now. Pictures that do not
/// agree within their standard deviations are trouble, and so is what cannot be commanded. Then the zooms.
class ArcsLoop {
 public:
  explicit ArcsLoop(LookLoop& loop);
  ArcsLoop(const ArcsLoop&) = delete;  // Its reader refers to its prior.
  ArcsLoop& operator=(const ArcsLoop&) = delete;
  [[nodiscard]] LookLoop::Trouble run();

 private:
  using Trouble = LookLoop::Trouble;
  struct Angle {
    double value = 0, sigma = 0;  // Between the axes, rad.
  };
  [[nodiscard]] Trouble look(std::size_t i, std::size_t arc);
  void keep(std::size_t i, ArmFigure figure, RigSight& sight);
  [[nodiscard]] Trouble into_view(std::size_t i, std::size_t arc);
  [[nodiscard]] Trouble locate();
  [[nodiscard]] Trouble disagreement() const;
  [[nodiscard]] Trouble square();
  [[nodiscard]] Trouble center();
  [[nodiscard]] double longer(std::size_t i) const;
  struct Wanted {
    std::array<RigStance, 2> stances;
    std::array<bool, 2> is_short{};  // A head or stage does not reach where it should.
  };
  [[nodiscard]] Wanted wanted() const;
  [[nodiscard]] double offset(std::size_t i) const;
  [[nodiscard]] double allowed(std::size_t i) const;

  [[nodiscard]] const RigModel* before() const { return reading_ ? &reading_->found.model : nullptr; }
  [[nodiscard]] const RigModel& model() const { return reading_ ? *before() : loop_.believed(); }
  [[nodiscard]] Pose pose(std::size_t i) const;  // Of a camera where it stands, as it is known.
  [[nodiscard]] Angle angle(const std::array<AskedStance, 2>& stances) const;

  LookLoop& loop_;
  ArcPlan plan_;
  std::vector<ArmPicture> eyes_;
  RigPrior prior_;
  RigSights sights_;  // All pictures.
  RigReader reader_;
  std::array<std::optional<std::size_t>, 2> stance_;  // Of the last picture of each camera.
  std::optional<RigReading> reading_;                 // What the pictures tell.
  std::array<bool, 2> is_centered_ = {false, false};  // A longer focal length told the principal point.
  Angle angle_;
  std::optional<Angle> foretold_;  // Before the last pictures were taken.
};

}  // namespace flexura
