#pragma once

#include <string_view>

#include "flexura/view/session.h"

namespace flexura {

/// Returns the document requested by an address: "/image/CAMERA.png[?time=T]", "/series?names=a,b&points=N",
/// or "/report". Throws ViewRefusal for any other address, and nothing else that depends on the address.
[[nodiscard]] Document read_document(std::string_view text);

}  // namespace flexura
