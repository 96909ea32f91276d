// Any bytes as a message and as an address: always a request or one line of error, never anything else.
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <variant>

#include "flexura/store/json.h"
#include "flexura/view/document.h"
#include "flexura/view/request.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const flexura::Request request = flexura::read_request(text);
  if (request.error.find('\n') != std::string::npos) std::abort();
  const bool may_lack_id = std::holds_alternative<flexura::AckRequest>(request.ask);
  if (request.error.empty() && !request.id && !may_lack_id) std::abort();
  // The content of a reply must be valid JSON.
  const flexura::Node reply{flexura::Node::Table{{"error", {}, {request.error, {}}}}, {}};
  (void)flexura::parse_json(flexura::write_json(reply), "reply");
  try {
    (void)flexura::read_document(text);
  } catch (const flexura::ViewRefusal& refusal) {
    if (std::string_view(refusal.what()).empty()) std::abort();
  }
  return 0;
}
