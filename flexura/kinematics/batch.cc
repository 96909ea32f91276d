#include "flexura/kinematics/batch.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "flexura/kinematics/simd_kernels.h"

namespace flexura {
namespace {

void require_size(const char* what, std::size_t size, std::size_t expected) {
  if (size == expected) return;
  throw std::invalid_argument(std::string(what) + " of a batch: " + std::to_string(expected) +
                              " numbers expected, " + std::to_string(size) + " given");
}

std::array<double, 12> packed(const Pose& pose) {
  std::array<double, 12> numbers{};
  std::copy_n(pose.position.data(), 3, numbers.begin());
  std::copy_n(pose.rotation.data(), 9, numbers.begin() + 3);
  return numbers;
}

Pose unpacked(const std::array<double, 12>& numbers) {
  Pose pose;
  std::copy_n(numbers.begin(), 3, pose.position.data());
  std::copy_n(numbers.begin() + 3, 9, pose.rotation.data());
  return pose;
}

// One state's vectors as they lie in memory: a bend's x and y side by side.
BatchJob single_job(std::span<const double> lengths, const std::array<double, 12>& X_WB,
                    const ArmState& state, std::array<double, 12>& tip) {
  const double* bends = state.bends.empty() ? nullptr : state.bends.front().data();
  return {.sections = lengths.size(),
          .lengths = lengths.data(),
          .X_WB = X_WB.data(),
          .bend_x = bends,
          .bend_y = bends == nullptr ? nullptr : bends + 1,
          .bend_stride = 2,
          .stretch = state.stretches.data(),
          .stretch_stride = 1,
          .frames = tip.data(),
          .stride = 1};
}

// An empty vector's data need not be null.
const double* data_or_none(std::span<const double> numbers) {
  return numbers.empty() ? nullptr : numbers.data();
}

BatchJob batch_job(std::span<const double> lengths, const std::array<double, 12>& X_WB,
                   const BatchStates& states, std::span<double> frames) {
  return {.sections = lengths.size(),
          .lengths = lengths.data(),
          .X_WB = X_WB.data(),
          .bend_x = states.bend_x.data(),
          .bend_y = data_or_none(states.bend_y),
          .bend_stride = states.count,
          .stretch = data_or_none(states.stretch),
          .stretch_stride = states.count,
          .frames = frames.data(),
          .stride = states.count};
}

// The arms that do not fill a vector go one by one: a lane does not see its neighbours, so it is all the
// same.
void run(const SimdKernels& kernels,
         void (*LaneFunctions::*function)(const BatchJob&, std::size_t, std::size_t), const BatchJob& job,
         std::size_t count) {
  const std::size_t whole = count - count % kernels.many.lanes;
  (kernels.many.*function)(job, 0, whole);
  (kernels.one.*function)(job, whole, count);
}

}  // namespace

BatchKinematics::BatchKinematics(const Arm& arm, SimdPath path)
    : is_planar_(arm.kind == ArmKind::planar), X_WB_(packed(arm.X_WB)), kernels_(&kernels_of(path)) {
  for (const Section& section : arm.sections) lengths_.push_back(section.length);
}

void BatchKinematics::require_states(const BatchStates& states) const {
  const std::size_t size = lengths_.size() * states.count;
  require_size("bend_x", states.bend_x.size(), size);
  require_size("bend_y", states.bend_y.size(), is_planar_ ? 0 : size);
  if (!states.stretch.empty()) require_size("stretch", states.stretch.size(), size);
}

void BatchKinematics::fill_frames(const BatchStates& states, std::span<double> frames, std::size_t rows,
                                  bool every) const {
  require_states(states);
  require_size("frames", frames.size(), rows * states.count * (every ? lengths_.size() + 1 : 1));
  BatchJob job = batch_job(lengths_, X_WB_, states, frames);
  job.frame_rows = rows;
  job.is_every_frame = every;
  run(*kernels_, &LaneFunctions::frames, job, states.count);
}

void BatchKinematics::tips(const BatchStates& states, std::span<double> frames) const {
  fill_frames(states, frames, 12, false);
}

void BatchKinematics::section_frames(const BatchStates& states, std::span<double> frames) const {
  fill_frames(states, frames, 12, true);
}

void BatchKinematics::base_points(const BatchStates& states, std::span<double> points) const {
  fill_frames(states, points, 3, true);
}

std::size_t BatchKinematics::jacobian_columns(const BatchStates& states) const {
  return lengths_.size() * ((is_planar_ ? 1 : 2) + (states.stretch.empty() ? 0 : 1));
}

void BatchKinematics::tip_jacobians(const BatchStates& states, std::span<double> frames,
                                    std::span<double> jacobians) const {
  require_states(states);
  require_size("frames", frames.size(), 12 * states.count);
  require_size("jacobians", jacobians.size(), 6 * jacobian_columns(states) * states.count);
  std::vector<double> scratch(scratch_rows * lengths_.size() * kernels_->many.lanes);
  BatchJob job = batch_job(lengths_, X_WB_, states, frames);
  job.jacobian = jacobians.data();
  job.scratch = scratch.data();
  run(*kernels_, &LaneFunctions::jacobians, job, states.count);
}

void BatchKinematics::require_state(const ArmState& state) const {
  require_size("bends", state.bends.size(), lengths_.size());
  require_size("stretches", state.stretches.size(), lengths_.size());
}

// The kernels write all of these arrays before anyone reads them.
// NOLINTBEGIN(cppcoreguidelines-pro-type-member-init)
Pose BatchKinematics::tip(const ArmState& state) const {
  require_state(state);
  std::array<double, 12> tip;
  kernels_->one.frames(single_job(lengths_, X_WB_, state, tip), 0, 1);
  return unpacked(tip);
}

Pose BatchKinematics::tip_jacobian(const ArmState& state, Eigen::Ref<Jacobian> J) const {
  require_state(state);
  require_size("jacobian", static_cast<std::size_t>(J.size()), 18 * lengths_.size());
  if (J.outerStride() != 6) {  // Part of a taller matrix; the kernels write one column right after another.
    Jacobian own(6, J.cols());
    const Pose X_WT = tip_jacobian(state, own);
    J = own;
    return X_WT;
  }
  constexpr std::size_t usual_sections = 16;
  std::array<double, scratch_rows * usual_sections> on_stack;
  std::vector<double> on_heap;
  if (lengths_.size() > usual_sections) on_heap.resize(scratch_rows * lengths_.size());
  std::array<double, 12> tip;
  BatchJob job = single_job(lengths_, X_WB_, state, tip);
  job.jacobian = J.data();
  job.scratch = on_heap.empty() ? on_stack.data() : on_heap.data();
  kernels_->one.jacobians(job, 0, 1);
  return unpacked(tip);
}
// NOLINTEND(cppcoreguidelines-pro-type-member-init)

}  // namespace flexura
