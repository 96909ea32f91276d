#include "flexura/view/request.h"

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>
#include <utility>

#include "flexura/base/problems.h"
#include "flexura/base/table.h"
#include "flexura/store/json.h"
#include "flexura/view/arm_layers.h"

namespace flexura {

template <>
struct Codec<FileText> {
  static Type type() { return {.kind = Type::Kind::text}; }
  static bool read(const Node& node, const Spec& /*spec*/, Reader& reader, FileText& value) {
    const auto* written = node.as<std::string>();
    if (written == nullptr) return reader.unexpected(node, "a text in quotes"), false;
    value.content = *written;
    return true;
  }
  static Node write(const FileText& value) { return {value.content, {}}; }
};

namespace {

// Larger than any arm and any run, in m and s; keeps sums of squares finite.
constexpr double farthest = 1e9;
constexpr std::size_t most_sections = 10000;
const NumberRange any_place = between(-farthest, farthest);
constexpr const char* speed_meaning = "speed relative to real time; 0: as fast as possible";
constexpr const char* seeing_meaning = "what separates the arm from its surroundings, by camera";
constexpr std::size_t most_cameras = 255;
const NumberRange speed_range = between(0, 1000);

template <class S>
Table<S> with_shape(const char* name, const char* meaning) {
  return Table<S>(name, meaning)
      .field("bends", static_cast<decltype(ShapeConfig::bends) S::*>(&S::bends),
             {.meaning = "bend vectors", .range = bend_range, .count = {0, most_sections}})
      .field("cord_angles", static_cast<decltype(ShapeConfig::cord_angles) S::*>(&S::cord_angles),
             {.meaning = "cords' angles from +X", .range = angle_range, .count = {0, most_sections}})
      .field("archings", static_cast<decltype(ShapeConfig::archings) S::*>(&S::archings),
             {.meaning = "archings", .range = arching_range, .count = {0, most_sections}})
      .field("stretches", static_cast<decltype(ShapeConfig::stretches) S::*>(&S::stretches),
             {.meaning = "factors on the sections' lengths",
              .range = above_up_to(0, 100),
              .count = {0, most_sections}});
}

// Returns the table of a request without fields.
template <class S>
const Table<S>& bare(const char* name) {
  static const Table<S> table(name, "");
  return table;
}

bool is_text(std::string_view text, std::size_t most) { return !text.empty() && text.size() <= most; }

void check_camera(const std::string& camera, Reader& reader) {
  if (!is_text(camera, 1000)) reader.problem_at("camera", "expected a camera's name");
}

// Fills `request.ask` if its `do` is the name of S.
template <class S>
bool read_if(std::string_view name, const Node& document, Reader& reader, Ask& ask) {
  const Table<S>& table = fields_of(static_cast<const S*>(nullptr));
  if (table.info().name != name) return false;
  S value;
  table.read(document, reader, value);
  ask = std::move(value);
  return true;
}

template <class... S>
bool read_ask(std::string_view name, const Node& document, Reader& reader, std::variant<S...>& ask) {
  return (read_if<S>(name, document, reader, ask) || ...);
}

template <class... S>
std::vector<std::string> all_names(const std::variant<S...>*) {
  return {fields_of(static_cast<const S*>(nullptr)).info().name...};
}

// Removes a member from a table and returns it.
Node taken(Node::Table& table, std::string_view key) {
  const auto found = std::ranges::find(table, key, &Node::Member::key);
  if (found == table.end()) return {};
  Node node = std::move(found->node);
  table.erase(found);
  return node;
}

std::string read(Node document, Request& request) {
  auto* table = document.as<Node::Table>();
  if (table == nullptr) return "expected a JSON object";
  const Node id = taken(*table, "id");
  constexpr std::int64_t largest = std::int64_t{1} << 53;
  if (const auto* number = id.as<std::int64_t>(); number != nullptr && std::abs(*number) <= largest)
    request.id = *number;
  const Node name = taken(*table, "do");
  const auto* text = name.as<std::string>();
  if (name.empty()) return "do is missing: expected a command";
  if (text == nullptr) return fmt::format("do = {}: expected a command in quotes", name.brief());
  if (!request.id && !id.empty())
    return fmt::format("id = {}: expected a whole number from -2^53 to 2^53", id.brief());
  if (!request.id && *text != "ack") return "id is missing: expected a whole number";
  Reader reader;
  if (!read_ask(*text, document, reader, request.ask)) {
    const auto names = all_names(static_cast<const Ask*>(nullptr));
    return fmt::format("do = {}: expected one of {}", name.brief(), fmt::join(names, ", "));
  }
  return joined(reader.problems());
}

}  // namespace

const Table<ArmRequest>& fields_of(const ArmRequest*) {
  static const auto table =
      with_shape<ArmRequest>("arm", "Moves the arm to a shape.")
          .field("tendons", &ArmRequest::tendons,
                 {.meaning = "displacements", .range = any_place, .count = {0, most_sections}})
          .field("duration", &ArmRequest::duration, {.meaning = "s", .range = between(0, 1e6)})
          .check([](const ArmRequest& arm, Reader& reader) {
            if (arm.tendons && (arm.bends || arm.cord_angles || arm.archings || arm.stretches))
              reader.problem_at("tendons", "are given together with another shape: expected only tendons");
            if (!arm.tendons && !arm.bends && !arm.cord_angles && !arm.archings && !arm.stretches)
              reader.problem("has no shape: expected bends, cord_angles, archings, tendons or stretches");
          });
  return table;
}

const Table<TipRequest>& fields_of(const TipRequest*) {
  static const auto table =
      Table<TipRequest>("tip", "Moves the tip to a position.")
          .field("position", &TipRequest::position,
                 {.meaning = "position of the tip", .range = any_place, .required = true})
          .field("direction", &TipRequest::direction,
                 {.meaning = "direction of the tip's z axis", .range = any_place})
          .check([](const TipRequest& tip, Reader& reader) {
            if (tip.direction && *tip.direction == std::array<double, 3>{})
              reader.problem_at("direction", "is zero: expected a vector other than zero");
          });
  return table;
}

const Table<HeadRequest>& fields_of(const HeadRequest*) {
  static const auto table =
      Table<HeadRequest>("head", "Turns and zooms a camera.")
          .field("camera", &HeadRequest::camera, {.required = true})
          .field("pan", &HeadRequest::pan, {.range = angle_range})
          .field("tilt", &HeadRequest::tilt, {.range = angle_range})
          .field("zoom", &HeadRequest::zoom, {.range = any_place})
          .check([](const HeadRequest& head, Reader& reader) { check_camera(head.camera, reader); });
  return table;
}

const Table<StageRequest>& fields_of(const StageRequest*) {
  static const auto table =
      Table<StageRequest>("stage", "Moves a camera's stage to a position.")
          .field("camera", &StageRequest::camera, {.required = true})
          .field("x", &StageRequest::x, {.range = any_place})
          .field("y", &StageRequest::y, {.range = any_place})
          .field("z", &StageRequest::z, {.range = any_place})
          .check([](const StageRequest& stage, Reader& reader) { check_camera(stage.camera, reader); });
  return table;
}

const Table<HaltRequest>& fields_of(const HaltRequest*) { return bare<HaltRequest>("halt"); }
const Table<ResetRequest>& fields_of(const ResetRequest*) { return bare<ResetRequest>("reset"); }
const Table<WeightRequest>& fields_of(const WeightRequest*) {
  static const auto table =
      Table<WeightRequest>("weight", "Switches weight and loads of the simulated arm on or off.")
          .field("on", &WeightRequest::on, {.required = true});
  return table;
}
const Table<PushRequest>& fields_of(const PushRequest*) {
  static const auto table =
      Table<PushRequest>("push", "Pushes the simulated arm at a point.")
          .field("s", &PushRequest::s, {.meaning = "m", .range = between(0, farthest), .required = true})
          .field("to", &PushRequest::to,
                 {.meaning = "point to which a spring pulls the arm, m", .range = any_place})
          .field("force", &PushRequest::force, {.meaning = "N", .range = any_place})
          .field("stiffness", &PushRequest::stiffness,
                 {.meaning = "stiffness of the spring, N/m", .range = above_up_to(0, farthest)})
          .check([](const PushRequest& push, Reader& reader) {
            if (push.to.has_value() == push.force.has_value())
              reader.problem("expected one of to (end of a spring) and force");
            if (push.force && push.stiffness)
              reader.problem_at("stiffness",
                                "applies only to a spring (to): expected no stiffness with force");
          });
  return table;
}
const Table<ReleaseRequest>& fields_of(const ReleaseRequest*) { return bare<ReleaseRequest>("release"); }
const Table<RunRequest>& fields_of(const RunRequest*) {
  static const auto table =
      Table<RunRequest>("run", "Runs the experiment's tasks.")
          .field("task", &RunRequest::task,
                 {.meaning = "index of the only task to run, from 0", .range = between(0, farthest)})
          .field("speed", &RunRequest::speed, {.meaning = speed_meaning, .range = speed_range})
          .field("seeing", &RunRequest::seeing, {.meaning = seeing_meaning, .count = {0, most_cameras}});
  return table;
}
const Table<SpeedRequest>& fields_of(const SpeedRequest*) {
  static const auto table = Table<SpeedRequest>("speed", "Changes the speed of a run of tasks.")
                                .field("speed", &SpeedRequest::speed,
                                       {.meaning = speed_meaning, .range = speed_range, .required = true});
  return table;
}
const Table<CancelRequest>& fields_of(const CancelRequest*) { return bare<CancelRequest>("cancel"); }
const Table<OpenRequest>& fields_of(const OpenRequest*) {
  static const auto table =
      Table<OpenRequest>("open", "Opens the recording of the last run, or an example.")
          .field("example", &OpenRequest::example, {.meaning = "The name of one of the viewer's examples."});
  return table;
}
const Table<LiveRequest>& fields_of(const LiveRequest*) { return bare<LiveRequest>("live"); }
const Table<PingRequest>& fields_of(const PingRequest*) { return bare<PingRequest>("ping"); }

const Table<BranchRequest>& fields_of(const BranchRequest*) {
  static const auto table =
      Table<BranchRequest>("branch", "Opens a live rig that starts in a state of the recording.")
          .field("time", &BranchRequest::time, {.meaning = "s", .range = any_place, .required = true});
  return table;
}

const Table<ExperimentRequest>& fields_of(const ExperimentRequest*) {
  static const auto table =
      Table<ExperimentRequest>("experiment", "Requests the text of the experiment.")
          .field("add", &ExperimentRequest::add,
                 {.meaning = "part of the shown state that is added to the text"})
          .field("camera", &ExperimentRequest::camera, {.meaning = "camera whose view is added"})
          .check([](const ExperimentRequest& experiment, Reader& reader) {
            const bool is_view = experiment.add == "view";
            if (experiment.add && !is_view && experiment.add != "pose")
              reader.problem_at("add", fmt::format("= {}: expected \"pose\" or \"view\"",
                                                   Node{*experiment.add, {}}.brief()));
            if (is_view != experiment.camera.has_value())
              reader.problem_at("camera", "expected a camera's name if, and only if, add = \"view\"");
            if (experiment.camera) check_camera(*experiment.camera, reader);
          });
  return table;
}

const Table<CheckRequest>& fields_of(const CheckRequest*) {
  static const auto table = Table<CheckRequest>("check", "Checks a text as an experiment file.")
                                .field("text", &CheckRequest::text, {.required = true});
  return table;
}

const Table<SaveRequest>& fields_of(const SaveRequest*) {
  static const auto table = Table<SaveRequest>("save", "Saves a text as a new experiment file.")
                                .field("text", &SaveRequest::text, {.required = true})
                                .field("name", &SaveRequest::name, {.required = true});
  return table;
}

const Table<AtRequest>& fields_of(const AtRequest*) {
  static const auto table =
      Table<AtRequest>("at", "Shows a recording at a time.")
          .field("time", &AtRequest::time, {.meaning = "s", .range = any_place, .required = true});
  return table;
}

const Table<ImagesRequest>& fields_of(const ImagesRequest*) {
  static const auto table =
      Table<ImagesRequest>("images", "Requests images of a camera.")
          .field("camera", &ImagesRequest::camera, {.required = true})
          .field("rate", &ImagesRequest::rate, {.range = between(0, 1000), .required = true})
          .field("quality", &ImagesRequest::quality, {.range = between(1, 100)})
          .check([](const ImagesRequest& images, Reader& reader) { check_camera(images.camera, reader); });
  return table;
}

const Table<AckRequest>& fields_of(const AckRequest*) {
  static const auto table =
      Table<AckRequest>("ack", "Acknowledges an image.")
          .field("camera", &AckRequest::camera, {.required = true})
          .field("number", &AckRequest::number, {.range = between(0, 4294967295.0), .required = true})
          .check([](const AckRequest& ack, Reader& reader) { check_camera(ack.camera, reader); });
  return table;
}

const Table<PixelRequest>& fields_of(const PixelRequest*) {
  static const auto table =
      Table<PixelRequest>("pixel", "Requests what a pixel shows.")
          .field("camera", &PixelRequest::camera, {.required = true})
          .field("u", &PixelRequest::u, {.range = between(0, 65535), .required = true})
          .field("v", &PixelRequest::v, {.range = between(0, 65535), .required = true})
          .check([](const PixelRequest& pixel, Reader& reader) { check_camera(pixel.camera, reader); });
  return table;
}

const Table<ColorRequest>& fields_of(const ColorRequest*) {
  static const auto table =
      Table<ColorRequest>("color", "Requests the colour of the arm at a pixel.")
          .field("camera", &ColorRequest::camera, {.required = true})
          .field("u", &ColorRequest::u, {.range = between(0, 65535), .required = true})
          .field("v", &ColorRequest::v, {.range = between(0, 65535), .required = true})
          .check([](const ColorRequest& color, Reader& reader) { check_camera(color.camera, reader); });
  return table;
}

const Table<MeasureRequest>& fields_of(const MeasureRequest*) {
  static const auto table =
      Table<MeasureRequest>("measure", "Measures the arm in a picture.")
          .field("camera", &MeasureRequest::camera, {.required = true})
          .field("layers", &MeasureRequest::layers,
                 {.meaning = "names of the layers to draw", .count = {0, layer_names().size()}})
          .field("seeing", &MeasureRequest::seeing,
                 {.meaning = "what separates the arm from its surroundings"})
          .check([](const MeasureRequest& measure, Reader& reader) {
            check_camera(measure.camera, reader);
            for (std::size_t i = 0; measure.layers && i < measure.layers->size(); ++i) {
              const std::string& name = (*measure.layers)[i];
              if (std::ranges::count(layer_names(), name) == 0)
                reader.problem_at(fmt::format("layers[{}]", i),
                                  fmt::format("there is no layer {}: expected one of {}",
                                              Node{name, {}}.brief(), fmt::join(layer_names(), ", ")));
            }
          });
  return table;
}

const Table<ShapeRequest>& fields_of(const ShapeRequest*) {
  static const auto table =
      Table<ShapeRequest>("shape", "Estimates the shape of the arm from the pictures of all cameras.")
          .field("seeing", &ShapeRequest::seeing, {.meaning = seeing_meaning, .count = {0, most_cameras}});
  return table;
}

const Table<PointRequest>& fields_of(const PointRequest*) {
  static const auto table =
      Table<PointRequest>("point", "Requests a point of the backbone.")
          .field("s", &PointRequest::s, {.meaning = "m", .range = any_place, .required = true});
  return table;
}

const Table<BackboneRequest>& fields_of(const BackboneRequest*) {
  static const auto table = with_shape<BackboneRequest>("backbone", "Requests the backbone of a shape.");
  return table;
}

Request read_request(std::string_view text) {
  Request request;
  try {
    request.error = read(parse_json(text, ""), request);
  } catch (const InputError& error) {
    request.error = joined(error.problems());
  }
  std::ranges::replace_if(request.error, [](char c) { return c >= 0 && c < ' '; }, ' ');
  return request;
}

}  // namespace flexura
