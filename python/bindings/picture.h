#pragma once

#include "flexura/base/image.h"
#include "python/bindings/convert.h"

namespace flexura::python {

/// Returns an array that owns the picture's values, without a copy: shape (height, width), or (height, width,
/// channels) for several channels.
template <class Value>
[[nodiscard]] py::array picture_array(Image<Value> picture) {
  auto owned = std::make_unique<Image<Value>>(std::move(picture));
  Image<Value>& image = *owned;
  const py::capsule owner(owned.release(), [](void* held) { delete static_cast<Image<Value>*>(held); });
  Sizes sizes{image.height(), image.width()};
  if (image.channels() > 1) sizes.push_back(image.channels());
  return py::array_t<Value>(sizes, image.values().data(), owner);
}

/// Returns a copy of an array of shape (height, width) or (height, width, 3) as a picture. Throws
/// py::value_error for another shape.
template <class Value>
[[nodiscard]] Image<Value> picture_of(const py::array_t<Value, py::array::c_style>& array) {
  const bool is_color = array.ndim() == 3 && array.shape(2) == 3;
  if (array.ndim() != 2 && !is_color)
    throw py::value_error("picture: expected an array of shape (height, width) or (height, width, 3)");
  if (array.size() == 0) throw py::value_error("picture: has no pixels");
  Image<Value> picture(static_cast<int>(array.shape(1)), static_cast<int>(array.shape(0)), is_color ? 3 : 1);
  std::copy_n(array.data(), array.size(), picture.values().data());
  return picture;
}

/// Returns a picture of 8 or 16 bits from an array of uint8 or uint16. Throws py::type_error for other types.
[[nodiscard]] Picture picture_from(const py::array& array);

}  // namespace flexura::python
