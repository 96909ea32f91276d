#include "flexura/mechanics/surroundings.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace flexura {
namespace {

// Displacement at which any tendon is slack, m.
constexpr double let_out = -1e6;

}  // namespace

Surroundings::Surroundings(std::vector<const RodSurroundings*> parts) : parts_(std::move(parts)) {
  if (std::ranges::any_of(parts_, [](const RodSurroundings* part) { return part == nullptr; }))
    throw std::invalid_argument("surroundings: a pointer is null");
  for (const RodSurroundings* part : parts_) {
    if (part->points().empty()) continue;
    if (with_points_ != nullptr)
      throw std::invalid_argument("surroundings: only one part may act at points between nodes");
    with_points_ = part;
  }
}

void Surroundings::pull(std::span<const NodeMotion> nodes, std::span<const double> run,
                        std::span<NodePull> pulls) const {
  if (parts_.empty()) {
    for (NodePull& pull : pulls) pull.clear();
    return;
  }
  parts_.front()->pull(nodes, run, pulls);
  if (parts_.size() > 1) one_.resize(pulls.size());
  for (std::size_t i = 1; i < parts_.size(); ++i) {
    parts_[i]->pull(nodes, run, one_);
    for (std::size_t k = 0; k < pulls.size(); ++k) pulls[k] += one_[k];
  }
}

std::span<const RodPlace> Surroundings::points() const {
  return with_points_ != nullptr ? with_points_->points() : std::span<const RodPlace>{};
}

void Surroundings::choose(std::span<const NodeMotion> nodes, std::span<const double> lengths,
                          std::vector<std::size_t>& chosen) const {
  if (with_points_ != nullptr) with_points_->choose(nodes, lengths, chosen);
}

void Surroundings::pull_points(std::span<const std::size_t> chosen, std::span<const NodeMotion> points,
                               std::span<NodePull> pulls) const {
  if (with_points_ != nullptr) with_points_->pull_points(chosen, points, pulls);
}

void Surroundings::couple(std::span<const std::size_t> chosen, std::span<const NodeMotion> points,
                          std::vector<PointCoupling>& couplings) const {
  if (with_points_ != nullptr) with_points_->couple(chosen, points, couplings);
}

void Surroundings::tie(std::span<const std::size_t> chosen, std::span<const NodeMotion> points,
                       std::vector<PointTie>& ties) const {
  if (with_points_ != nullptr) with_points_->tie(chosen, points, ties);
}

TendonInput after_breaks(TendonInput input, std::span<const TendonBreak> breaks, double time) {
  for (const TendonBreak& each : breaks) {
    if (!(time >= each.time)) continue;
    for (std::vector<double>* list : {&input.tensions, &input.displacements}) {
      if (list->empty()) continue;
      if (each.tendon >= list->size())
        throw std::invalid_argument(
            fmt::format("tendon {} breaks, but there are only {} tendons", each.tendon + 1, list->size()));
      (*list)[each.tendon] = list == &input.tensions ? 0.0 : let_out;
    }
  }
  return input;
}

}  // namespace flexura
