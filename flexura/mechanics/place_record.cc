#include "flexura/mechanics/place_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "flexura/base/progress.h"
#include "flexura/base/work_progress.h"
#include "flexura/math/dense.h"
#include "flexura/math/levenberg_marquardt.h"
#include "flexura/mechanics/dynamics.h"

namespace flexura {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Prior energy of a mode of another strain, relative to the bends' greatest energy.
constexpr double other_energy = 0.01;
// Noise relative to the rod's length: initial value while unknown, and lower bound.
constexpr double first_noise = 1e-3, least_noise = 1e-5;
// Largest root mean square residual of a fit by bends alone, relative to the length. Above it the places do
// not belong to this rod.
constexpr double most_left = 0.02;
constexpr int most_fits = 60;
// Longest step of a simulated motion, s, and the part of a step at which its input is taken
// (RodDynamics::step).
constexpr double longest_step = 5e-3, step_share = 1 / 1.1;

class PlaceFit {
 public:
  PlaceFit(const Rod& rod, std::span<const RodPlace> places)
      : chain_(rod, places), rows_(3 * static_cast<Index>(places.size())) {
    for (const RodPlace& place : places) nodes_.push_back(chain_.node_of(place));
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      for (std::size_t k = 0; k < i; ++k)
        if (nodes_[i] == nodes_[k])
          throw std::invalid_argument(fmt::format("places {} and {} are the same", k + 1, i + 1));
    if (rows_ <= chain_.size())
      throw std::invalid_argument(fmt::format(
          "{} places do not determine {} strain modes: expected at least {}, or a rod of fewer modes",
          places.size(), chain_.size(), chain_.size() / 3 + 1));
  }

  [[nodiscard]] const RodChain& chain() const { return chain_; }

  // Minimises |p(q) - positions|^2 / noise^2 + |q / spread|^2 from `q` on. Returns the residual of the
  // positions.
  VectorXd fit(std::span<const Eigen::Vector3d> positions, double noise, const VectorXd& spread,
               VectorXd& q) {
    desired_ = positions, noise_ = noise;
    const VectorXd prior = spread.cwiseAbs2().cwiseInverse();
    VectorXd left = left_at(q), at = q, next = q, then = left;
    MatrixXd information;
    VectorXd slope;
    double cost = 0;
    const auto linearise = [&] {
      const MatrixXd J = slopes_at(at) / noise_;
      information = J.transpose() * J;
      information.diagonal() += prior;
      slope = J.transpose() * left / noise_ + prior.cwiseProduct(at);
      cost = cost_of(left, prior, at);
    };
    linearise();
    (void)levenberg_marquardt(
        cost, {.start = 1e-6, .rise = 10, .eased = [](double value, double) { return value / 10; }},
        most_fits,
        [&](double damping) {
          MatrixXd damped = information;
          damped.diagonal() += damping * information.diagonal();
          next = at - Cholesky(damped).solve(slope);
          if (!next.allFinite()) return TriedStep{};
          then = left_at(next);
          return TriedStep{.cost = then.allFinite() ? cost_of(then, prior, next) : TriedStep{}.cost};
        },
        [&](const TriedStep& step, double& to_lower) {
          const double gained = to_lower - step.cost;
          at = next, left = then;
          linearise();
          to_lower = cost;
          return gained < 1e-9 * (1 + cost);
        },
        [&](const TriedStep& step, double of) { return step.cost - of < 1e-9 * (1 + of); });
    q = at;
    covariance_ = Cholesky(information).inverse();
    return left;
  }
  // Returns the covariance of the last fit.
  [[nodiscard]] const MatrixXd& covariance() const { return covariance_; }

 private:
  [[nodiscard]] double cost_of(const VectorXd& left, const VectorXd& prior, const VectorXd& q) const {
    return left.squaredNorm() / (noise_ * noise_) + prior.dot(q.cwiseAbs2());
  }
  VectorXd left_at(const VectorXd& q) {
    chain_.place(q);
    VectorXd left(rows_);
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      left.segment<3>(3 * static_cast<Index>(i)) = position(nodes_[i]) - desired_[i];
    return left;
  }
  MatrixXd slopes_at(const VectorXd& q) {
    chain_.place_with_columns(q);
    MatrixXd J(rows_, chain_.size());
    RodElement::Columns twist(6, chain_.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      chain_.columns_at(nodes_[i].element, nodes_[i].node, twist);
      const Eigen::Vector3d p = position(nodes_[i]);
      for (Index j = 0; j < chain_.size(); ++j)
        J.block<3, 1>(3 * static_cast<Index>(i), j) =
            twist.col(j).head<3>() + Eigen::Vector3d(twist.col(j).tail<3>()).cross(p);
    }
    return J;
  }
  [[nodiscard]] Eigen::Vector3d position(const RodNode& at) const { return chain_.pose(at).position; }

