#pragma once

#include <cstddef>

#include "flexura/kinematics/simd_kernels.h"
#include "flexura/kinematics/simd_lanes.h"

// Forward kinematics and tip Jacobians of as many arms as V has lanes, for simd_*.cc alone. The mathematics
// is docs/kinematic-model.md's; the names are those of math/series.h.
// Vectors are left without a value where they get one in a moment.
// NOLINTBEGIN(cppcoreguidelines-pro-type-member-init)
namespace flexura {
namespace {

template <typename V>
struct Vector3 {
  V x, y, z;
};
template <typename V>
Vector3<V> operator+(const Vector3<V>& a, const Vector3<V>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <typename V>
Vector3<V> operator-(const Vector3<V>& a, const Vector3<V>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <typename V>
Vector3<V> operator*(const V& factor, const Vector3<V>& a) {
  return {factor * a.x, factor * a.y, factor * a.z};
}
template <typename V>
Vector3<V> cross(const Vector3<V>& a, const Vector3<V>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <typename V>
Vector3<V> load3(const double* from, std::size_t stride) {
  return {load<V>(from), load<V>(from + stride), load<V>(from + 2 * stride)};
}
template <typename V>
void store3(double* to, std::size_t stride, const Vector3<V>& v) {
  store(to, v.x);
  store(to + stride, v.y);
  store(to + 2 * stride, v.z);
}

template <typename V>
struct Frame {
  Vector3<V> position, x, y, z;
};

template <typename V>
Frame<V> base_frame(const BatchJob& job) {
  const auto column = [&job](std::size_t i) {
    return Vector3<V>{all<V>(job.X_WB[i]), all<V>(job.X_WB[i + 1]), all<V>(job.X_WB[i + 2])};
  };
  return {column(0), column(3), column(6), column(9)};
}

template <typename V>
void store_frame(const BatchJob& job, std::size_t index, std::size_t arm, const Frame<V>& frame) {
  double* to = job.frames + index * job.frame_rows * job.stride + arm;
  store3(to, job.stride, frame.position);
  if (job.frame_rows == 3) return;
  store3(to + 3 * job.stride, job.stride, frame.x);
  store3(to + 6 * job.stride, job.stride, frame.y);
  store3(to + 9 * job.stride, job.stride, frame.z);
}

template <typename V>
V length_of(const BatchJob& job, std::size_t section, std::size_t arm) {
  if (job.stretch == nullptr) return all<V>(job.lengths[section]);
  return job.lengths[section] * load<V>(job.stretch + section * job.stretch_stride + arm);
}

template <typename V>
V bend_y_of(const BatchJob& job, std::size_t section, std::size_t arm) {
  return job.bend_y == nullptr ? V{} : load<V>(job.bend_y + section * job.bend_stride + arm);
}

// A section in its base frame, at the bend t = |(x, y)|; the slopes and sinc_deficit for Jacobians alone.
template <typename V>
struct ArcLanes {
  V x, y;                                  // The bend.
  V cosine, sinc, cosc;                    // cos t, sin t/t, (1 - cos t)/t^2.
  V sinc_slope, cosc_slope, sinc_deficit;  // As in math/series.h.
};

// sinc'(h)/h in powers of h^2: -(-1)^k (2k + 2)/(2k + 3)!; up to h = 1 nine terms leave 2e-18.
struct SlopeTerms {
  double c[9];
};
constexpr SlopeTerms slope_terms = [] {
  SlopeTerms terms{};
  double factorial = 6.0, sign = -1.0;
  for (int k = 0; k < 9; ++k) {
    terms.c[k] = sign * (2 * k + 2) / factorial;
    factorial *= (2 * k + 4) * (2 * k + 5);
    sign = -sign;
  }
  return terms;
}();

// All from the sine and cosine of h = t/2, by the rules for double angles, which do not cancel near straight:
// sinc'(t)/t = (cos h sinc'(h)/h - sinc(h)^2)/4, cosc'(t)/t = sinc(h) (sinc'(h)/h)/4.
template <bool with_slopes, typename V>
ArcLanes<V> arc_lanes(const V& x, const V& y) {
  const V square = x * x + y * y;
  const V t = square_root(square);
  const auto [sine, cosine] = sine_and_cosine<V>(0.5 * t);
  const V inverse = all<V>(1.0) / where_zero(t, 1.0, t);
  const V half_sinc = where_zero(t, 0.5, sine * inverse);
  const V sinc_h = 2.0 * half_sinc;
  const V cosc = sinc_h * half_sinc;
  ArcLanes<V> arc;
  arc.x = x;
  arc.y = y;
  arc.cosine = 1.0 - 2.0 * (sine * sine);
  arc.sinc = sinc_h * cosine;
  arc.cosc = cosc;
  if constexpr (with_slopes) {
    const V h_squared = 0.25 * square;
    const V closed = (cosine - sinc_h) * (4.0 * (inverse * inverse));
    const V slope_h = where_less(h_squared, 1.0, polynomial(slope_terms.c, h_squared), closed);
    arc.sinc_slope = 0.25 * (cosine * slope_h) - half_sinc * half_sinc;
    arc.cosc_slope = 0.5 * (half_sinc * slope_h);
    arc.sinc_deficit = cosc + arc.sinc_slope;
  }
  return arc;
}

// The arcs of `arm` and of those in the lanes after it, section by section.
template <typename V, bool with_slopes>
class Arcs {
 public:
  Arcs(const BatchJob& job, std::size_t arm) : job_(job), arm_(arm) {}

  ArcLanes<V> operator()(std::size_t i) {
    const V x = load<V>(job_.bend_x + i * job_.bend_stride + arm_);
    return arc_lanes<with_slopes>(x, bend_y_of<V>(job_, i, arm_));
  }

 private:
  const BatchJob& job_;
  std::size_t arm_;
};

// Those of one arm: four sections at a time in place of as many arms, which takes hardly longer than one.
template <bool with_slopes>
class Arcs<double, with_slopes> {
 public:
  Arcs(const BatchJob& job, std::size_t arm) : job_(job), arm_(arm) {}

  ArcLanes<double> operator()(std::size_t i) {
    const std::size_t lane = i % group;
    if (lane == 0) fill(i);
    return {number(0, lane), number(1, lane), number(2, lane), number(3, lane),
            number(4, lane), number(5, lane), number(6, lane), number(7, lane)};
  }

 private:
  static constexpr std::size_t group = lanes_of<FourLanes>;

  void fill(std::size_t first) {
    double x[group] = {}, y[group] = {};
    for (std::size_t k = 0; k < group && first + k < job_.sections; ++k) {
      x[k] = job_.bend_x[(first + k) * job_.bend_stride + arm_];
      y[k] = bend_y_of<double>(job_, first + k, arm_);
    }
    ready_ = arc_lanes<with_slopes>(load<FourLanes>(x), load<FourLanes>(y));
  }

  double number(std::size_t field, std::size_t lane) const {
    return load<double>(reinterpret_cast<const double*>(&ready_) + field * group + lane);
  }

  const BatchJob& job_;
  std::size_t arm_;
  ArcLanes<FourLanes> ready_;
};

// Moves `frame` from a section's base to its end. `sideways` is the bend in W, x X + y Y; `cord` the way from
// base to end over the length.
template <typename V>
void advance(const ArcLanes<V>& arc, const V& length, const Vector3<V>& sideways, const Vector3<V>& cord,
             Frame<V>& frame) {
  const Vector3<V> z = arc.sinc * sideways + arc.cosine * frame.z;
  frame.position = frame.position + length * cord;
  frame.x = frame.x - arc.x * cord;
  frame.y = frame.y - arc.y * cord;
  frame.z = z;
}

template <typename V>
void spatial_frames(const BatchJob& job, std::size_t arm) {
  Frame<V> frame = base_frame<V>(job);
  Arcs<V, false> arcs(job, arm);
  std::size_t index = 0;
  if (job.is_every_frame) store_frame(job, index++, arm, frame);
  for (std::size_t i = 0; i < job.sections; ++i) {
    const ArcLanes<V> arc = arcs(i);
    const Vector3<V> sideways = arc.x * frame.x + arc.y * frame.y;
    const Vector3<V> cord = arc.cosc * sideways + arc.sinc * frame.z;
    advance(arc, length_of<V>(job, i, arm), sideways, cord, frame);
    if (job.is_every_frame) store_frame(job, index++, arm, frame);
  }
  if (!job.is_every_frame) store_frame(job, 0, arm, frame);
}

// A planar arm in the plane of its base's x and z.
template <typename V>
struct PlanarLanes {
  V along_x, along_z;  // The position.
  V sine, cosine;      // Of the tangent's angle from z towards x.
};

template <typename V>
Frame<V> placed(const Frame<V>& base, const PlanarLanes<V>& at) {
  return {base.position + (at.along_x * base.x + at.along_z * base.z), at.cosine * base.x - at.sine * base.z,
          base.y, at.sine * base.x + at.cosine * base.z};
}

// The paper's equations: half the bend to the cord, the other half to the end (docs/kinematic-model.md).
template <typename V>
void planar_frames(const BatchJob& job, std::size_t arm) {
  const Frame<V> base = base_frame<V>(job);
  PlanarLanes<V> at = {V{}, V{}, V{}, all<V>(1.0)};
  std::size_t index = 0;
  if (job.is_every_frame) store_frame(job, index++, arm, base);
  for (std::size_t i = 0; i < job.sections; ++i) {
    const V half = 0.5 * load<V>(job.bend_x + i * job.bend_stride + arm);
    const auto [sine, cosine] = sine_and_cosine<V>(half);
    const V sinc = where_zero(half, 1.0, sine) / where_zero(half, 1.0, half);
    const V cord = length_of<V>(job, i, arm) * sinc;
    const V cord_sine = at.sine * cosine + at.cosine * sine;
    const V cord_cosine = at.cosine * cosine - at.sine * sine;
    at = {at.along_x + cord * cord_sine, at.along_z + cord * cord_cosine,
          cord_sine * cosine + cord_cosine * sine, cord_cosine * cosine - cord_sine * sine};
    if (job.is_every_frame) store_frame(job, index++, arm, placed(base, at));
  }
  if (!job.is_every_frame) store_frame(job, 0, arm, placed(base, at));
}

// What the rates of one section do to its end, in W.
template <typename V>
struct SectionTwists {
  Vector3<V> end;                   // Where it is.
  Vector3<V> linear_x, linear_y;    // Per unit rate of bend_x and bend_y.
  Vector3<V> angular_x, angular_y;  // The same.
  Vector3<V> along;                 // Linear, per unit rate of stretch.
};

template <typename V>
SectionTwists<V> section_twists(const ArcLanes<V>& arc, const V& length, double rest_length,
                                Frame<V>& frame) {
  const Vector3<V> sideways = arc.x * frame.x + arc.y * frame.y;
  const Vector3<V> cord = arc.cosc * sideways + arc.sinc * frame.z;
  const Vector3<V> growth = arc.cosc_slope * sideways + arc.sinc_slope * frame.z;
  const Vector3<V> turn = arc.sinc_deficit * sideways + arc.cosc * frame.z;
  SectionTwists<V> twists;
  twists.linear_x = length * (arc.cosc * frame.x + arc.x * growth);
  twists.linear_y = length * (arc.cosc * frame.y + arc.y * growth);
  twists.angular_x = frame.y - arc.y * turn;
  twists.angular_y = arc.x * turn - frame.x;
  twists.along = all<V>(rest_length) * cord;
  advance(arc, length, sideways, cord, frame);
  twists.end = frame.position;
  return twists;
}

template <typename V>
double* store_column(double* to, std::size_t stride, const Vector3<V>& linear, const Vector3<V>& angular) {
  store3(to, stride, linear);
  store3(to + 3 * stride, stride, angular);
  return to + 6 * stride;
}

// Up the arm to find the tip, then over the sections again: past its end each moves the tip as a rigid body.
template <typename V>
void tip_jacobian_lanes(const BatchJob& job, std::size_t arm) {
  constexpr std::size_t width = lanes_of<V>;
  Frame<V> frame = base_frame<V>(job);
  Arcs<V, true> arcs(job, arm);
  for (std::size_t i = 0; i < job.sections; ++i) {
    const auto twists = section_twists<V>(arcs(i), length_of<V>(job, i, arm), job.lengths[i], frame);
    __builtin_memcpy(job.scratch + i * scratch_rows * width, &twists, sizeof twists);
  }
  store_frame(job, 0, arm, frame);
  double* column = job.jacobian + arm;
  for (std::size_t i = 0; i < job.sections; ++i) {
    SectionTwists<V> twists;
    __builtin_memcpy(&twists, job.scratch + i * scratch_rows * width, sizeof twists);
    const Vector3<V> lever = frame.position - twists.end;
    column =
        store_column(column, job.stride, twists.linear_x + cross(twists.angular_x, lever), twists.angular_x);
    if (job.bend_y != nullptr) {
      column = store_column(column, job.stride, twists.linear_y + cross(twists.angular_y, lever),
                            twists.angular_y);
    }
    if (job.stretch != nullptr) column = store_column(column, job.stride, twists.along, Vector3<V>{});
  }
}

// Flattened: a call would keep its arguments, many vectors, in memory.
template <typename V>
[[gnu::flatten]] void frames_kernel(const BatchJob& job, std::size_t begin, std::size_t end) {
  const bool is_planar = job.bend_y == nullptr;
  for (std::size_t arm = begin; arm < end; arm += lanes_of<V>) {
    if (is_planar) {
      planar_frames<V>(job, arm);
    } else {
      spatial_frames<V>(job, arm);
    }
  }
}

template <typename V>
[[gnu::flatten]] void jacobians_kernel(const BatchJob& job, std::size_t begin, std::size_t end) {
  static_assert(sizeof(SectionTwists<V>) == scratch_rows * sizeof(V));
  for (std::size_t arm = begin; arm < end; arm += lanes_of<V>) tip_jacobian_lanes<V>(job, arm);
}

template <typename V>
[[gnu::flatten]] void sines_and_cosines_kernel(const double* angles, double* sines, double* cosines,
                                               std::size_t count) {
  for (std::size_t i = 0; i < count; i += lanes_of<V>) {
    const SineCosine<V> result = sine_and_cosine(load<V>(angles + i));
    store(sines + i, result.sine);
    store(cosines + i, result.cosine);
  }
}

template <typename V>
constexpr LaneFunctions functions_for = {lanes_of<V>, frames_kernel<V>, jacobians_kernel<V>,
                                         sines_and_cosines_kernel<V>};

template <typename V>
constexpr SimdKernels kernels_for = {functions_for<V>, functions_for<double>};

}  // namespace
}  // namespace flexura
// NOLINTEND(cppcoreguidelines-pro-type-member-init)
