#include "flexura/mechanics/identification_equations.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "flexura/math/dense.h"
#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/identification_terms.h"

namespace flexura {

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr std::size_t least_samples = 20, least_in_window = 9;
constexpr double default_windows = 8, windows_overlap = 4;
constexpr Index most_equations = 480;

void require_list(const VectorXd& list, Index count, const std::string& name) {
  if (list.size() != count)
    throw std::invalid_argument(fmt::format("{}: {} given: expected {}", name, list.size(), count));
  if (!list.allFinite()) throw std::invalid_argument(fmt::format("{}: not finite", name));
}

void require_covariance(const RodMotionRecord& record, std::size_t k, Index modes) {
  const MatrixXd& covariance = record.samples[k].q_covariance;
  if ((covariance.size() > 0) != (record.samples[0].q_covariance.size() > 0))
    throw std::invalid_argument("covariances must be given for all samples or for none");
  if (covariance.size() == 0) return;
  if (covariance.rows() != modes || covariance.cols() != modes || !Cholesky(covariance).is_definite())
    throw std::invalid_argument(
        fmt::format("covariance of sample {}: expected {} x {} numbers, positive definite", k, modes, modes));
  if (record.q_noise.size() > 0)
    throw std::invalid_argument(
        "the noise of modes is given both for all samples and for single samples: expected one of them");
}

void require_record(const RodMotionRecord& record, Index modes) {
  if (record.samples.size() < least_samples)
    throw std::invalid_argument(
        fmt::format("the motion has {} samples: expected at least {}", record.samples.size(), least_samples));
  for (std::size_t k = 0; k < record.samples.size(); ++k) {
    const RodMotionRecordSample& sample = record.samples[k];
    require_list(sample.q, modes, fmt::format("modes of sample {}", k));
    if (sample.v.has_value() != record.samples[0].v.has_value())
      throw std::invalid_argument("rates must be given for all samples or for none");
    if (sample.v) require_list(*sample.v, modes, fmt::format("rates of sample {}", k));
    require_covariance(record, k, modes);
    if (!std::isfinite(sample.time) || (k > 0 && !(sample.time > record.samples[k - 1].time)))
      throw std::invalid_argument(
          fmt::format("sample {}: expected a later time than in the previous sample", k));
  }
  for (const auto& [noise, name] :
       {std::pair{&record.q_noise, "noise of modes"}, std::pair{&record.v_noise, "noise of rates"}}) {
    if (noise->size() == 0) continue;
    require_list(*noise, modes, name);
    if (noise->minCoeff() < 0) throw std::invalid_argument(fmt::format("{}: below 0", name));
  }
  const bool has_noise = record.q_noise.size() > 0 || record.samples[0].q_covariance.size() > 0;
  if (record.v_noise.size() > 0 && (!record.samples[0].v || !has_noise))
    throw std::invalid_argument("the noise of rates is given: expected also rates, and the noise of modes");
}

// Rates by differences: derivative of the polynomial through five samples.
struct RateStencil {
  std::size_t first = 0;
  std::array<double, 5> weights{};
};

RateStencil rate_stencil(const std::vector<RodMotionRecordSample>& samples, std::size_t k) {
  RateStencil stencil{.first = std::min(k < 2 ? 0 : k - 2, samples.size() - 5)};
  const auto time = [&](std::size_t i) { return samples[stencil.first + i].time; };
  const std::size_t here = k - stencil.first;
  for (std::size_t i = 0; i < 5; ++i) {
    if (i == here) continue;
    double weight = 1 / (time(i) - time(here));
    for (std::size_t m = 0; m < 5; ++m)
      if (m != i && m != here) weight *= (time(here) - time(m)) / (time(i) - time(m));
    stencil.weights[i] = weight;
    stencil.weights[here] += 1 / (time(here) - time(i));
  }
  return stencil;
}

// A window: the bump (1 - s^2)^4 in time, times the integration weight of each sample.
struct Window {
  std::size_t first = 0;  // First of the samples whose noise contributes.
  std::size_t count = 0;
  VectorXd bump = {}, slope = {};  // Starting at `first`.
};

std::vector<Window> windows_of(const std::vector<RodMotionRecordSample>& samples, double given, Index modes) {
  const double begin = samples.front().time, length = samples.back().time - begin;
  const double wide = given == 0 ? length / default_windows : given;
  if (!(wide > 0) || !(wide <= length))
    throw std::invalid_argument("a window must be above 0 and no longer than the record");
  const auto most = std::max<Index>(4, most_equations / std::max<Index>(1, modes));
  const double desired = std::floor((length - wide) / (wide / windows_overlap)) + 1;
  const auto count = static_cast<std::size_t>(std::min(static_cast<double>(most), desired));
  std::vector<Window> windows;
  for (std::size_t w = 0; w < count; ++w) {
    const double part = count > 1 ? static_cast<double>(w) / static_cast<double>(count - 1) : 0.5;
    const double middle = begin + wide / 2 + part * (length - wide);
    std::size_t low = 0, high = samples.size();
    while (low < samples.size() && samples[low].time <= middle - wide / 2) ++low;
    while (high > low && samples[high - 1].time >= middle + wide / 2) --high;
    if (high - low < least_in_window)
      throw std::invalid_argument(
          fmt::format("a window has {} samples: expected at least {}", high - low, least_in_window));
    Window window{.first = low < 4 ? 0 : low - 4};
    window.count = std::min(samples.size(), high + 4) - window.first;
    window.bump = window.slope = VectorXd::Zero(static_cast<Index>(window.count));
    for (std::size_t k = low; k < high; ++k) {
      const double s = (samples[k].time - middle) / (wide / 2), rest = 1 - s * s;
      const double before = samples[k == 0 ? 0 : k - 1].time,
                   after = samples[std::min(k + 1, samples.size() - 1)].time;
      const double run = (after - before) / 2;
      const auto at = static_cast<Index>(k - window.first);
      window.bump[at] = run * std::pow(rest, 4);
      window.slope[at] = -run * 8 * s * std::pow(rest, 3) / (wide / 2);
    }
    windows.push_back(std::move(window));
  }
  return windows;
}

// Effect of the samples' noise on a column of a window: modes x (samples x noise directions), in standard
// deviations.
using NoiseSensitivity = MatrixXd;

MatrixXd covariance_of(const std::vector<Window>& windows, const std::vector<NoiseSensitivity>& a,
                       const std::vector<NoiseSensitivity>& b, Index modes, Index directions) {
  const auto count = static_cast<Index>(windows.size());
  MatrixXd C = MatrixXd::Zero(count * modes, count * modes);
  for (std::size_t i = 0; i < windows.size(); ++i) {
    for (std::size_t j = 0; j < windows.size(); ++j) {
      const std::size_t first = std::max(windows[i].first, windows[j].first),
                        end = std::min(windows[i].first + windows[i].count,
                                       windows[j].first + windows[j].count);
      if (end <= first) continue;
      const auto columns = [&](const NoiseSensitivity& way, const Window& window) {
        return way.middleCols(static_cast<Index>(first - window.first) * directions,
                              static_cast<Index>(end - first) * directions);
      };
      C.block(static_cast<Index>(i) * modes, static_cast<Index>(j) * modes, modes, modes) =
          columns(a[i], windows[i]) * columns(b[j], windows[j]).transpose();
    }
  }
  return C;
}

// Returns a factor; its product with its transpose is the covariance of a sample's modes.
MatrixXd noise_root(const RodMotionRecord& record, std::size_t k) {
  const MatrixXd& covariance = record.samples[k].q_covariance;
  if (covariance.size() == 0) return record.q_noise.asDiagonal();
  // L^-1 by applying L to the unit matrix, and back: L = C L^-T.
  return covariance * Cholesky(covariance)
                          .solve_lower(MatrixXd::Identity(covariance.rows(), covariance.cols()))
                          .transpose();
}

}  // namespace

