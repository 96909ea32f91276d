#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/base/names.h"

namespace flexura {

/// Model of a lens. Its coefficients and their order are those of OpenCV (docs/cameras.md).
/// `brown`: Brown-Conrady distortion, k1, k2, p1, p2, k3. `rational`: k1, k2, p1, p2, k3, k4, k5, k6.
/// `fisheye`: equidistant projection, k1, k2, k3, k4.
enum class LensModel { brown, rational, fisheye };

const std::vector<std::string>& names_of(const LensModel*);

/// Distortion of a lens: the coefficients of its model. Their number determines the model.
class Distortion {
 public:
  static constexpr std::size_t most = 8;  ///< Largest number of coefficients.

  /// The model `brown` without distortion.
  Distortion() = default;
  /// Five, eight or four coefficients, of the models `brown`, `rational` and `fisheye`. Throws
  /// std::invalid_argument for another number.
  Distortion(std::initializer_list<double> coefficients);
  explicit Distortion(const std::vector<double>& coefficients);
  /// A model with all coefficients 0.
  explicit Distortion(LensModel model) : model_(model) {}

  [[nodiscard]] LensModel model() const { return model_; }
  /// Returns whether a lens with this distortion is a pinhole. A fisheye lens never is.
  [[nodiscard]] bool is_none() const { return model_ != LensModel::fisheye && values_ == Values{}; }

  /// Returns the number of coefficients of the model.
  [[nodiscard]] std::size_t size() const { return size_of(model_); }
  /// Returns the number of coefficients of a model.
  [[nodiscard]] static constexpr std::size_t size_of(LensModel model) {
    constexpr std::array<std::size_t, 3> sizes = {5, 8, 4};
    return sizes[static_cast<std::size_t>(model)];
  }
  /// Returns a coefficient. Coefficients from size() up to `most` exist, too; they must be 0.
  [[nodiscard]] double operator[](std::size_t i) const { return values_[i]; }
  [[nodiscard]] double& operator[](std::size_t i) { return values_[i]; }
  /// The coefficients of the model, size() of them.
  [[nodiscard]] const double* begin() const { return values_.data(); }
  /// Behind the last coefficient of the model.
  [[nodiscard]] const double* end() const { return values_.data() + size(); }
  [[nodiscard]] double* begin() { return values_.data(); }
  [[nodiscard]] double* end() { return values_.data() + size(); }
  /// Returns `most` numbers: the coefficients and zeros.
  [[nodiscard]] const double* data() const { return values_.data(); }

  bool operator==(const Distortion&) const = default;

 private:
  using Values = std::array<double, most>;

  Values values_ = {};
  LensModel model_ = LensModel::brown;
};

/// Returns the names of a model's coefficients, in order.
[[nodiscard]] const std::vector<std::string>& coefficient_names(LensModel model);

/// Returns an error text if a file's coefficients are not those of its lens model; "" if they are. Zeros fit
/// every model.
[[nodiscard]] std::string distortion_fault(LensModel model, const Distortion& coefficients);
/// Returns the distortion of a lens in a file: the coefficients, or the model without distortion if they are
/// zeros. Throws std::invalid_argument if distortion_fault() finds an error.
[[nodiscard]] Distortion distortion_of(LensModel model, const Distortion& coefficients);

/// Codec of distortion coefficients, which in a file are an array of four, five or eight numbers.
template <>
struct Codec<Distortion> {
  static Type type();
  static bool read(const Node& node, const Spec& spec, Reader& reader, Distortion& value);
  static Node write(const Distortion& value);
};

}  // namespace flexura
