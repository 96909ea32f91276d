#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "flexura/app/measure_job.h"
#include "flexura/vision/etalon_finder.h"

namespace flexura {
namespace {

Node line_node(const UprightLine& line) {
  return TableMaker()
      .add("u", number_node(px(line.at)))
      .add("slope", number_node(rounded(line.slope, 1e7)))
      .add("rms", number_node(line.rms))
      .take();
}

}  // namespace

bool measure_etalon(const Job& job) {
  const EtalonObservation seen = find_etalon(job.photograph.bytes, job.gray, job.config.finder.threshold);
  add_threshold(seen.threshold, job.answer);
  job.answer.add("found", {seen.reason.empty(), {}});
  if (!seen.reason.empty()) {
    job.answer.add("reason", text_node(seen.reason));
    return false;
  }
  Node::Array lines;
  for (const UprightLine& line : seen.lines) {
    Node node = line_node(line);
    const double middle = seen.middle(seen.middle_row);
    node.as<Node::Table>()->push_back({"offset", {}, number_node(px(line.at - middle))});
    lines.push_back(std::move(node));
  }
  std::vector<std::string> notes;
  if (seen.touches_border) notes.emplace_back("the picture's border cuts the cylinder");
  if (seen.lines.empty()) notes.emplace_back("no red line is visible");
  job.answer.add("notes", texts_node(notes))
      .add("rows", {Node::Array{{static_cast<std::int64_t>(seen.top), {}},
                                {static_cast<std::int64_t>(seen.bottom), {}}},
                    {}})
      .add("middle", pixel_pair({seen.middle(seen.middle_row), seen.middle_row}))
      .add("left", line_node(seen.left))
      .add("right", line_node(seen.right))
      .add("width_above", number_node(px(seen.width_above)))
      .add("width_below", number_node(px(seen.width_below)))
      .add("lines", {std::move(lines), {}});
  if (job.canvas != nullptr) {
    const auto draw = [&](const UprightLine& line, const PenColor& color) {
      const double above = seen.top - seen.middle_row, below = seen.bottom - seen.middle_row;
      job.canvas->line({line.at + line.slope * above, seen.top}, {line.at + line.slope * below, seen.bottom},
                       color);
    };
    draw(seen.left, border_color), draw(seen.right, border_color);
    for (const UprightLine& line : seen.lines) draw(line, marker_color);
  }
  return true;
}

}  // namespace flexura
