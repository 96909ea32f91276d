#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "flexura/app/measure_job.h"
#include "flexura/base/source.h"
#include "flexura/base/table.h"
#include "flexura/vision/linear_light.h"

namespace flexura {

const std::vector<std::string>& names_of(const MeasureTarget*) {
  static const std::vector<std::string> names = {"arm", "etalon", "circle", "markers"};
  return names;
}

Measurement measure_picture(std::span<const std::uint8_t> file, const std::string& name,
                            const MeasureConfig& config, bool with_overlay) {
  Photograph photograph = decode_picture(file, name);
  if (config.camera)
    if (const auto other = config.camera->other_size(photograph.bytes.width(), photograph.bytes.height()))
      throw input_error(name, *other);
  std::optional<Canvas> canvas;
  if (with_overlay) canvas.emplace(photograph.bytes);
  const int bits = photograph.words.width() > 0 ? 16 : 8;
  photograph = linear_light(std::move(photograph), config.gamma);
  const Image<std::uint8_t> gray = gray_picture(photograph.bytes);
  TableMaker answer;
  const auto whole = [](int value) { return Node{static_cast<std::int64_t>(value), {}}; };
  answer.add("image", text_node(name))
      .add("what", text_node(name_of(config.what)))
      .add("size", {Node::Array{whole(gray.width()), whole(gray.height())}, {}})
      .add("channels", whole(photograph.bytes.channels()))
      .add("bits", whole(bits));
  const Job job{photograph, gray, config, answer, canvas ? &*canvas : nullptr};
  Measurement result;
  switch (config.what) {
    case MeasureTarget::arm:
    case MeasureTarget::markers:
      result.is_found = measure_arm(job);
      break;
    case MeasureTarget::etalon:
      result.is_found = measure_etalon(job);
      break;
    case MeasureTarget::circle:
      result.is_found = measure_circle(job);
      break;
  }
  result.answer = answer.take();
  if (canvas) result.overlay = canvas->picture();
  return result;
}

}  // namespace flexura
