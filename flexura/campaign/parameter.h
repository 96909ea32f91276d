#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/base/node.h"

namespace flexura {

/// The value of the experiment file that a parameter changes.
struct ParameterPlace {
  std::string path;               ///< As in `--set`: "arm.section.0.length_mm".
  std::vector<std::string> also;  ///< Further paths that get the same value.
  std::string name;               ///< Name of the column in the results; "": the path.
  bool offset = false;            ///< Whether the number is added to the value in the experiment file.

  [[nodiscard]] const std::string& label() const { return name.empty() ? path : name; }
};

/// A number that is uniformly distributed.
struct UniformParameter : ParameterPlace {
  double low = 0, high = 1;
};
/// A positive number whose logarithm is uniformly distributed.
struct LogUniformParameter : ParameterPlace {
  double low = 1, high = 10;
};
/// A normally distributed number. Bounds cut the distribution off.
struct NormalParameter : ParameterPlace {
  double mean = 0, sigma = 1;
  std::optional<double> low, high;
};
/// A whole number, uniformly distributed; both bounds are included.
struct IntegerParameter : ParameterPlace {
  std::int64_t low = 0, high = 1;
};
/// Evenly spaced numbers, combined with the values of other grids and lists.
struct GridParameter : ParameterPlace {
  double low = 0, high = 1;
  std::int64_t count = 2;
  bool logarithmic = false;
};
/// Given numbers, combined with the values of other grids and lists.
struct ListParameter : ParameterPlace {
  std::vector<double> values;
  bool drawn = false;  ///< Whether a sample draws one value; otherwise all are combined.
};
/// Given values of any type, combined with the values of other grids and lists.
struct ChoiceParameter : ParameterPlace {
  std::vector<std::string> choices;  ///< Each as the VALUE of `--set PATH=VALUE`.
  bool drawn = false;                ///< Whether a sample draws one choice; otherwise all are combined.
};

/// A parameter of a campaign.
using ParameterConfig = std::variant<UniformParameter, LogUniformParameter, NormalParameter, IntegerParameter,
                                     GridParameter, ListParameter, ChoiceParameter>;

const Table<UniformParameter>& fields_of(const UniformParameter*);
const Table<LogUniformParameter>& fields_of(const LogUniformParameter*);
const Table<NormalParameter>& fields_of(const NormalParameter*);
const Table<IntegerParameter>& fields_of(const IntegerParameter*);
const Table<GridParameter>& fields_of(const GridParameter*);
const Table<ListParameter>& fields_of(const ListParameter*);
const Table<ChoiceParameter>& fields_of(const ChoiceParameter*);

[[nodiscard]] const ParameterPlace& place_of(const ParameterConfig& parameter);

/// Returns the number of values of a grid, list or choice that is combined; 0 for a distribution, also for
/// values that are drawn.
[[nodiscard]] std::size_t grid_size(const ParameterConfig& parameter);

/// Returns value `index` of a grid, list or choice.
[[nodiscard]] Node grid_value(const ParameterConfig& parameter, std::size_t index);

/// Returns the quantile of a distribution, or the value that is drawn, for the probability `u`, above 0 and
/// below 1.
[[nodiscard]] Node quantile(const ParameterConfig& parameter, double u);

/// Returns the quantile of the standard normal distribution for the probability `p`, above 0 and below 1, to
/// a relative error of about 1e-15.
[[nodiscard]] double normal_quantile(double p);

}  // namespace flexura
