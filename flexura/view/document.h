#pragma once

#include <string_view>

#include "flexura/view/session.h"

namespace flexura {

/// The document that an address asks for: "/image/CAMERA.png[?time=T]", "/series?names=a,b&points=N",
/// "/report". A ViewRefusal for any other. Never throws anything else on account of the address.
[[nodiscard]] Document read_document(std::string_view text);

}  // namespace flexura
