#include "flexura/view/file_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <variant>

#include "flexura/base/node.h"
#include "flexura/picture/image_file.h"
#include "flexura/view/arm_layers.h"
#include "flexura/view/picture_room.h"
#include "flexura/view/pixel.h"
#include "flexura/view/seeing_choice.h"
#include "flexura/view/seen_arm.h"
#include "flexura/view/state_message.h"

namespace flexura {
namespace {

// The number of every picture: a file has one.
constexpr std::int64_t only_number = 0;

// Returns SCENE of the protocol without a rig. Its arm has no sections and is not visible.
Node scene_without_rig(const std::vector<ViewedPicture>& pictures) {
  const auto list_of = [](std::initializer_list<double> values) {
    Node::Array list;
    for (const double value : values) list.push_back({value, {}});
    return Node{std::move(list), {}};
  };
  const Node none{Node::Array{}, {}};
  Node::Array cameras;
  for (const ViewedPicture& one : pictures) {
    const Image<std::uint8_t>& bytes = one.photograph->bytes;
    cameras.push_back({Node::Table{{"name", {}, text_node(one.name)},
                                   {"width", {}, {std::int64_t{bytes.width()}, {}}},
                                   {"height", {}, {std::int64_t{bytes.height()}, {}}},
                                   {"channels", {}, {std::int64_t{bytes.channels()}, {}}}},
                       {}});
  }
  return {Node::Table{{"arm",
                       {},
                       {Node::Table{{"kind", {}, text_node("planar")},
                                    {"sections", {}, none},
                                    {"color", {}, list_of({0, 0, 0})},
                                    {"tip", {}, text_node("flat")},
                                    {"markers", {}, none},
                                    {"disks", {}, none},
                                    {"disk_color", {}, list_of({0, 0, 0})},
                                    {"base", {}, list_of({0, 0, 0, 1, 0, 0, 0})},
                                    {"tendons", {}, none},
                                    {"elastic", {}, {false, {}}},
                                    {"visible", {}, {false, {}}}},
                        {}}},
                      {"screens", {}, none},
                      {"etalon", {}, {}},
                      {"obstacles", {}, none},
                      {"cameras", {}, {std::move(cameras), {}}},
                      {"light",
                       {},
                       {Node::Table{{"towards", {}, list_of({0, 0, 1})},
                                    {"ambient", {}, {1.0, {}}},
                                    {"directional", {}, {0.0, {}}}},
                        {}}},
                      {"background", {}, {0.0, {}}}},
          {}};
}

Node no_controls() {
  const Node none{Node::Array{}, {}};
  return {Node::Table{{"sections", {}, none},
                      {"tendons", {}, {}},
                      {"heads", {}, none},
                      {"stages", {}, none},
                      {"tasks", {}, none}},
          {}};
}

}  // namespace

struct FileSession::Taker {
  FileSession& session;
  ClientId client;
  Reply& reply;

