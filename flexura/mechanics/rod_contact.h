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
  /// Where on the rod it touches, section after section, rising (contact_places); none: at the chain's nodes.
  /// They need not be nodes, and cost nothing where nothing is near.
  std::vector<RodPlace> places = {};
};

/// Where a rod touches something.
struct ContactForce {
  std::size_t index = 0;  ///< Of all points of the contact.
  RodPlace place = {};    ///< Of the point.
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

/// Contact of a rod's tube with obstacles and with itself, at points along it: each stands for the half
/// intervals to the next ones. So the points are to be as close as what the rod touches is small.
class RodContact final : public RodSurroundings {
 public:
  /// Of the chain of RodDynamics. std::invalid_argument: a law, an obstacle, radii or places that cannot be.
  RodContact(const RodChain& chain, const RodContactConfig& config);

  /// Nothing: it pulls at points.
  void pull(std::span<const NodeMotion> nodes, std::span<const double> run,
            std::span<NodePull> pulls) const override;
  [[nodiscard]] std::span<const RodPlace> points() const override { return places_; }
  /// Those that may touch something. All of these: not from two threads at once.
  void choose(std::span<const NodeMotion> nodes, std::span<const double> lengths,
              std::vector<std::size_t>& chosen) const override;
  void pull_points(std::span<const std::size_t> chosen, std::span<const NodeMotion> points,
                   std::span<NodePull> pulls) const override;
  void couple(std::span<const std::size_t> chosen, std::span<const NodeMotion> points,
              std::vector<PointCoupling>& couplings) const override;
  void tie(std::span<const std::size_t> chosen, std::span<const NodeMotion> points,
           std::vector<PointTie>& ties) const override;
  /// What touches where all points are so (RodDynamics::point_motions), from the base on. `found` is emptied
  /// first. std::invalid_argument: another number of points.
  void find(std::span<const NodeMotion> points, std::vector<ContactForce>& found) const;
  [[nodiscard]] std::vector<ContactForce> find(std::span<const NodeMotion> points) const;

  [[nodiscard]] const ContactLaw& law() const { return law_; }

 private:
  struct Point {
    double s = 0, run = 0, radius = 0;
    double part = 0;  // Of the interval between nodes, by length.
  };
  // Between two nodes of the chain.
  struct Interval {
    std::size_t first_node = 0, first_point = 0, points = 0;
    double begin = 0, end = 0, radius = 0;  // Along the rod, m; of the tube, at most.
  };
  struct Ball {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    double radius = 0;
  };
  // Where a point touches the rod itself: on a segment of the curve through the others. By the chosen: the
  // point, and the segment's places.
  struct Meeting {
    std::size_t segment = 0;
    std::array<std::size_t, 5> points{};
    // Of the places in the nearest point, and by u; u itself changes as they move where it is inside.
    Eigen::Vector4d shares, slopes;
    double share = 0;
    bool slides = false;
    Eigen::Vector3d slope, bend;  // Of the curve there.
    Eigen::Vector3d off, arm;     // From there to the point, and to where they touch.
    Touch touch;
  };
  // Of a point, and of the four places.
  struct MeetingSlopes {
    Eigen::Matrix<double, 3, 30> force_by_pose, force_by_twist, moves;
    Eigen::Matrix<double, 3, 30> point;  // Of where they touch, for the point itself.
    Eigen::Matrix<double, 1, 30> share;
  };
  struct Piece {
    std::size_t segment = 0;
    std::array<std::size_t, 4> places{};  // By the chosen.
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
  // Of the curve's places: which point each is. Of its segments: where along the rod, and how thick.
  std::vector<std::size_t> curve_points_;
  struct Stretch {
    double from = 0, to = 0;            // m
    double radius = 0, end_radius = 0;  // m
    std::size_t section = 0;
  };
  std::vector<Stretch> stretches_;
  bool itself_ = false;
  double apart_ = 0, spacing_ = 0;  // m
  // To work with.
  mutable std::vector<Ball> balls_, interval_balls_;
  mutable std::vector<char> is_chosen_;
  mutable std::vector<std::size_t> index_;  // Of the points: among the chosen.
  mutable std::vector<Piece> pieces_;
  mutable std::vector<Meeting> meetings_;
};

/// Places along a rod, the ends of its sections among them, no further from each other than `spacing` m:
/// where it may touch what is as small as that. std::invalid_argument: a spacing that is not above 0, or that
/// makes more than 10,000 places.
[[nodiscard]] std::vector<RodPlace> contact_places(const Rod& rod, double spacing);

}  // namespace flexura