  RodChain chain_;
  Index rows_;
  std::vector<RodNode> nodes_;
  std::span<const Eigen::Vector3d> desired_;
  double noise_ = 1;
  MatrixXd covariance_;
};

void require_places(const Rod& rod, std::span<const RodPlace> places) {
  for (std::size_t i = 0; i < places.size(); ++i)
    if (places[i].section >= rod.sections.size() || !(places[i].at >= 0) || !(places[i].at <= 1))
      throw std::invalid_argument(fmt::format("place {} is not on the rod", i + 1));
}

void require_samples(std::span<const RodPlaceSample> samples, std::size_t places) {
  if (samples.size() < 2)
    throw std::invalid_argument(fmt::format("{} samples of places: expected at least 2", samples.size()));
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const std::vector<Eigen::Vector3d>& positions = samples[k].positions;
    if (positions.size() != places)
      throw std::invalid_argument(
          fmt::format("sample {}: {} positions given: expected {}", k, positions.size(), places));
    if (!std::ranges::all_of(positions, [](const Eigen::Vector3d& p) { return p.allFinite(); }))
      throw std::invalid_argument(fmt::format("sample {}: positions must be finite", k));
  }
}

// Fits all samples' modes, each fit starting at the result of the one before.
constexpr std::string_view fitting = "fitting the arm's shapes";

struct Fits {
  std::vector<VectorXd> modes;
  std::vector<MatrixXd> covariances;
  double square = 0;  // Sum of squared residuals.
};
Fits fit_all(PlaceFit& places, std::span<const RodPlaceSample> samples, double noise, const VectorXd& spread,
             Progress& progress) {
  const Index n = places.chain().size();
  Fits fits;
  VectorXd q = VectorXd::Zero(n);
  for (const RodPlaceSample& sample : samples) {
    fits.square += places.fit(sample.positions, noise, spread, q).squaredNorm();
    fits.covariances.push_back(places.covariance());
    fits.modes.push_back(q);
    progress.update(static_cast<double>(fits.modes.size()) / static_cast<double>(samples.size()), fitting);
  }
  return fits;
}

// Returns which modes are bends.
std::vector<Index> bend_modes(const RodChain& chain) {
  std::vector<Index> modes;
  for (std::size_t i = 0; i < chain.elements().size(); ++i)
    chain.elements()[i].grid().for_modes([&](int strain, int mode) {
      if (strain == 3 || strain == 4) modes.push_back(chain.first(i) + mode);
    });
  return modes;
}

// Returns dq/dt at the start by a parabola through the first samples.
VectorXd first_rates(const RodMotionRecord& record) {
  const auto count = static_cast<Index>(std::min<std::size_t>(record.samples.size(), 9));
  const RodMotionRecordSample& first = record.samples[0];
  if (count < 3) return (record.samples[1].q - first.q) / (record.samples[1].time - first.time);
  MatrixXd powers(count, 3), q(count, first.q.size());
  for (Index k = 0; k < count; ++k) {
    const RodMotionRecordSample& sample = record.samples[static_cast<std::size_t>(k)];
    const double since = sample.time - first.time;
    powers.row(k) << 1, since, since * since;
    q.row(k) = sample.q.transpose();
  }
  return (pseudo_inverse(powers) * q).row(1).transpose();
}

}  // namespace