IdentificationEquations::IdentificationEquations(const Rod& rod, const std::vector<RodParameter>& parameters,
                                                 const RodMotionRecord& record,
                                                 const IdentificationConfig& config) {
  if (parameters.empty()) throw std::invalid_argument("no parameters to identify");
  RodDynamics dynamics(rod);
  const Index n = dynamics.chain().size(), count = static_cast<Index>(parameters.size());
  const std::vector<RodMotionRecordSample>& samples = record.samples;
  require_record(record, n);
  IdentificationTerms all_terms(dynamics, parameters);
  nominal = all_terms.nominal();
  const std::vector<Window> windows = windows_of(samples, config.window, n);
  const Index rows = n * static_cast<Index>(windows.size());
  by_parameter.setZero(rows, count);
  fixed.setZero(rows);
  scales =
      dynamics.stiffness_matrix().diagonal().cwiseSqrt().replicate(static_cast<Index>(windows.size()), 1);
  const bool is_noisy = (record.q_noise.size() > 0 && !record.q_noise.isZero(0)) ||
                        samples[0].q_covariance.size() > 0,
             has_rates = samples[0].v.has_value();
  const bool rubs =
      std::ranges::any_of(
          parameters, [](const RodParameter& each) { return each.kind == RodParameter::Kind::friction; }) ||
      std::ranges::any_of(rod.tendons, [](const TendonRoute& each) { return each.friction > 0; });
  const Index directions = has_rates ? 2 * n : n;
  const VectorXd v_noise = record.v_noise.size() > 0 ? record.v_noise : VectorXd::Zero(n);
  std::vector<std::vector<NoiseSensitivity>> ways(is_noisy ? static_cast<std::size_t>(count) + 1 : 0);
  for (std::vector<NoiseSensitivity>& way : ways)
    for (const Window& window : windows)
      way.emplace_back(NoiseSensitivity::Zero(n, static_cast<Index>(window.count) * directions));

  std::vector<MatrixXd> roots;
  for (std::size_t k = 0; is_noisy && k < samples.size(); ++k) roots.push_back(noise_root(record, k));
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const auto has_sample = [&](const Window& window) {
      if (k < window.first || k >= window.first + window.count) return false;
      const auto at = static_cast<Index>(k - window.first);
      return window.bump[at] != 0 || window.slope[at] != 0;
    };
    const bool counts = std::ranges::any_of(windows, has_sample);
    if (!counts && !rubs) continue;
    const RateStencil stencil = rate_stencil(samples, k);
    VectorXd v = VectorXd::Zero(n);
    if (has_rates) {
      v = *samples[k].v;
    } else {
      for (std::size_t i = 0; i < 5; ++i) v += stencil.weights[i] * samples[stencil.first + i].q;
    }
    const std::vector<IdentificationTerm> terms =
        all_terms.at(samples[k], v, record.loads, is_noisy && counts);
    if (!counts) continue;
    for (std::size_t w = 0; w < windows.size(); ++w) {
      const Window& window = windows[w];
      if (!has_sample(window)) continue;
      const auto at = static_cast<Index>(k - window.first), row = static_cast<Index>(w) * n;
      const double bump = window.bump[at], slope = window.slope[at];
      for (std::size_t f = 0; f < terms.size(); ++f) {
        const IdentificationTerm& term = terms[f];
        const VectorXd value = bump * term.bump + slope * term.slope;
        if (f == 0) {
          fixed.segment(row, n) += value;
        } else {
          by_parameter.block(row, static_cast<Index>(f) - 1, n, 1) += value;
        }
        if (!is_noisy) continue;
        NoiseSensitivity& way = ways[f][w];
        const MatrixXd by_v = bump * term.bump_by_v + slope * term.slope_by_v;
        way.middleCols(at * directions, n) += (bump * term.bump_by_q + slope * term.slope_by_q) * roots[k];
        if (has_rates) {
          way.middleCols(at * directions + n, n) += by_v * v_noise.asDiagonal();
          continue;
        }
        for (std::size_t i = 0; i < 5; ++i) {
          const auto there = static_cast<Index>(stencil.first + i - window.first);
          way.middleCols(there * directions, n) += stencil.weights[i] * by_v * roots[stencil.first + i];
        }
      }
    }
  }
  for (const std::vector<NoiseSensitivity>& a : ways)
    for (const std::vector<NoiseSensitivity>& b : ways)
      covariances_.push_back(covariance_of(windows, a, b, n, directions));
}

}  // namespace flexura
