#include "flexura/calibrate/marker_vote.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

#include "flexura/calibrate/marker_features.h"
#include "flexura/math/small_cholesky.h"
#include "flexura/math/so3.h"

namespace flexura {
namespace {

using Point = std::complex<double>;

Point point(const Eigen::Vector2d& pixel) { return {pixel.x(), pixel.y()}; }

// Points in W as seen by a camera with pose and lens errors.
class MisalignedView {
 public:
  MisalignedView(const View& view, const PointingError& error)
      : view_(view), turn_(so3_exp(error.turn)), scale_(std::exp(error.scale)) {}
  [[nodiscard]] std::optional<Eigen::Vector2d> operator()(const Eigen::Vector3d& p_W) const {
    const Eigen::Vector3d& eye = view_.X_WC.position;
    auto pixel = view_.project(eye + turn_ * (p_W - eye));
    if (!pixel) return pixel;
    const Eigen::Vector2d middle(view_.lens.intrinsics().cx, view_.lens.intrinsics().cy);
    return Eigen::Vector2d(middle + scale_ * (*pixel - middle));
  }

 private:
  const View& view_;
  Eigen::Matrix3d turn_;
  double scale_;
};

// Standard deviation of the modelled arm's markers after the camera is corrected, px. Each matched pair votes
// for an error; a pair this far off counts half a vote less.
constexpr double pair_sigma = 20;

struct Candidate {
  PointingError error;
  double score = 0;
  std::vector<std::vector<MarkerPairs::Pair>> pairs;  // By picture.

  [[nodiscard]] bool is_better_than(const Candidate& other) const { return score > other.score; }
  // Whether both assign the same identities where both have one.
  [[nodiscard]] bool names_like(const Candidate& other) const {
    bool is_any = false;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      auto two = other.pairs[k].begin();
      for (const auto& one : pairs[k]) {
        while (two != other.pairs[k].end() && two->seen < one.seen) ++two;
        if (two == other.pairs[k].end()) break;
        if (two->seen != one.seen) continue;
        if (two->expected != one.expected) return false;
        is_any = true;
      }
    }
    return is_any;
  }
};

class Vote {
 public:
  Vote(std::span<const MarkerPicture> pictures, const PointingPrior& pointing_prior)
      : pictures_(pictures), pointing_prior_(pointing_prior) {
    for (const MarkerPicture& picture : pictures) {
      const MarkerScene expected = expected_scene(picture, {});
      const MarkerPalette palette(expected, picture.seen);
      Side& side = sides_.emplace_back();
      side.expected = features_of(expected, palette), side.seen = features_of(picture.seen, palette);
      side.tolerance = tolerances(side.expected);
      for (const MarkerFeature& one : side.expected)
        side.places.push_back(one.kind == MarkerFeature::end_kind ? picture.ends[one.number]
                                                                  : picture.markers[one.number].p_W);
    }
  }

  std::vector<PointingError> best(std::size_t most) {
    keep(tried({}, 0, sides_.size()), most_kept, best_);
    for (std::size_t k = 0; k < sides_.size(); ++k) hypothesise(k);
    for (Candidate& one : best_) one = refined(std::move(one));
    std::ranges::stable_sort(best_, [](const auto& a, const auto& b) { return a.is_better_than(b); });
    std::vector<PointingError> result;
    std::vector<const Candidate*> kept;
    for (const Candidate& one : best_) {
      if (result.size() == most) break;
      const bool is_new =
          std::ranges::none_of(kept, [&](const Candidate* other) { return other->names_like(one); });
      if (is_new) result.push_back(one.error), kept.push_back(&one);
    }
    return result;
  }

 private:
  // Features of a picture, and the positions in W of the expected ones.
  struct Side {
    std::vector<MarkerFeature> expected, seen;
    std::vector<double> tolerance;
    std::vector<Eigen::Vector3d> places;
    std::vector<MarkerFeature> moved;  // Scratch space.
  };