  void done() const { reply({{Node::Table{}, {}}, ""}); }
  void operator()(const ImagesRequest& images) const {
    session.streams_.set({client, session.place_of(images.camera)}, images.rate,
                         static_cast<int>(images.quality));
    done();
  }
  void operator()(const AckRequest& ack) const {
    session.streams_.ack({client, session.place_of(ack.camera)}, ack.number);
    done();
  }
  void operator()(const PixelRequest& pixel) const {
    const Photograph& photograph = *session.pictures_[session.place_of(pixel.camera)].photograph;
    const int u = static_cast<int>(pixel.u), v = static_cast<int>(pixel.v);
    const int bits = static_cast<int>(std::bit_width(static_cast<unsigned>(photograph.white)));
    reply({photograph.words.values().empty()
               ? pixel_node(photograph.bytes, bits, u, v, only_number, std::nullopt)
               : pixel_node(photograph.words, bits, u, v, only_number, std::nullopt),
           ""});
  }
  void operator()(const ColorRequest& color) const {
    const std::size_t place = session.place_of(color.camera);
    session.colors_.ask(
        {client, place},
        [photograph = session.pictures_[place].photograph, u = static_cast<int>(color.u),
         v = static_cast<int>(color.v)] { return color_answer(photograph->bytes, only_number, u, v); },
        std::move(reply));
  }
  void operator()(const MeasureRequest& measure) const {
    const std::size_t place = session.place_of(measure.camera);
    const auto names = layer_names();
    std::vector<std::string> layers =
        measure.layers.value_or(std::vector<std::string>(names.begin(), names.end()));
    session.measures_.ask(
        {client, place},
        [photograph = session.pictures_[place].photograph, layers = std::move(layers),
         choice = measure.seeing] {
          return measure_answer(*photograph, only_number, layers, choice ? &*choice : nullptr);
        },
        std::move(reply));
  }
  void operator()(const PingRequest&) const { done(); }
  template <class Other>
  void operator()(const Other&) const {
    throw ViewRefusal("these are picture files: there is no rig");
  }
};

FileSession::FileSession(std::vector<ViewedPicture> pictures, Messenger& messenger, Background& background)
    : pictures_(std::move(pictures)),
      messenger_(messenger),
      background_(background),
      measures_(background, Lane::measures),
      colors_(background, Lane::measures) {
  if (pictures_.size() > most_viewed_pictures)
    throw std::invalid_argument(
        fmt::format("{} pictures: expected at most {}", pictures_.size(), most_viewed_pictures));
  for (const ViewedPicture& one : pictures_) {
    const Image<std::uint8_t>& bytes = one.photograph->bytes;
    if (std::max(bytes.width(), bytes.height()) > most_viewed_side)
      throw std::invalid_argument(fmt::format("{}: {} x {} px: expected at most {} px a side", one.name,
                                              bytes.width(), bytes.height(), most_viewed_side));
  }
}

Hello FileSession::hello() const {
  Hello hello;
  hello.mode = "pictures";
  hello.title = pictures_.size() == 1 ? pictures_.front().name : fmt::format("{} pictures", pictures_.size());
  hello.scene = scene_without_rig(pictures_);
  hello.controls = no_controls();
  hello.readonly = true;
  return hello;
}

void FileSession::opened(ClientId client) { clients_.insert(client); }

void FileSession::closed(ClientId client) {
  clients_.erase(client);
  streams_.close(client);
  measures_.close(client);
  colors_.close(client);
}

void FileSession::take(ClientId client, const Ask& ask, Reply reply) {
  std::visit(Taker{*this, client, reply}, ask);
}

void FileSession::take(const Document& /*document*/, std::function<void(HttpAnswer)> /*answer*/) {
  throw ViewRefusal("these are picture files: their pictures come over the socket only");
}

RigInstant FileSession::instant(ClientId /*client*/) {
  throw ViewRefusal("these are picture files: there is no rig");
}

std::size_t FileSession::place_of(const std::string& name) const {
  const auto found = std::ranges::find(pictures_, name, &ViewedPicture::name);
  if (found == pictures_.end())
    throw ViewRefusal(
        fmt::format("camera = {}: there is no picture with this name", text_node(name).brief()));
  return static_cast<std::size_t>(found - pictures_.begin());
}

void FileSession::advance(double now) {
  for (const ClientId client : clients_) {
    for (std::size_t place = 0; place < pictures_.size(); ++place)
      if (streams_.is_due({client, place}, only_number, now)) show({client, place}, now);
  }
}

void FileSession::show(const ImageStreams::Key& key, double now) {
  streams_.sent(key, only_number, now);
  background_.run(
      Lane::pictures,
      [this, key, photograph = pictures_[key.camera].photograph, quality = streams_.quality(key),
       alive = std::weak_ptr(alive_)]() -> Background::After {
        auto message = std::make_shared<const std::string>(image_message(
            static_cast<std::uint8_t>(key.camera), ImageFormat::jpeg, static_cast<std::uint32_t>(only_number),
            0, jpeg(photograph->bytes, {.quality = quality})));
        return [this, key, message = std::move(message), alive] {
          if (!alive.expired() && streams_.contains(key))
            messenger_.post(key.client, image_stream(key.camera), message);
        };
      });
}

}  // namespace flexura
