#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "flexura/math/pose.h"
#include "flexura/mechanics/contact_law.h"
#include "flexura/mechanics/contact_shape.h"
#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_chain.h"
#include "flexura/mechanics/rod_surroundings.h"
#include "flexura/model/obstacle.h"

namespace flexura {

/// What a rod touches, and how.
struct RodContactConfig {
  ContactLaw law = {};
  std::vector<ObstacleConfig> obstacles = {};
  Pose X_WB = {};  ///< Of the rod's base in the obstacles' frame.
  /// Of the tube around each section, at the section's base and end, m; none: of the elastic rod itself.
  std::vector<std::array<double, 2>> radii = {};
  /// Whether the rod touches itself, where two places are further from each other along it than so many radii
  /// of its tube at its thickest.
  bool itself = true;
  double itself_apart = 6;
};

/// Where a rod touches something.
struct ContactForce {
  std::size_t node = 0;  ///< Of all nodes.
  RodPlace place = {};   ///< Of the node.
  /// Which of the obstacles it touches; none: itself, at `other`.
  std::optional<std::size_t> obstacle = {};
  RodPlace other = {};
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< Of the tube's surface, in the base's frame, m.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< Towards the rod.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< On the rod at `place`, N.
  Eigen::Vector3d slip = Eigen::Vector3d::Zero();    ///< Of its surface along the other, m/s.
  double depth = 0;                                  ///< m
  double normal_force = 0;                           ///< N
  bool sticks = false;                               ///< It slips no faster than the law's slip speed.
  bool is_deep = false;  ///< The tube's middle line is inside the other body: the force may push anywhere.
};

/// Contact of a rod's tube with obstacles and with itself, at the rod's nodes: each stands for the half
/// intervals beside it. So a rod that is to touch something has nodes as close as what it touches is small
/// (contact_places).
class RodContact final : public RodSurroundings {
 public:
  /// Of the nodes of the chain of RodDynamics. std::invalid_argument: a law, an obstacle or radii that
  /// cannot be.
  RodContact(const RodChain& chain, const RodContactConfig& config);

  void pull(std::span<const NodeMotion> nodes, std::span<const double> run,
            std::span<NodePull> pulls) const override;
  void couple(std::span<const NodeMotion> nodes, std::span<const double> run,
              std::vector<NodeCoupling>& couplings) const override;
  /// What touches where the nodes are so, from the base on. `found` is emptied first.
  void find(std::span<const NodeMotion> nodes, std::vector<ContactForce>& found) const;
  [[nodiscard]] std::vector<ContactForce> find(std::span<const NodeMotion> nodes) const;

  [[nodiscard]] const ContactLaw& law() const { return law_; }

 private:
  struct Node {
    RodPlace place;
    double s = 0, run = 0, radius = 0;
  };
  // Where a node touches the rod itself: between the nodes `from` and from + 1.
  struct Meeting {
    std::size_t from = 0;
    double share = 0;     // Of from + 1.
    bool slides = false;  // The share changes as they move.
    Touch touch;
  };
  // The wrench on a node that meets the rod, and the share: by small twists of it, of `from` and of from + 1,
  // side by side, and the wrench by their twists.
  struct MeetingSlopes {
    Eigen::Matrix<double, 6, 18> by_pose, by_twist;
    Eigen::Matrix<double, 1, 18> share_by_pose;
  };
  template <typename Found>
  void for_obstacles(std::span<const NodeMotion> nodes, Found&& found) const;
  [[nodiscard]] double meet(std::span<const NodeMotion> nodes, std::size_t k, std::size_t j,
                            Meeting& meeting) const;
  template <typename Found>
  void for_meetings(std::span<const NodeMotion> nodes, Found&& found) const;
  [[nodiscard]] MeetingSlopes slopes_of(std::span<const NodeMotion> nodes, const Meeting& meeting,
                                        const TouchForce& at) const;
  // Block of the wrench at one of the three by the motion of another.
  struct Blocks {
    Matrix6d by_pose, by_twist;
  };
  [[nodiscard]] static Blocks blocks(const MeetingSlopes& slopes, const Meeting& meeting,
                                     const Vector6d& wrench, int at, int of);
  void require_nodes(std::size_t nodes, std::size_t pulls) const;

  ContactLaw law_;
  std::vector<ContactShape> shapes_;
  std::vector<Node> nodes_;
  bool itself_ = false;
  double apart_ = 0;  // m
};

/// Places along a rod, no further from each other than `spacing` m: what RodDynamics takes so that a rod
/// touches what is as small as that. std::invalid_argument: a spacing that is not above 0, or that makes
/// more than 10,000 places.
[[nodiscard]] std::vector<RodPlace> contact_places(const Rod& rod, double spacing);

}  // namespace flexura
