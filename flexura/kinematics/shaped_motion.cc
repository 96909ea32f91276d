#include "flexura/kinematics/shaped_motion.h"

#include <utility>

namespace flexura {
namespace {

class ShapedMotion : public Motion {
 public:
  ShapedMotion(const Actuation& actuation, MotionPtr command)
      : actuation_(actuation), command_(std::move(command)) {}

  [[nodiscard]] double duration() const override { return command_->duration(); }
  [[nodiscard]] ArmState at(double time) const override { return actuation_.shape(command_->at(time)); }
  [[nodiscard]] std::optional<SectionRates> rates(std::size_t arc, double start, double end) const override {
    if (!actuation_.is_linear()) return std::nullopt;
    auto rates = command_->rates(actuation_.section_of()[arc], start, end);
    if (rates) rates->bend *= actuation_.share_of(arc);
    return rates;
  }

 private:
  Actuation actuation_;
  MotionPtr command_;
};

}  // namespace

MotionPtr shaped_motion(const Actuation& actuation, MotionPtr command) {
  if (actuation.is_identity()) return command;
  return std::make_shared<ShapedMotion>(actuation, std::move(command));
}

}  // namespace flexura
