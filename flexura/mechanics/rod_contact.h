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
#include "flexura/mechanics/rod_curve.h"
#include "flexura/mechanics/rod_surroundings.h"
#include "flexura/model/obstacle.h"

namespace flexura {

/// Settings of a rod's contact.
struct RodContactConfig {
  ContactLaw law = {};
  std::vector<ObstacleConfig> obstacles = {};
  Pose X_WB = {};  ///< Pose of the rod's base in the obstacles' frame.
  /// Radii of the tube around each section, at the section's base and end, m; empty: the radii of the elastic
  /// rod.
  std::vector<std::array<double, 2>> radii = {};
  /// Enables self-contact. Self-contact acts between places whose distance along the rod exceeds
  /// `itself_apart` times the largest radius of the tube.
  bool itself = true;
  double itself_apart = 6;
  /// Contact points on the rod in the order from base to tip (contact_places); empty: the chain's nodes. The
  /// points need not be nodes. Points that are far from all bodies need no computing time.
  std::vector<RodPlace> places = {};
};

/// A contact of a rod.
struct ContactForce {
  std::size_t index = 0;  ///< Index among all contact points.
  RodPlace place = {};    ///< Place of the point.
  /// Index of the obstacle; std::nullopt: self-contact with the place `other`.
  std::optional<std::size_t> obstacle = {};
  RodPlace other = {};
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< Point on the tube's surface, in the base's frame, m.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< Unit normal towards the rod.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< Force on the rod at `place`, N.
  /// Tangential velocity of the rod's surface relative to the other surface, m/s.
  Eigen::Vector3d slip = Eigen::Vector3d::Zero();
  double depth = 0;         ///< m
  double normal_force = 0;  ///< N
  bool sticks = false;      ///< Whether the slip is at most the law's slip speed.
  /// Whether the tube's centerline is inside the other body. If the centerline is inside, the force may have
  /// any direction.
  bool is_deep = false;
};

/// Contact of a rod's tube with obstacles and with itself, at points along the rod. Each point represents
/// half of the intervals to its two neighbours. So the spacing of the points must not exceed the size of the
/// obstacles.
class RodContact final : public RodSurroundings {
 public:
  /// `chain`: the chain of RodDynamics. Throws std::invalid_argument for an invalid law, obstacle, radius or
  /// place.
  RodContact(const RodChain& chain, const RodContactConfig& config);

  /// Sets the wrenches at nodes to 0, because contact acts only at points.
  void pull(std::span<const NodeMotion> nodes, std::span<const double> run,
            std::span<NodePull> pulls) const override;
  [[nodiscard]] std::span<const RodPlace> points() const override { return places_; }
  /// Chooses the points that may touch a body. This function and the following functions are not thread-safe.
  void choose(std::span<const NodeMotion> nodes, std::span<const double> lengths,
              std::vector<std::size_t>& chosen) const override;
  void pull_points(std::span<const std::size_t> chosen, std::span<const NodeMotion> points,
                   std::span<NodePull> pulls) const override;
  void couple(std::span<const std::size_t> chosen, std::span<const NodeMotion> points,
              std::vector<PointCoupling>& couplings) const override;
  void tie(std::span<const std::size_t> chosen, std::span<const NodeMotion> points,
           std::vector<PointTie>& ties) const override;
  /// Finds the contacts for the motion of all points (RodDynamics::point_motions), from the base on. Clears
  /// `found` first. Throws std::invalid_argument for a wrong number of points.
  void find(std::span<const NodeMotion> points, std::vector<ContactForce>& found) const;
  [[nodiscard]] std::vector<ContactForce> find(std::span<const NodeMotion> points) const;

  /// Returns whether a point may have passed through an obstacle on its straight way from one motion to
  /// another. The result is true if the point has touched the obstacle and has moved farther than a limit.
  /// The limit is half of the sum of the tube's radius and ContactShape::half_thickness(). Throws
  /// std::invalid_argument for a wrong number of points.
  [[nodiscard]] bool may_have_passed(std::span<const NodeMotion> before,
                                     std::span<const NodeMotion> after) const;

