#include "flexura/camera/distortion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>

#include "flexura/base/table.h"

namespace flexura {
namespace {

LensModel model_of(std::size_t coefficients) {
  for (const LensModel model : {LensModel::brown, LensModel::rational, LensModel::fisheye})
    if (Distortion::size_of(model) == coefficients) return model;
  throw std::invalid_argument(fmt::format(
      "{} distortion coefficients: expected 5 (brown), 8 (rational) or 4 (fisheye)", coefficients));
}

}  // namespace

const std::vector<std::string>& names_of(const LensModel*) {
  static const std::vector<std::string> names{"brown", "rational", "fisheye"};
  return names;
}

const std::vector<std::string>& coefficient_names(LensModel model) {
  static const std::array<std::vector<std::string>, 3> names = {
      {{"k1", "k2", "p1", "p2", "k3"},
       {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"},
       {"k1", "k2", "k3", "k4"}}};
  return names[static_cast<std::size_t>(model)];
}

Distortion::Distortion(std::initializer_list<double> coefficients) : model_(model_of(coefficients.size())) {
  std::ranges::copy(coefficients, values_.begin());
}

Distortion::Distortion(const std::vector<double>& coefficients) : model_(model_of(coefficients.size())) {
  std::ranges::copy(coefficients, values_.begin());
}

std::string distortion_fault(LensModel model, const Distortion& coefficients) {
  if (coefficients.model() == model || std::ranges::all_of(coefficients, [](double k) { return k == 0; }))
    return "";
  return fmt::format("{} coefficients for the lens model {}: expected {} ({})", coefficients.size(),
                     name_of(model), Distortion::size_of(model), fmt::join(coefficient_names(model), ", "));
}

Distortion distortion_of(LensModel model, const Distortion& coefficients) {
  if (coefficients.model() == model) return coefficients;
  if (const std::string wrong = distortion_fault(model, coefficients); !wrong.empty())
    throw std::invalid_argument("the distortion has " + wrong);
  return Distortion(model);
}

Type Codec<Distortion>::type() {
  return {.kind = Type::Kind::array, .item = std::make_shared<const Type>(Codec<double>::type())};
}

bool Codec<Distortion>::read(const Node& node, const Spec& spec, Reader& reader, Distortion& value) {
  std::vector<double> numbers;
  const auto* entries = node.as<Node::Array>();
  if (entries == nullptr || (entries->size() != 4 && entries->size() != 5 && entries->size() != 8)) {
    reader.unexpected(node, "5 numbers (lens model brown), 8 (rational) or 4 (fisheye)");
    return false;
  }
  if (!Codec<std::vector<double>>::read(node, spec, reader, numbers)) return false;
  value = Distortion(numbers);
  return true;
}

Node Codec<Distortion>::write(const Distortion& value) { return codec_detail::write_entries(value); }

}  // namespace flexura
