#include "flexura/campaign/row_text.h"

#include "flexura/store/json.h"

namespace flexura {

std::string row_text(const CampaignRow& row) {
  return write_json({Node::Array{{row.id, {}},
                                 {row.seed, {}},
                                 text_node(row.status),
                                 text_node(row.error),
                                 {row.seconds, {}},
                                 {Node::Array(row.parameters), {}},
                                 {Node::Array(row.measures), {}}},
                     {}});
}

CampaignRow row_of(std::string_view text) {
  const Node node = parse_json(text, "row");
  const Node::Array& values = *node.as<Node::Array>();
  return {.id = *values.at(0).as<std::int64_t>(),
          .seed = *values.at(1).as<std::int64_t>(),
          .parameters = *values.at(5).as<Node::Array>(),
          .status = *values.at(2).as<std::string>(),
          .error = *values.at(3).as<std::string>(),
          .measures = *values.at(6).as<Node::Array>(),
          .seconds = *values.at(4).as<double>()};
}

}  // namespace flexura