RodPlaceRecord record_of_places(const Rod& rod, std::span<const RodPlace> places,
                                std::span<const RodPlaceSample> samples, const RodLoads& loads, double noise,
                                Progress* progress) {
  require_places(rod, places);
  require_samples(samples, places.size());
  if (!(noise >= 0) || !std::isfinite(noise))
    throw std::invalid_argument("the noise of places must be at least 0");
  PlaceFit fit(rod, places);
  const Index n = fit.chain().size();
  const double length = rod.length();
  const double coordinates = 3.0 * static_cast<double>(places.size() * samples.size());
  const VectorXd stiffness = RodDynamics(rod).stiffness_matrix().diagonal();
  const std::vector<Index> bends = bend_modes(fit.chain());

  // First fits bends alone to find their energy. A prior of 10 rad in a section allows any bend.
  VectorXd spread = VectorXd::Constant(n, 1e-4).cwiseQuotient(fit.chain().scales());
  for (const Index mode : bends) spread[mode] = 10 / fit.chain().scales()[mode];
  const std::size_t passes = noise > 0 ? 1 : 3;
  NoProgress nobody;
  WorkProgress work(progress != nullptr ? *progress : nobody, std::vector<double>(1 + passes, 1));
  Fits fits = fit_all(fit, samples, first_noise * length, spread, work.piece(0));
  double energy = 0;
  for (const VectorXd& q : fits.modes) {
    double there = 0;
    for (const Index mode : bends) there += 0.5 * stiffness[mode] * q[mode] * q[mode];
    energy = std::max(energy, there);
  }
  if (const double left = std::sqrt(fits.square / coordinates); !(left < most_left * length))
    throw std::invalid_argument(fmt::format(
        "no shape of the rod is near the measured places: the remaining distance is {:.3g} m", left));
  // Lower bound for a rod that does not bend.
  energy = std::max(energy, 1e-9 * stiffness.maxCoeff());
  spread = (2 * other_energy * energy * stiffness.cwiseInverse()).cwiseSqrt();
  for (const Index mode : bends) spread[mode] = std::sqrt(2e4 * energy / stiffness[mode]);

  const double freedom =
      coordinates * (1 - static_cast<double>(n) / (3.0 * static_cast<double>(places.size())));
  double counted = noise > 0 ? noise : first_noise * length;
  for (std::size_t pass = 0; pass < passes; ++pass) {
    fits = fit_all(fit, samples, counted, spread, work.piece(1 + pass));
    if (noise == 0) counted = std::max(std::sqrt(fits.square / freedom), least_noise * length);
  }
  RodPlaceRecord result{.record = {.samples = {}, .loads = loads},
                        .noise = counted,
                        .rms = std::sqrt(fits.square / coordinates)};
  for (std::size_t k = 0; k < samples.size(); ++k)
    result.record.samples.push_back({.time = samples[k].time,
                                     .q = fits.modes[k],
                                     .tensions = samples[k].tensions,
                                     .q_covariance = fits.covariances[k]});
  return result;
}

double places_missed(const Rod& rod, std::span<const RodPlace> places,
                     std::span<const RodPlaceSample> samples, const RodPlaceRecord& record,
                     Progress* progress) {
  require_places(rod, places);
  require_samples(samples, places.size());
  const std::vector<RodMotionRecordSample>& motion = record.record.samples;
  RodDynamics dynamics(rod, {}, places);
  if (motion.size() != samples.size() || motion[0].q.size() != dynamics.chain().size())
    throw std::invalid_argument("the record does not belong to these samples of this rod");
  const RodLoads& loads = record.record.loads;
  RodState state =
      dynamics.start(motion[0].q, first_rates(record.record), {.tensions = motion[0].tensions}, loads);
  double square = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (k > 0) {
      const double run = samples[k].time - samples[k - 1].time;
      const int steps = static_cast<int>(std::ceil(run / longest_step));
      for (int i = 0; i < steps; ++i) {
        // Tensions are linear between two samples; a step takes those near its end.
        const double share = (i + step_share) / steps;
        TendonInput input{.tensions = motion[k].tensions};
        for (std::size_t t = 0; t < input.tensions.size(); ++t)
          input.tensions[t] += (1 - share) * (motion[k - 1].tensions[t] - motion[k].tensions[t]);
        if (!dynamics.step(state, input, loads, run / steps).converged())
          return std::numeric_limits<double>::infinity();
      }
    }
    if (progress != nullptr)
      progress->update(static_cast<double>(k + 1) / static_cast<double>(samples.size()),
                       "simulating the motion");
    for (std::size_t i = 0; i < places.size(); ++i)
      square += (dynamics.motion(state, places[i]).pose.position - samples[k].positions[i]).squaredNorm();
  }
  const double rms = std::sqrt(square / static_cast<double>(samples.size() * places.size()));
  return std::isfinite(rms) ? rms : std::numeric_limits<double>::infinity();
}

}  // namespace flexura
