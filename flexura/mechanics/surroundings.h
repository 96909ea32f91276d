#pragma once

#include <span>
#include <vector>

#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/rod_surroundings.h"

namespace flexura {

/// Several surroundings of one rod, as one: their pulls are added.
class Surroundings final : public RodSurroundings {
 public:
  /// They are kept by reference. std::invalid_argument: a null pointer, or two of them that pull at points
  /// between nodes.
  explicit Surroundings(std::vector<const RodSurroundings*> parts);
  /// Not from two threads at once.
  void pull(std::span<const NodeMotion> nodes, std::span<const double> run,
            std::span<NodePull> pulls) const override;
  /// Those of the one that has some, as all below.
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

/// A tendon that breaks at a time.
struct TendonBreak {
  std::size_t tendon = 0;
  double time = 0;  ///< s
};

/// What is left of an input at a time when tendons break: the tension of a broken tendon is 0; of
/// displacements it is let out so far that it stays slack. Of an input without tensions and displacements
/// nothing changes. std::invalid_argument: a tendon that is not in the list.
[[nodiscard]] TendonInput after_breaks(TendonInput input, std::span<const TendonBreak> breaks, double time);

}  // namespace flexura
