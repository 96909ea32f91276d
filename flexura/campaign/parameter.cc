#include "flexura/campaign/parameter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <type_traits>

#include "flexura/base/table.h"
#include "flexura/store/toml.h"

namespace flexura {
namespace {

constexpr std::size_t most_values = 100000, most_paths = 1000;
constexpr const char* meaning_of_drawn =
    "Whether each sample draws one of the values, all equally probable. Otherwise all values are combined "
    "with "
    "those of other grids, lists and choices.";

// Returns the table `kind` with the fields of the place.
template <class P>
Table<P> table_of(const char* kind, const char* meaning) {
  return Table<P>(kind, meaning)
      .field("path", &P::path,
             {.meaning = "Value of the experiment file to change, as in `--set`: "
                         "`arm.section.0.length_mm`. Indices count from 0. Lists in braces make one "
                         "parameter per text: `arm.section.{0,1}.length_mm`.",
              .required = true})
      .field("also", &P::also,
             {.meaning = "Further values of the experiment file that get the same value.",
              .count = {0, most_paths},
              .default_text = "none"})
      .field("name", &P::name,
             {.meaning = "Name of the parameter's column in the results, with lists in braces as in `path`.",
              .default_text = "the path"})
      .field(
          "offset", &P::offset,
          {.meaning = "Whether the number is added to the value in the experiment file. The file must then "
                      "contain this value. The column has the number that is added."});
}

template <class P>
void check_bounds(const P& parameter, Reader& reader) {
  if (parameter.low > parameter.high)
    reader.problem_at(
        "high", fmt::format("{:.6g}: expected at least `low`, {:.6g}", static_cast<double>(parameter.high),
                            static_cast<double>(parameter.low)));
}

double normal_probability(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

// Returns the quantile of the lower half, p <= 0.5.
double lower_quantile(double p) {
  // The start is formula 26.2.23 of M. Abramowitz, I. Stegun, Handbook of Mathematical Functions.
  const double t = std::sqrt(-2 * std::log(p));
  double x = -(t - (2.515517 + t * (0.802853 + t * 0.010328)) /
                       (1 + t * (1.432788 + t * (0.189269 + t * 0.001308))));
  for (int i = 0; i < 3; ++i) {  // Halley's steps on the logarithm's scale: the error is relative to p.
    const double density = std::exp(-0.5 * x * x) / std::sqrt(2 * std::numbers::pi);
    const double step = (normal_probability(x) - p) / density;
    x -= step / (1 + 0.5 * x * step);
  }
  return x;
}

double truncated(const NormalParameter& normal, double u) {
  const auto probability = [&](const std::optional<double>& bound, double without) {
    return bound ? normal_probability((*bound - normal.mean) / normal.sigma) : without;
  };
  const double from = probability(normal.low, 0), to = probability(normal.high, 1);
  const double least = std::numeric_limits<double>::min(), most = 1 - 0x1p-53;
  const double p = std::clamp(from + (to - from) * u, least, most);
  const double infinity = std::numeric_limits<double>::infinity();
  return std::clamp(normal.mean + normal.sigma * normal_quantile(p), normal.low.value_or(-infinity),
                    normal.high.value_or(infinity));
}

// Whole numbers are written as such, because some fields accept only these.
Node listed_number(double value) {
  constexpr double exact = 0x1p53;
  if (value == std::floor(value) && std::abs(value) < exact) return {static_cast<std::int64_t>(value), {}};
  return {value, {}};
}

// Returns the index of one of `count` equally probable values.
std::size_t drawn_index(std::size_t count, double u) {
  return std::min(count - 1, static_cast<std::size_t>(std::floor(static_cast<double>(count) * u)));
}

}  // namespace

double normal_quantile(double p) { return p <= 0.5 ? lower_quantile(p) : -lower_quantile(1 - p); }

const Table<UniformParameter>& fields_of(const UniformParameter*) {
  using P = UniformParameter;
  static const auto table =
      table_of<P>("uniform", "A number that is uniformly distributed.")
          .field("low", &P::low, {.meaning = "Lower bound, in the unit of `path`.", .required = true})
          .field("high", &P::high, {.meaning = "Upper bound.", .required = true})
          .check(check_bounds<P>);
  return table;
}

const Table<LogUniformParameter>& fields_of(const LogUniformParameter*) {
  using P = LogUniformParameter;
  static const auto table =
      table_of<P>("log_uniform", "A positive number whose logarithm is uniformly distributed.")
          .field("low", &P::low, {.meaning = "Lower bound.", .range = above(0), .required = true})
          .field("high", &P::high, {.meaning = "Upper bound.", .range = above(0), .required = true})
          .check(check_bounds<P>);
  return table;
}

const Table<NormalParameter>& fields_of(const NormalParameter*) {
  using P = NormalParameter;
  static const auto table =
      table_of<P>("normal", "A normally distributed number.")
          .field("mean", &P::mean, {.meaning = "Mean of the distribution without bounds.", .required = true})
          .field(
              "sigma", &P::sigma,
              {.meaning = "Standard deviation, before bounds cut off.", .range = above(0), .required = true})
          .field("low", &P::low,
                 {.meaning = "Bound below which the distribution is cut off.", .default_text = "none"})
          .field("high", &P::high,
                 {.meaning = "Bound above which the distribution is cut off.", .default_text = "none"})
          .check([](const P& normal, Reader& reader) {
            if (normal.low && normal.high && *normal.low > *normal.high)
              reader.problem_at(
                  "high", fmt::format("{:.6g}: expected at least `low`, {:.6g}", *normal.high, *normal.low));
          });
  return table;
}

const Table<IntegerParameter>& fields_of(const IntegerParameter*) {
  using P = IntegerParameter;
  constexpr NumberRange range = {.min = -1e15, .max = 1e15};
  static const auto table =
      table_of<P>("integer", "A whole number that is uniformly distributed.")
          .field("low", &P::low, {.meaning = "Smallest number.", .range = range, .required = true})
          .field("high", &P::high, {.meaning = "Largest number.", .range = range, .required = true})
          .check(check_bounds<P>);
  return table;
}

const Table<GridParameter>& fields_of(const GridParameter*) {
  using P = GridParameter;
  static const auto table =
      table_of<P>("grid",
                  "Evenly spaced numbers. The campaign runs every combination of the values of grids, lists "
                  "and choices.")
          .field("low", &P::low, {.meaning = "First value.", .required = true})
          .field("high", &P::high, {.meaning = "Last value.", .required = true})
          .field("count", &P::count,
                 {.meaning = "Number of values.", .range = between(2, most_values), .required = true})
          .field("logarithmic", &P::logarithmic,
                 {.meaning = "Whether the logarithms of the values are evenly spaced; the values must then "
                             "be above 0."})
          .check([](const P& grid, Reader& reader) {
            check_bounds(grid, reader);
            if (grid.logarithmic && grid.low <= 0)
              reader.problem_at("low", fmt::format("{:.6g}: expected above 0, because the grid is "
                                                   "logarithmic",
                                                   grid.low));
          });
  return table;
}

const Table<ListParameter>& fields_of(const ListParameter*) {
  using P = ListParameter;
  static const auto table =
      table_of<P>("list", "Given numbers.")
          .field("values", &P::values,
                 {.meaning = "The numbers.", .count = {1, most_values}, .required = true})
          .field("drawn", &P::drawn, {.meaning = meaning_of_drawn});
  return table;
}

const Table<ChoiceParameter>& fields_of(const ChoiceParameter*) {
  using P = ChoiceParameter;
  static const auto table =
      table_of<P>("choice", "Given values of any type.")
          .field("choices", &P::choices,
                 {.meaning = "The values, each a text as the VALUE of `--set PATH=VALUE`: `\"shape\"`, "
                             "`\"true\"`, `\"[[30, 0], [0, 90]]\"`.",
                  .count = {1, most_values},
                  .required = true})
          .field("drawn", &P::drawn, {.meaning = meaning_of_drawn})
          .check([](const P& choice, Reader& reader) {
            for (std::size_t i = 0; i < choice.choices.size(); ++i) {
              try {
                (void)parse_toml_value(choice.choices[i], "choice", 1, 1);
              } catch (const InputError& error) {
                reader.problem_at(fmt::format("choices[{}]", i), error.problems().front().what);
              }
            }
          });
  return table;
}

const ParameterPlace& place_of(const ParameterConfig& parameter) {
  return std::visit([](const auto& one) -> const ParameterPlace& { return one; }, parameter);
}

std::size_t grid_size(const ParameterConfig& parameter) {
  if (const auto* grid = std::get_if<GridParameter>(&parameter)) return static_cast<std::size_t>(grid->count);
  if (const auto* list = std::get_if<ListParameter>(&parameter)) return list->drawn ? 0 : list->values.size();
  if (const auto* choice = std::get_if<ChoiceParameter>(&parameter))
    return choice->drawn ? 0 : choice->choices.size();
  return 0;
}

Node grid_value(const ParameterConfig& parameter, std::size_t index) {
  if (const auto* list = std::get_if<ListParameter>(&parameter)) return listed_number(list->values.at(index));
  if (const auto* choice = std::get_if<ChoiceParameter>(&parameter))
    return parse_toml_value(choice->choices.at(index), "choice", 1, 1);
  const auto& grid = std::get<GridParameter>(parameter);
  const auto last = static_cast<std::size_t>(grid.count) - 1;
  if (index == last) return listed_number(grid.high);
  const double share = static_cast<double>(index) / static_cast<double>(last);
  const double value = grid.logarithmic && index > 0 ? grid.low * std::pow(grid.high / grid.low, share)
                                                     : grid.low + (grid.high - grid.low) * share;
  return listed_number(value);
}

Node quantile(const ParameterConfig& parameter, double u) {
  return std::visit(
      [u](const auto& one) -> Node {
        using P = std::decay_t<decltype(one)>;
        if constexpr (std::is_same_v<P, UniformParameter>) {
          return {std::min(one.low + (one.high - one.low) * u, one.high), {}};
        } else if constexpr (std::is_same_v<P, LogUniformParameter>) {
          return {std::clamp(one.low * std::pow(one.high / one.low, u), one.low, one.high), {}};
        } else if constexpr (std::is_same_v<P, NormalParameter>) {
          return {truncated(one, u), {}};
        } else if constexpr (std::is_same_v<P, IntegerParameter>) {
          const auto count = static_cast<double>(one.high - one.low) + 1;
          return {std::min(one.low + static_cast<std::int64_t>(std::floor(count * u)), one.high), {}};
        } else if constexpr (std::is_same_v<P, ListParameter>) {
          return listed_number(one.values.at(drawn_index(one.values.size(), u)));
        } else if constexpr (std::is_same_v<P, ChoiceParameter>) {
          return parse_toml_value(one.choices.at(drawn_index(one.choices.size(), u)), "choice", 1, 1);
        } else {
          throw std::invalid_argument("a grid has no quantiles");
        }
      },
      parameter);
}

}  // namespace flexura
