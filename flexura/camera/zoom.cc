#include "flexura/camera/zoom.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

#include "flexura/base/table.h"
#include "flexura/camera/lens_ranges.h"

namespace flexura {
namespace {

constexpr std::size_t max_rows = 1000;

Intrinsics lens_at_one(const LensConfig& config, std::int64_t width, std::int64_t height) {
  return {config.fx, config.fy.value_or(config.fx), config.cx.value_or(0.5 * static_cast<double>(width - 1)),
          config.cy.value_or(0.5 * static_cast<double>(height - 1)),
          distortion_of(config.model, config.distortion)};
}

Intrinsics lens_at(const ZoomRow& row, const Intrinsics& one) {
  return {row.fx.value_or(one.fx * row.ratio), row.fy.value_or(one.fy * row.ratio), row.cx.value_or(one.cx),
          row.cy.value_or(one.cy),
          row.distortion ? distortion_of(one.distortion.model(), *row.distortion) : one.distortion};
}

Eigen::Vector<double, intrinsics_count> numbers(const Intrinsics& lens) {
  Eigen::Vector<double, intrinsics_count> result;
  result << lens.fx, lens.fy, lens.cx, lens.cy,
      Eigen::Map<const Eigen::Vector<double, Distortion::most>>(lens.distortion.data());
  return result;
}

// Derivative of a row's values with respect to the values of the lens at ratio 1. Only values that the row
// omits depend on the lens.
Eigen::Vector<double, intrinsics_count> left_out(const ZoomRow& row) {
  const auto factor = [](bool is_written, double otherwise) { return is_written ? 0.0 : otherwise; };
  Eigen::Vector<double, intrinsics_count> result;
  result.setConstant(factor(row.distortion.has_value(), 1));
  result.head<4>() << factor(row.fx.has_value(), row.ratio), factor(row.fy.has_value(), row.ratio),
      factor(row.cx.has_value(), 1), factor(row.cy.has_value(), 1);
  return result;
}

Spec row_spec(const char* meaning, NumberRange range, const char* default_text) {
  return {.meaning = meaning, .range = range, .default_text = default_text};
}

}  // namespace

const Table<ZoomRow>& fields_of(const ZoomRow*) {
  static const auto table =
      Table<ZoomRow>("zoom row", "A measured zoom position.")
          .field("ratio", &ZoomRow::ratio,
                 {.meaning = "Zoom ratio: focal length divided by the focal length at ratio 1. The ratio "
                             "must increase from row to row.",
                  .range = above_up_to(0, 1e4),
                  .required = true})
          .field("count", &ZoomRow::count,
                 row_spec("Position of the zoom motor. If it is given, zoom positions are motor positions "
                          "instead of ratios. The position must either increase or decrease from row to row.",
                          {.min = -1e9, .max = 1e9}, "not set"))
          .field("fx", &ZoomRow::fx,
                 row_spec("Horizontal focal length, px.", focal_length_range, "the lens's times the ratio"))
          .field("fy", &ZoomRow::fy,
                 row_spec("Vertical focal length, px.", focal_length_range, "the lens's times the ratio"))
          .field("cx", &ZoomRow::cx,
                 row_spec("Column of the principal point, px.", principal_point_range, "the lens's"))
          .field("cy", &ZoomRow::cy,
                 row_spec("Row of the principal point, px.", principal_point_range, "the lens's"))
          .field("distortion", &ZoomRow::distortion,
                 distortion_spec("Distortion coefficients, as those of the lens.", "the lens's"));
  return table;
}

const Table<LensConfig>& fields_of(const LensConfig*) {
  static const auto table =
      Table<LensConfig>("lens", "Zoom lens: parameters at ratio 1 and their change with zoom.")
          .field("fx", &LensConfig::fx,
                 {.meaning = "Horizontal focal length at ratio 1, px.", .range = focal_length_range})
          .field("fy", &LensConfig::fy,
                 row_spec("Vertical focal length at ratio 1, px.", focal_length_range, "fx"))
          .field("cx", &LensConfig::cx,
                 row_spec("Column of the principal point, px from the middle of the leftmost pixel.",
                          principal_point_range, "the image's middle"))
          .field("cy", &LensConfig::cy,
                 row_spec("Row of the principal point, px from the middle of the topmost pixel.",
                          principal_point_range, "the image's middle"))
          .field("model", &LensConfig::model, {.meaning = lens_model_meaning})
          .field("distortion", &LensConfig::distortion, distortion_spec(distortion_meaning, "zeros"))
          .field("zoom", &LensConfig::zoom,
                 {.meaning = "Measured zoom positions, as tables [[camera.lens.zoom]].",
                  .count = {0, max_rows},
                  .default_text =
                      "none: the focal length is proportional to the ratio, everything else is constant"})
          .check([](const LensConfig& config, Reader& reader) {
            if (const auto fault = ZoomTable::fault(config)) reader.problem_at(fault->path, fault->what);
          });
  return table;
}

std::optional<ZoomTable::Fault> ZoomTable::fault(const LensConfig& config) {
  const auto& rows = config.zoom;
  if (const std::string wrong = distortion_fault(config.model, config.distortion); !wrong.empty())
    return Fault{"distortion", wrong};
  if (rows.empty()) return std::nullopt;
  if (rows.size() == 1)
    return Fault{"zoom", "has one row: expected at least two rows, or no rows for a linear zoom"};
  const Intrinsics one = lens_at_one(config, 1, 1);
  const bool counts = rows[0].count.has_value();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto at = [i](const char* key) { return fmt::format("zoom[{}].{}", i, key); };
    if (const std::string wrong =
            rows[i].distortion ? distortion_fault(config.model, *rows[i].distortion) : std::string();
        !wrong.empty())
      return Fault{at("distortion"), wrong};
    if (rows[i].count.has_value() != counts)
      return Fault{at("count"), "expected a count in all rows or in no row"};
    if (i == 0) continue;
    const Intrinsics before = lens_at(rows[i - 1], one), here = lens_at(rows[i], one);
    if (!(rows[i].ratio > rows[i - 1].ratio))
      return Fault{at("ratio"), "expected a ratio that increases from row to row"};
    if (!(here.fx > before.fx))
      return Fault{at("fx"), "expected focal lengths that increase from row to row"};
    if (!(here.fy > before.fy))
      return Fault{at("fy"), "expected focal lengths that increase from row to row"};
    if (counts && !((*rows[i].count - *rows[i - 1].count) * (*rows[1].count - *rows[0].count) > 0))
      return Fault{at("count"), "expected counts that increase in all rows or decrease in all rows"};
  }
  return std::nullopt;
}

