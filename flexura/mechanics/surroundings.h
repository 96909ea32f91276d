#pragma once

#include <span>
#include <vector>

#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/rod_surroundings.h"

namespace flexura {

/// Combines several surroundings of one rod: adds their wrenches.
class Surroundings final : public RodSurroundings {
 public:
  /// Stores the pointers; the surroundings must outlive this object. Throws std::invalid_argument for a null
  /// pointer, or if two of the surroundings act at points between nodes.
  explicit Surroundings(std::vector<const RodSurroundings*> parts);
  /// Not thread-safe.
  void pull(std::span<const NodeMotion> nodes, std::span<const double> run,
            std::span<NodePull> pulls) const override;
  /// Returns the points of the only surroundings that have points between nodes. The following functions
  /// refer only to these surroundings.
  [[nodiscard]] std::span<const RodPlace> points() const override;
  void choose(std::span<const NodeMotion> nodes, std::span<const double> lengths,
              std::vector<std::size_t>& chosen) const override;
  void pull_points(std::span<const std::size_t> chosen, std::span<const NodeMotion> points,
                   std::span<NodePull> pulls) const override;
  void couple(std::span<const std::size_t> chosen, std::span<const NodeMotion> points,
              std::vector<PointCoupling>& couplings) const override;
  void tie(std::span<const std::size_t> chosen, std::span<const NodeMotion> points,
           std::vector<PointTie>& ties) const override;

 private:
  std::vector<const RodSurroundings*> parts_;
  const RodSurroundings* with_points_ = nullptr;
  mutable std::vector<NodePull> one_;
};

/// A tendon that breaks, with the time of the break.
struct TendonBreak {
  std::size_t tendon = 0;
  double time = 0;  ///< s
};

/// Returns `input` changed by all `breaks` up to `time`, s. A broken tendon has tension 0, or a displacement
/// at which it is always slack. An empty input stays empty. Throws std::invalid_argument if a break names a
/// tendon that `input` does not have.
[[nodiscard]] TendonInput after_breaks(TendonInput input, std::span<const TendonBreak> breaks, double time);

}  // namespace flexura
