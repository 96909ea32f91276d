#include "flexura/servo/length_features.h"

#include <algorithm>
#include <utility>

namespace flexura {
namespace {

class WithLengths : public ServoFeatures {
 public:
  WithLengths(std::unique_ptr<ServoFeatures> inner, Eigen::Index sections, double weight)
      : inner_(std::move(inner)), sections_(sections), weight_(weight) {}

  void look(const ServoObservation& observed) override { inner_->look(observed); }
  [[nodiscard]] bool measured(const ArmState& estimate, const std::array<Observation, 2>& seen,
                              Eigen::VectorXd& values) override {
    return inner_->measured(estimate, seen, part_) && append(estimate, values);
  }
  [[nodiscard]] bool predict(const ArmState& state, const std::array<View, 2>& views,
                             Eigen::VectorXd& values) override {
    return inner_->predict(state, views, part_) && append(state, values);
  }
  [[nodiscard]] bool error(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                           const ArmState& estimate, const std::array<View, 2>& views,
                           FeatureError& result) override {
    split(seen, desired);
    return inner_->error(seen_, desired_, estimate, views, error_) && append(seen, desired, result);
  }
  [[nodiscard]] bool secant(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired,
                            const ShapeError& way, const std::array<View, 2>& views,
                            FeatureError& result) override {
    split(seen, desired);
    return inner_->secant(seen_, desired_, way, views, error_) && append(seen, desired, result);
  }

 private:
  bool append(const ArmState& state, Eigen::VectorXd& values) const {
    values.resize(part_.size() + sections_);
    values.head(part_.size()) = part_;
    for (Eigen::Index i = 0; i < sections_; ++i)
      values[part_.size() + i] = weight_ * state.stretches[static_cast<std::size_t>(i)];
    return true;
  }
  void split(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired) {
    seen_ = seen.head(seen.size() - sections_), desired_ = desired.head(desired.size() - sections_);
  }
  bool append(const Eigen::VectorXd& seen, const Eigen::VectorXd& desired, FeatureError& result) const {
    const Eigen::Index rows = error_.error.size();
    result.error.resize(rows + sections_), result.by_state.resize(rows + sections_, error_.by_state.cols());
    result.error.head(rows) = error_.error, result.by_state.topRows(rows) = error_.by_state;
    result.error.tail(sections_) = seen.tail(sections_) - desired.tail(sections_);
    result.by_state.bottomRows(sections_).setZero();
    for (Eigen::Index i = 0; i < sections_; ++i) result.by_state(rows + i, 3 * i + 2) = weight_;
    return true;
  }

  std::unique_ptr<ServoFeatures> inner_;
  Eigen::Index sections_;
  double weight_;
  Eigen::VectorXd part_, seen_, desired_;
  FeatureError error_;
};

}  // namespace

std::unique_ptr<ServoFeatures> with_lengths(std::unique_ptr<ServoFeatures> features, const Arm& arm,
                                            double weight) {
  if (std::ranges::none_of(arm.sections, &Section::can_stretch)) return features;
  return std::make_unique<WithLengths>(std::move(features), static_cast<Eigen::Index>(arm.sections.size()),
                                       weight);
}

}  // namespace flexura
