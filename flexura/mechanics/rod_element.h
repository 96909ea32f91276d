#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "flexura/math/magnus.h"
#include "flexura/math/pose.h"
#include "flexura/math/se3.h"
#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_grid.h"

namespace flexura {

/// One section of a rod at work: its shape, and the balance of what it is made of with what pulls at it.
/// Nothing is allocated after the constructor.
///
/// All in the frame of the rod's base. Twists and wrenches are about its origin, so that a column of a
/// Jacobian stays the same beyond what it moves, and wrenches only add up.
class RodElement {
 public:
  using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic>;

  /// `s_base`: arc length from the rod's base to the section's, m. `at`: places, from 0 to 1, that are to be
  /// nodes.
  RodElement(const RodSection& section, std::span<const TendonRoute> tendons, std::size_t index,
             double s_base, std::span<const double> at);

  [[nodiscard]] int size() const { return grid_.size; }
  [[nodiscard]] const RodGrid& grid() const { return grid_; }
  [[nodiscard]] double length() const { return length_; }
  /// Whether its tendons' forces depend on how its parts lie to each other, not on its strains alone.
  [[nodiscard]] bool has_chords() const { return !grid_.disks.empty(); }

  /// The section's own length at rest becomes this factor of what its description says.
  void stretch_rest(double factor) { grid_.stretch_rest(factor); }
  /// What its modes are worth, `size()`.
  void set_modes(const Eigen::Ref<const Eigen::VectorXd>& q);
  [[nodiscard]] const Eigen::VectorXd& modes() const { return q_; }
  /// Where the nodes lie when its base lies so.
  void place(const Pose& X_BS);
  /// The same, and how they move by the modes (columns()).
  void place_with_columns(const Pose& X_BS);
  /// At the nodes.
  [[nodiscard]] const std::vector<Vector6d>& strains() const { return strain_; }
  /// Of the nodes, z along the rod.
  [[nodiscard]] const std::vector<Pose>& poses() const { return X_; }
  /// Of each node, 6 x size(): its twist by each mode.
  [[nodiscard]] const std::vector<Columns>& columns() const { return A_; }

  /// How a tendon has run since its base: by what angle it has turned, rad, and in what direction it leaves,
  /// in the frame of a section's end; zero at the base.
  struct Run {
    double turned = 0;
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  };
  /// Of a run, by a change of the modes of all sections.
  struct RunChange {
    double turned = 0;
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
    Vector6d base = Vector6d::Zero();  ///< Twist of the next section's base.
  };
  /// Follows a tendon of the rod through the section: from its run at the base to that at the end. What is
  /// left of its tension at each node by friction is kept for stress(). Chords need the poses.
  void rub(std::size_t tendon, double friction, Run& run);
  /// Follows what a change dq of the modes makes of that, as rub() found it last, and adds to the residual's
  /// change what friction does to it. `run`: at the base, which is followed again. Chords need the columns.
  void rub_change(std::size_t tendon, double friction, double tension, const Eigen::VectorXd& dq, Run& run,
                  RunChange& change, Eigen::Ref<Eigen::VectorXd> residual_change) const;
  /// The balance of what it is made of and of its tendons: residual, tangent, tendons' lengths and their
  /// slopes. `tension`: at the base, N, one a tendon of the rod. Chords need the columns. Friction is taken
  /// as it is: what it loses more as the tendon turns further is not in the tangent.
  void stress(std::span<const double> tension);
  /// Adds what loads do, `share` of them, where `beyond` is the wrench of all of the loads of the sections
  /// after this one. The columns are there.
  void load(const RodLoads& loads, double share, const Vector6d& beyond);

  // NOLINTBEGIN(performance-unnecessary-value-param): an Eigen::Ref is written through.
  /// Adds the residual's change by a part of its stiffness against shear, stretch, bends and twist.
  void add_stiffness_slopes(Eigen::Ref<Eigen::MatrixXd> slopes) const;
  /// Adds that by a part of its mass along its length, and the wrench of all of that. The columns are there.
  void add_weight_slope(const Eigen::Vector3d& gravity, Vector6d& all,
                        Eigen::Ref<Eigen::VectorXd> slope) const;
  // NOLINTEND(performance-unnecessary-value-param)

  /// The gradient of its energy by its modes, less what loads do.
  Eigen::VectorXd residual;
  /// Of the residual, by its modes.
  Eigen::MatrixXd tangent;
  /// Of the residual, by a twist of its base: size() x 6, negative.
  Eigen::Matrix<double, Eigen::Dynamic, 6> by_base;
  /// Of the residual, by the share of the loads.
  Eigen::VectorXd by_share;
  /// Of its loads' wrench, that share of it, by its modes and by a twist of its base.
  Columns wrench_by_modes;
  Matrix6d wrench_by_base = Matrix6d::Zero();
  /// Of all of its loads.
  Vector6d wrench = Vector6d::Zero();
  /// How long each tendon of the rod is in it, m; that by its modes, size() x tendons; and the residual by
  /// the tensions at the base, which is the same where friction leaves all of them.
  Eigen::VectorXd tendon_lengths;
  Eigen::MatrixXd length_slopes, pull_slopes;
  /// Of its strains, J.
  double strain_energy = 0;

 private:
  // Where a tendon passes a node.
  struct Passage {
    Eigen::Vector3d offset, slope, second;
    double left = 1;  // Of the tension at the tendon's base; of a chord that begins here.
  };
  [[nodiscard]] static Eigen::Vector3d way(const Passage& passage, const Vector6d& strain);
  [[nodiscard]] static Eigen::Vector3d path_slope(const Passage& passage, const Vector6d& strain,
                                                  const Vector6d& slope);
  [[nodiscard]] Vector6d strain_slope(std::size_t node) const;
  [[nodiscard]] const std::vector<Passage>* passages_of(std::size_t tendon) const;
  // What a wrench makes of how the intervals turn each other.
  void add_geometry(std::size_t interval, const Vector6d& W, std::size_t from, double factor);
  void add_chord(std::size_t tendon, std::size_t from, std::size_t to, double tension, double left);
  void find_forces(const RodLoads& loads);
  void add_block(const Matrix6d& block, const Eigen::MatrixXd& left, const Eigen::MatrixXd& right,
                 std::size_t column, double factor);
  [[nodiscard]] MagnusStep::Moments moments_of(std::size_t interval) const;

  RodGrid grid_;
  double length_;
  std::size_t index_;
  std::vector<PointMass> masses_;
  // Of each tendon that runs here: its place in the rod's list, and how it passes the nodes.
  std::vector<std::size_t> tendons_;
  std::vector<std::vector<Passage>> passages_;

  Eigen::VectorXd q_, rates_;
  std::vector<Vector6d> strain_;  // At the nodes.
  std::vector<Pose> X_;
  std::vector<Columns> A_;
  // Of each interval: its twist by the moments of its strain, and exp of that.
  std::vector<MagnusStep> twist_;
  std::vector<MagnusStep::Slopes> by_moments_;
  std::vector<TwistExponential> exp_;
  // Of each node, what pulls there, and that by its twist.
  std::vector<Vector6d> F_;
  std::vector<Matrix6d> D_;
  Columns step_, moved_, turned_;  // Space for columns.
};

}  // namespace flexura
