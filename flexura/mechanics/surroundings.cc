#include "flexura/mechanics/surroundings.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace flexura {
namespace {

// Let out so far, m, a tendon of no arm is taut.
constexpr double let_out = -1e6;

}  // namespace

Surroundings::Surroundings(std::vector<const RodSurroundings*> parts) : parts_(std::move(parts)) {
  if (std::ranges::any_of(parts_, [](const RodSurroundings* part) { return part == nullptr; }))
    throw std::invalid_argument("surroundings: a part that is not there");
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

void Surroundings::couple(std::span<const NodeMotion> nodes, std::span<const double> run,
                          std::vector<NodeCoupling>& couplings) const {
  for (const RodSurroundings* part : parts_) part->couple(nodes, run, couplings);
}

TendonInput after_breaks(TendonInput input, std::span<const TendonBreak> breaks, double time) {
  for (const TendonBreak& each : breaks) {
    if (!(time >= each.time)) continue;
    for (std::vector<double>* list : {&input.tensions, &input.displacements}) {
      if (list->empty()) continue;
      if (each.tendon >= list->size())
        throw std::invalid_argument(fmt::format("tendon {} breaks, of {}", each.tendon + 1, list->size()));
      (*list)[each.tendon] = list == &input.tensions ? 0.0 : let_out;
    }
  }
  return input;
}

}  // namespace flexura