ZoomTable::ZoomTable(const LensConfig& config, std::int64_t width, std::int64_t height)
    : one_(lens_at_one(config, width, height)) {
  if (const auto wrong = fault(config))
    throw std::invalid_argument("the lens's " + wrong->path + ": " + wrong->what);
  if (config.zoom.empty()) return;
  std::vector<ZoomRow> rows = config.zoom;
  by_count_ = rows.front().count.has_value();
  is_reversed_ = by_count_ && *rows.back().count < *rows.front().count;
  if (is_reversed_) std::ranges::reverse(rows);
  first_ = by_count_ ? *rows.front().count : rows.front().ratio;
  last_ = by_count_ ? *rows.back().count : rows.back().ratio;
  std::vector<double> x;
  std::vector<std::vector<double>> y(intrinsics_count + 1);
  for (const ZoomRow& row : rows) {
    x.push_back(by_count_ ? *row.count : std::log(row.ratio));
    const auto lens = numbers(lens_at(row, one_));
    for (int i = 0; i < intrinsics_count; ++i)
      y[static_cast<std::size_t>(i)].push_back(i < 2 ? std::log(lens[i]) : lens[i]);
    rows_.push_back(lens);
    rows_by_lens_.push_back(left_out(row));
    y[intrinsics_count].push_back(std::log(row.ratio));
  }
  for (const auto& values : y) curves_.emplace_back(x, values);
}

double ZoomTable::within(double zoom) const {
  constexpr double rounding = 1e-9;
  if (!(zoom >= first_ - rounding * std::abs(first_)) || zoom > last_ + rounding * std::abs(last_))
    throw std::out_of_range(fmt::format("zoom {:.9g} is outside {:.9g} to {:.9g}", zoom, first_, last_));
  return std::clamp(zoom, first_, last_);
}

double ZoomTable::abscissa(double zoom) const { return by_count_ ? zoom : std::log(zoom); }

Intrinsics ZoomTable::at(double zoom) const {
  zoom = within(zoom);
  if (is_linear()) return {one_.fx * zoom, one_.fy * zoom, one_.cx, one_.cy, one_.distortion};
  const double x = abscissa(zoom);
  Intrinsics result{std::exp(curves_[0].value(x)), std::exp(curves_[1].value(x)), curves_[2].value(x),
                    curves_[3].value(x), Distortion(one_.distortion.model())};
  for (std::size_t i = 0; i < result.distortion.size(); ++i) result.distortion[i] = curves_[4 + i].value(x);
  return result;
}

double ZoomTable::ratio(double zoom) const {
  zoom = within(zoom);
  return by_count_ ? std::exp(curves_[intrinsics_count].value(zoom)) : zoom;
}

double ZoomTable::ratio_slope(double zoom) const {
  return by_count_ ? ratio(zoom) * curves_[intrinsics_count].slope(within(zoom)) : 1;
}

Eigen::Vector<double, intrinsics_count> ZoomTable::by_row(double zoom, std::size_t row) const {
  const double x = abscissa(within(zoom));
  const std::size_t point = is_reversed_ ? rows_.size() - 1 - row : row;
  const auto lens = numbers(at(zoom));
  Eigen::Vector<double, intrinsics_count> result = Eigen::Vector<double, intrinsics_count>::Zero();
  for (int i = 0; i < one_.size(); ++i) {
    result[i] = curves_.at(static_cast<std::size_t>(i)).by_point(x, point);
    if (i < 2) result[i] *= lens[i] / rows_.at(point)[i];  // The curve interpolates the logarithm.
  }
  return result;
}

Eigen::Vector<double, intrinsics_count> ZoomTable::by_lens(double zoom) const {
  Eigen::Vector<double, intrinsics_count> result = Eigen::Vector<double, intrinsics_count>::Zero();
  if (is_linear()) {
    result.head(one_.size()).setOnes();
    result.head<2>().setConstant(within(zoom));
    return result;
  }
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    const auto& through_row = rows_by_lens_[is_reversed_ ? rows_.size() - 1 - row : row];
    if (!through_row.isZero(0)) result += by_row(zoom, row).cwiseProduct(through_row);
  }
  return result;
}

Eigen::Vector<double, intrinsics_count> ZoomTable::slope(double zoom) const {
  zoom = within(zoom);
  Eigen::Vector<double, intrinsics_count> result = Eigen::Vector<double, intrinsics_count>::Zero();
  if (is_linear()) {
    result.head<2>() << one_.fx, one_.fy;
    return result;
  }
  const double x = abscissa(zoom), x_slope = by_count_ ? 1 : 1 / zoom;
  for (int i = 0; i < one_.size(); ++i) result[i] = curves_[static_cast<std::size_t>(i)].slope(x) * x_slope;
  result[0] *= std::exp(curves_[0].value(x)), result[1] *= std::exp(curves_[1].value(x));
  return result;
}

}  // namespace flexura