  // Collects the errors that map two expected features of a picture to two seen ones. Those that explain most
  // of this picture are tried on all.
  void hypothesise(std::size_t k) {
    const Side& side = sides_[k];
    constexpr std::size_t most = 40;
    std::vector<Candidate> likely;
    for_likely_moves(side.expected, side.seen, [&](const Point& turn, const Point& from, const Point& to) {
      if (const auto error = error_of(pictures_[k].view, turn, from, to))
        keep(tried(*error, k, k + 1), most, likely);
    });
    for (const Candidate& one : likely) keep(tried(one.error, 0, sides_.size()), most_kept, best_);
  }
  // Returns the error that rotates and scales a picture like this and maps one point in it to another.
  [[nodiscard]] std::optional<PointingError> error_of(const View& view, const Point& turn, const Point& from,
                                                      const Point& to) const {
    const double scale = std::log(std::abs(turn)), roll = std::arg(turn);
    const Intrinsics& lens = view.lens.intrinsics();
    const Point middle(lens.cx, lens.cy), back = middle + (to - middle) / std::abs(turn);
    const auto seen_from = view.lens.unproject({from.real(), from.imag()}),
               seen_back = view.lens.unproject({back.real(), back.imag()});
    if (!seen_from || !seen_back) return std::nullopt;
    const Eigen::Vector3d rolled =
                              so3_exp(Eigen::Vector3d(0, 0, roll)) * seen_from->homogeneous().normalized(),
                          aimed = seen_back->homogeneous().normalized();
    const Eigen::Matrix3d R = so3_exp(between(rolled, aimed)) * so3_exp(Eigen::Vector3d(0, 0, roll));
    PointingError error{view.X_WC.rotation * so3_log(R), scale};
    constexpr double unlikely = 16;
    if (!error.turn.allFinite() || prior_cost(view, error) > unlikely) return std::nullopt;
    return error;
  }
  // Rotation vector from one direction to another.
  static Eigen::Vector3d between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const Eigen::Vector3d axis = from.cross(to);
    const double sine = axis.norm();
    return sine > 0 ? Eigen::Vector3d(axis * (std::atan2(sine, from.dot(to)) / sine)) : axis;
  }
  // Sum of squares, in standard deviations.
  [[nodiscard]] double prior_cost(const View& view, const PointingError& error) const {
    const double roll = error.turn.dot(view.X_WC.rotation.col(2));
    const double sideways = (error.turn - roll * view.X_WC.rotation.col(2)).squaredNorm();
    return sideways / (pointing_prior_.sideways * pointing_prior_.sideways) +
           roll * roll / (pointing_prior_.roll * pointing_prior_.roll) +
           error.scale * error.scale / (pointing_prior_.scale * pointing_prior_.scale);
  }

  // Evaluates an error on the pictures [from, to).
  [[nodiscard]] Candidate tried(const PointingError& error, std::size_t from, std::size_t to) {
    Candidate result;
    result.error = error;
    result.score = -0.5 * prior_cost(pictures_.front().view, error);
    for (std::size_t k = from; k < to; ++k) {
      Side& side = sides_[k];
      const MisalignedView misaligned(pictures_[k].view, error);
      side.moved = side.expected;
      for (std::size_t a = 0; a < side.moved.size(); ++a) {
        constexpr double nowhere = 1e6;
        const auto pixel = misaligned(side.places[a]);
        side.moved[a].at = pixel ? point(*pixel) : Point(-nowhere, -nowhere);
      }
      MarkerPairs found = nearest_pairs(side.moved, side.tolerance, std::exp(error.scale), side.seen,
                                        {pictures_[k].view.width, pictures_[k].view.height});
      result.score += found.score - 0.5 * found.off / (pair_sigma * pair_sigma);
      result.pairs.push_back(std::move(found.pairs));
    }
    return result;
  }

