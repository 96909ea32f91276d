#pragma once

#include <string_view>

#include "flexura/view/session.h"

namespace flexura {

/// Returns the document that an address requests: "/image/CAMERA.png[?time=T]", "/series?names=a,b&points=N",
/// or "/report". Throws ViewRefusal for any other address.
[[nodiscard]] Document read_document(std::string_view text);

}  // namespace flexura