  [[nodiscard]] const ContactLaw& law() const { return law_; }

 private:
  struct Point {
    double s = 0, run = 0, radius = 0;
    double part = 0;  // Part of the interval between nodes, by length.
  };
  // Interval between two nodes of the chain.
  struct Interval {
    std::size_t first_node = 0, first_point = 0, points = 0;
    double begin = 0, end = 0, radius = 0;  // Along the rod, m; largest radius of the tube.
  };
  struct Ball {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    double radius = 0;
  };
  // Self-contact of a point with a segment of the curve through the others. Indices among the chosen points:
  // the point, and the segment's places.
  struct Meeting {
    std::size_t segment = 0;
    std::array<std::size_t, 5> points{};
    // Shares of the places in the nearest point, and their derivatives with respect to u. u itself moves with
    // the places where it is inside the segment.
    Eigen::Vector4d shares, slopes;
    double share = 0;
    bool slides = false;
    Eigen::Vector3d slope, bend;  // Of the curve at u.
    Eigen::Vector3d off, arm;     // From the nearest point to the point, and to the touching point.
    Touch touch;
  };
  // Derivatives with respect to a point and the four places.
  struct MeetingSlopes {
    Eigen::Matrix<double, 3, 30> force_by_pose, force_by_twist, moves;
    Eigen::Matrix<double, 3, 30> point;  // Of the touching point, for the point itself.
    Eigen::Matrix<double, 1, 30> share;
  };
  struct Piece {
    std::size_t segment = 0;
    std::array<std::size_t, 4> places{};  // Indices among the chosen points.
    RodCurve::Piece curve;
  };
  void set_points(const RodChain& chain, const RodContactConfig& config);
  void set_curve(const RodChain& chain);
  void choose_near_obstacles(const Interval& interval, const Ball& ball) const;
  void choose_near_itself(const Interval& one, const Interval& other, double apart) const;
  template <typename Found>
  void for_obstacles(std::span<const std::size_t> chosen, std::span<const NodeMotion> points,
                     Found&& found) const;
  void find_meetings(std::span<const std::size_t> chosen, std::span<const NodeMotion> points) const;
  void find_pieces(std::span<const std::size_t> chosen, std::span<const NodeMotion> points) const;
  [[nodiscard]] bool meet(const Piece& piece, std::span<const NodeMotion> points, std::size_t index,
                          std::size_t k, Meeting& meeting) const;
  [[nodiscard]] MeetingSlopes slopes_of(std::span<const NodeMotion> points, const Meeting& meeting,
                                        const TouchForce& at) const;

  ContactLaw law_;
  std::vector<ContactShape> shapes_;
  std::vector<RodPlace> places_;
  std::vector<Point> points_;
  std::vector<Interval> intervals_;
  RodCurve curve_;
  // Point of each place of the curve. For its segments: range along the rod, and radii.
  std::vector<std::size_t> curve_points_;
  struct Stretch {
    double from = 0, to = 0;            // m
    double radius = 0, end_radius = 0;  // m
    std::size_t section = 0;
  };
  std::vector<Stretch> stretches_;
  bool itself_ = false;
  double apart_ = 0, spacing_ = 0;  // m
  // Work space.
  mutable std::vector<Ball> balls_, interval_balls_;
  mutable std::vector<char> is_chosen_;
  mutable std::vector<std::size_t> index_;  // Index of each point among the chosen.
  mutable std::vector<Piece> pieces_;
  mutable std::vector<Meeting> meetings_;
};

/// Returns places along a rod, section ends included, at distances of at most `spacing` m. At this spacing,
/// obstacles of the size `spacing` are detected. Throws std::invalid_argument for a spacing that is not
/// positive, or that results in more than 10,000 places.
[[nodiscard]] std::vector<RodPlace> contact_places(const Rod& rod, double spacing);

}  // namespace flexura
