#include "python/bindings/reach_batch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>

#include "python/bindings/locked.h"

namespace flexura::python {
namespace {

// Points of the backbone that are compared for a shape, and observed.
constexpr int shape_points = 5;
// Tolerance of the steps, rad/s. It moves the tip of tendon_arm() by less than 0.1 mm (docs/performance.md).
constexpr double step_tolerance = 1e-4;
// Attempts to find a random equilibrium.
constexpr int most_attempts = 50;

std::uint64_t mixed(std::uint64_t value) {
  value = (value ^ (value >> 30U)) * 0xbf58476d1ce4e5b9U;
  value = (value ^ (value >> 27U)) * 0x94d049bb133111ebU;
  return value ^ (value >> 31U);
}

void require(bool is_valid, const char* what) {
  if (!is_valid) throw std::invalid_argument(what);
}

}  // namespace

struct ReachBatch::Worker {
  std::optional<RodDynamics> dynamics;
  std::optional<RodStatics> statics;
  std::optional<RodTube> tube;  // One for each thread, because a RodTube has a lock.
  std::optional<Photographer> photographer;
  TendonInput input;
};

double ReachBatch::Random::uniform(double low, double high) {
  state += 0x9e3779b97f4a7c15U;
  return low + (high - low) * static_cast<double>(mixed(state) >> 11U) * 0x1p-53;
}

template <class Work>
void ReachBatch::for_arms(const Work& work) {
  const std::size_t parts = pool_.threads();
  pool_.run(parts, [&](std::size_t part) {
    for (std::size_t i = count() * part / parts; i < count() * (part + 1) / parts; ++i)
      work(*workers_[part], i);
  });
}

ReachBatch::~ReachBatch() = default;

ReachBatch::ReachBatch(std::shared_ptr<const DescribedArm> arm, const Experiment* experiment,
                       const ReachConfig& config, std::size_t count, std::size_t threads)
    : arm_(std::move(arm)), config_(config), arms_(count), pool_(std::max<std::size_t>(threads, 1)) {
  require_some(count, threads);
  require(config.time_step > 0 && config.substeps > 0 && config.max_steps > 0,
          "time_step, substeps and max_steps: expected numbers above 0");
  require(config.tolerance >= 0 && config.max_tension > 0 && config.max_rate > 0,
          "max_tension and max_rate: expected numbers above 0, and a tolerance of at least 0");
  require(std::isfinite(config.time_step + config.max_tension + config.max_rate),
          "time_step, max_tension and max_rate: expected finite numbers");
  if (config.is_elastic) {
    rod_.emplace(*arm_);
    require(rod_->tendons() > 0, "the arm has no tendons");
  }
  for (std::size_t i = 0; i < threads; ++i) {
    auto& worker = *workers_.emplace_back(std::make_unique<Worker>());
    if (rod_) {
      worker.dynamics.emplace(rod_->rod, RodDynamicsConfig{.tolerance = step_tolerance});
      worker.statics.emplace(rod_->rod);
      worker.tube.emplace(arm_->model.driven(), rod_->rod);
    }
    if (config.has_pictures) worker.photographer.emplace(*experiment);
  }
  if (rod_) {
    TendonInput slack{.tensions = std::vector<double>(rod_->tendons(), 0.0)};
    const Equilibrium found = workers_.front()->statics->settle(slack, rod_->loads);
    require(found.converged(), "the arm has no equilibrium without tensions");
    rest_ = workers_.front()->dynamics->rest(found);
    Random random{};
    require(random_tensions(*workers_.front(), random).has_value(),
            "no target can be reached: random tensions up to max_tension lead to no stable equilibrium");
  }
  if (config.has_pictures) {
    const std::vector<CameraConfig> cameras = experiment->true_rig().cameras;
    require(cameras.size() >= 2, "expected an experiment with two cameras");
    for (std::size_t i = 0; i < 2; ++i) {
      const Camera camera(cameras[i]);
      views_.push_back(camera.view(camera.initial_stance()));
      sensors_.push_back(cameras[i].sensor);
      require(cameras[i].sensor.pixels == PixelKind::gray && cameras[i].sensor.bits == 8,
              "expected gray cameras of 8 bits");
    }
    require(views_[0].width == views_[1].width && views_[0].height == views_[1].height,
            "expected cameras of equal size");
  }
  seed(0);
  for_arms([&](Worker& worker, std::size_t i) { begin(worker, arms_[i]); });
}

std::size_t ReachBatch::actions() const { return rod_ ? rod_->tendons() : 2 * arm_->sections(); }

std::size_t ReachBatch::observations() const {
  const std::size_t coordinates = rod_ ? static_cast<std::size_t>(2 * rest_.q.size()) : 2 * arm_->sections();
  return coordinates + 2 * 3 * static_cast<std::size_t>(config_.is_shape ? shape_points : 1);
}

std::array<int, 2> ReachBatch::picture_size() const {
  return views_.empty() ? std::array{0, 0} : std::array{views_[0].width, views_[0].height};
}

void ReachBatch::seed(std::uint64_t seed) {
  seed_ = seed;
  for (std::size_t i = 0; i < count(); ++i) {
    arms_[i].random.state = mixed(seed + mixed(i + 1));
    arms_[i].frames = 0;
  }
}

void ReachBatch::reset(std::span<const bool> chosen) {
  for_arms([&](Worker& worker, std::size_t i) {
    if (chosen[i]) begin(worker, arms_[i]);
  });
}

void ReachBatch::begin(Worker& worker, ReachArm& arm) const {
  if (rod_) {
    arm.rod = rest_;
  } else {
    arm.bends = ArmState::straight(arm_->sections());
  }
  arm.steps = 0;
  arm.has_ended = false;
  arm.target = random_target(worker, arm.random);
  arm.target_points = points_of(*arm.target);
}

// Returns the modes of a stable equilibrium under random tensions; empty if none is found.
std::optional<Eigen::VectorXd> ReachBatch::random_tensions(Worker& worker, Random& random) const {
  TendonInput input;
  input.tensions.resize(rod_->tendons());
  for (int attempt = 0; attempt < most_attempts; ++attempt) {
    for (double& tension : input.tensions) tension = random.uniform(0, config_.max_tension);
    Equilibrium found = worker.statics->settle(input, rod_->loads);
    if (found.converged() && found.stable) return std::move(found.q);
  }
  return std::nullopt;
}

Backbone ReachBatch::random_target(Worker& worker, Random& random) const {
  if (rod_) return backbone_of_modes(worker, random_tensions(worker, random).value_or(rest_.q));
  ArmState state = ArmState::straight(arm_->sections());
  for (std::size_t i = 0; i < arm_->sections(); ++i) {
    const double most = std::min(arm_->config.section[i].max_bend, std::numbers::pi / 2);
    // Uniform over the disk of the bends.
    const double bend = most * std::sqrt(random.uniform(0, 1));
    const double towards = random.uniform(-std::numbers::pi, std::numbers::pi);
    state.bends[i] = bend * Eigen::Vector2d(std::cos(towards), std::sin(towards));
    if (arm_->config.kind == ArmKind::planar) state.bends[i].y() = 0;
  }
  return arm_->model.backbone(state);
}

bool ReachBatch::apply(Worker& worker, ReachArm& arm, const double* actions) const {
  if (!rod_) {
    for (std::size_t i = 0; i < arm_->sections(); ++i) {
      const Eigen::Vector2d action(actions[2 * i],
                                   arm_->config.kind == ArmKind::planar ? 0.0 : actions[2 * i + 1]);
      arm.bends.bends[i] += config_.time_step * config_.max_rate * action.cwiseMin(1.0).cwiseMax(-1.0);
      const double most = arm_->config.section[i].max_bend, bend = arm.bends.bends[i].norm();
      if (bend > most) arm.bends.bends[i] *= most / bend;
    }
    return true;
  }
  worker.input.tensions.resize(rod_->tendons());
  for (std::size_t i = 0; i < rod_->tendons(); ++i)
    worker.input.tensions[i] = config_.max_tension * (std::clamp(actions[i], -1.0, 1.0) + 1) / 2;
  const double h = config_.time_step / config_.substeps;
  for (int i = 0; i < config_.substeps; ++i)
    if (!worker.dynamics->step(arm.rod, worker.input, rod_->loads, h).converged()) return false;
  return true;
}

void ReachBatch::step(const double* actions, const Results& results) {
  for_arms([&](Worker& worker, std::size_t i) {
    ReachArm& arm = arms_[i];
    results.rewards[i] = 0;
    results.terminated[i] = results.truncated[i] = false;
    if (arm.has_ended) {
      begin(worker, arm);
      results.errors[i] = error_of(worker, arm);
      return;
    }
    const bool is_sound = apply(worker, arm, actions + i * this->actions());
    ++arm.steps;
    const double error = error_of(worker, arm);
    results.errors[i] = error;
    results.terminated[i] = is_sound && error <= config_.tolerance;
    results.truncated[i] = !results.terminated[i] && (!is_sound || arm.steps >= config_.max_steps);
    results.rewards[i] = (results.terminated[i] ? 1 : 0) - error;
    arm.has_ended = results.terminated[i] || results.truncated[i];
  });
}

Eigen::Matrix3Xd ReachBatch::points_of(const Backbone& backbone) const {
  const int count = config_.is_shape ? shape_points : 1;
  Eigen::Matrix3Xd points(3, count);
  for (int i = 0; i < count; ++i) points.col(i) = backbone.pose(backbone.length() * (i + 1) / count).position;
  return points;
}

Backbone ReachBatch::backbone_of_modes(const Worker& worker, const Eigen::VectorXd& q) {
  return worker.tube->backbone(q, std::vector<double>(worker.statics->chain().rod().sections.size(), 1.0));
}

Backbone ReachBatch::backbone_of(const Worker& worker, const ReachArm& arm) const {
  return rod_ ? backbone_of_modes(worker, arm.rod.q) : arm_->model.backbone(arm.bends);
}

Backbone ReachBatch::backbone(std::size_t i) const { return backbone_of(*workers_.front(), arms_[i]); }

// A tip needs no backbone.
Eigen::Matrix3Xd ReachBatch::points_of(Worker& worker, const ReachArm& arm) const {
  if (rod_ && !config_.is_shape) return (rod_->X_WB * worker.dynamics->tip(arm.rod)).position;
  return points_of(backbone_of(worker, arm));
}

// Root mean square distance of the points from those of the target, as part of the arm's length.
double ReachBatch::error_of(Worker& worker, const ReachArm& arm) const {
  const Eigen::Matrix3Xd apart = points_of(worker, arm) - arm.target_points;
  return std::sqrt(apart.squaredNorm() / static_cast<double>(apart.cols())) / arm_->model.driven().length();
}

void ReachBatch::observe(float* to) {
  for_arms([&](Worker& worker, std::size_t i) {
    const ReachArm& arm = arms_[i];
    Eigen::VectorXd values(static_cast<Eigen::Index>(observations()));
    Eigen::Index at = 0;
    if (rod_) {
      const Eigen::VectorXd& scales = worker.dynamics->chain().scales();
      values.segment(0, scales.size()) = arm.rod.q.cwiseProduct(scales);
      values.segment(scales.size(), scales.size()) = worker.dynamics->velocity(arm.rod).cwiseProduct(scales);
      at = 2 * scales.size();
    } else {
      for (const Eigen::Vector2d& bend : arm.bends.bends) {
        values.segment<2>(at) = bend;
        at += 2;
      }
    }
    const Eigen::Vector3d base = arm_->model.driven().X_WB.position;
    for (const Eigen::Matrix3Xd& points : {points_of(worker, arm), arm.target_points}) {
      for (const auto& point : points.colwise()) {
        values.segment<3>(at) = point - base;
        at += 3;
      }
    }
    Eigen::Map<Eigen::VectorXf>(to + i * observations(), values.size()) = values.cast<float>();
  });
}

void ReachBatch::photograph(std::uint8_t* to) {
  const auto [width, height] = picture_size();
  const std::size_t size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  for_arms([&](Worker& worker, std::size_t i) {
    ReachArm& arm = arms_[i];
    const Backbone now = backbone_of(worker, arm);
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t camera = k % 2;
      const Backbone& shown = k < 2 ? now : *arm.target;
      const Shot shot{.camera = camera,
                      .frame = arm.frames * 2 + (k < 2 ? 0 : 1),
                      .seed = mixed(seed_ + i),
                      .sensor = &sensors_[camera],
                      .view = [&](double) { return views_[camera]; },
                      .backbone = [&](double) { return shown; }};
      const Picture picture = worker.photographer->take(shot);
      const auto values = std::get<Image<std::uint8_t>>(picture).values();
      std::ranges::copy(values, to + (4 * i + k) * size);
    }
    ++arm.frames;
  });
}

}  // namespace flexura::python