  // Keeps the best of the candidates with compatible identities, and at most `most` candidates.
  static void keep(Candidate candidate, std::size_t most, std::vector<Candidate>& kept) {
    const auto is_worse = [](const auto& a, const auto& b) { return b.is_better_than(a); };
    const auto worst = std::ranges::min_element(kept, is_worse);
    if (kept.size() == most && !candidate.is_better_than(*worst)) return;
    for (Candidate& one : kept) {
      if (!one.names_like(candidate)) continue;
      if (candidate.is_better_than(one)) one = std::move(candidate);
      return;
    }
    if (kept.size() < most)
      kept.push_back(std::move(candidate));
    else
      *worst = std::move(candidate);
  }

  // Least-squares fit to its pairs, repeated while that explains more.
  Candidate refined(Candidate candidate) {
    constexpr int rounds = 6;
    for (int round = 0; round < rounds; ++round) {
      Candidate next = tried(step_from(candidate), 0, sides_.size());
      if (!next.is_better_than(candidate)) break;
      candidate = std::move(next);
    }
    return candidate;
  }
  [[nodiscard]] PointingError step_from(const Candidate& candidate) const {
    constexpr double h = 1e-6;  // rad
    const View& first = pictures_.front().view;
    const Eigen::Vector3d axis = first.X_WC.rotation.col(2);
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    normal.topLeftCorner<3, 3>() = (Eigen::Matrix3d::Identity() - axis * axis.transpose()) /
                                       (pointing_prior_.sideways * pointing_prior_.sideways) +
                                   axis * axis.transpose() / (pointing_prior_.roll * pointing_prior_.roll);
    normal(3, 3) = 1 / (pointing_prior_.scale * pointing_prior_.scale);
    Eigen::Vector4d x;
    x << candidate.error.turn, candidate.error.scale;
    Eigen::Vector4d gradient = normal * x;
    for (std::size_t k = 0; k < sides_.size(); ++k) {
      for (const auto& [i, a] : candidate.pairs[k]) {
        const auto pixel_at = [&](const Eigen::Vector4d& at) {
          return MisalignedView(pictures_[k].view, {at.head<3>(), at[3]})(sides_[k].places[a]);
        };
        const auto here = pixel_at(x);
        if (!here) continue;
        Eigen::Matrix<double, 2, 4> J;
        bool is_seen = true;
        for (Eigen::Index d = 0; d < 4; ++d) {
          Eigen::Vector4d beside = x;
          beside[d] += h;
          const auto there = pixel_at(beside);
          is_seen = is_seen && there;
          if (there) J.col(d) = (*there - *here) / (h * pair_sigma);
        }
        if (!is_seen) continue;
        const Point& seen = sides_[k].seen[i].at;
        const Eigen::Vector2d off = (*here - Eigen::Vector2d(seen.real(), seen.imag())) / pair_sigma;
        normal += J.transpose() * J, gradient += J.transpose() * off;
      }
    }
    x -= solve_definite(normal, gradient);
    if (!x.allFinite()) return candidate.error;
    return {x.head<3>(), x[3]};
  }

  static constexpr std::size_t most_kept = 12;

  std::span<const MarkerPicture> pictures_;
  PointingPrior pointing_prior_;
  std::vector<Side> sides_;
  std::vector<Candidate> best_;
};

}  // namespace

MarkerScene expected_scene(const MarkerPicture& picture, const PointingError& error) {
  const MisalignedView misaligned(picture.view, error);
  MarkerScene scene;
  for (const MarkerPicture::Place& marker : picture.markers) {
    auto& place = scene.markers.emplace_back();
    if (const auto pixel = misaligned(marker.p_W)) place = MarkerScene::Place{*pixel, marker.color};
  }
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) scene.ends[i] = misaligned(picture.ends[i]);
  return scene;
}

std::vector<PointingError> likely_errors(std::span<const MarkerPicture> pictures,
                                         const PointingPrior& pointing_prior, std::size_t most) {
  if (pictures.empty()) return {};
  return Vote(pictures, pointing_prior).best(most);
}

}  // namespace flexura
