#include "flexura/view/picture_room.h"

#include <exception>
#include <string>
#include <utility>
#include <variant>

#include "flexura/picture/image_file.h"
#include "flexura/rig/photographer.h"
#include "flexura/view/pixel.h"
#include "flexura/view/state_message.h"
#include "flexura/vision/eight_bits.h"

namespace flexura {
namespace {

constexpr int most_waiting = 32;

}  // namespace

// Data used on the lane of pictures only.
struct PictureRoom::Tools {
  explicit Tools(const ViewedRigPtr& rig) : photographer(rig->experiment), probe(rig) {}

  // The last picture of a camera, and its files by quality.
  struct Taken {
    ValueShot shot;
    std::shared_ptr<const Picture> picture;
    std::map<int, std::string> files;
  };
  // Returns the picture of a shot: rendered, or the last one again.
  Taken& take(const ValueShot& shot) {
    Taken& last = taken[shot.shot.camera];
    if (last.picture == nullptr || !show_the_same(last.shot, shot)) {
      last.files.clear();
      last.picture = std::make_shared<const Picture>(photographer.take(shot.shot));
    }
    last.shot = shot;
    return last;
  }
  static const std::string& file(Taken& taken, int quality) {
    std::string& file = taken.files[quality];
    if (file.empty())
      file = jpeg(eight_bits(*taken.picture, taken.shot.shot.sensor->white()), {.quality = quality});
    return file;
  }
  ViewAnswer pixel(const Shown& shown, int u, int v) {
    const Shot& shot = shown.shot.shot;
    const auto picture = shown.picture ? shown.picture : take(shown.shot).picture;
    const auto answer = [&](const std::optional<SeenPixel>& seen) {
      return pixel_node(*picture, shot.sensor->bits, u, v, shot.frame, seen);
    };
    (void)answer(std::nullopt);  // Throws for a pixel outside the picture.
    return {answer(probe.look(shot, u, v)), ""};
  }

  Photographer photographer;
  PixelProbe probe;
  std::map<std::size_t, Taken> taken;  // By camera.
};

struct PictureRoom::Sent {
  Shown shown;
  std::vector<ImageStreams::Key> to;
  std::vector<int> qualities;                                  // For each of `to`.
  std::map<int, std::shared_ptr<const std::string>> messages;  // By quality; missing: could not be rendered.

  void make_messages(Tools& tools) {
    const Shot& shot = shown.shot.shot;
    Tools::Taken& taken = tools.take(shown.shot);
    const double time = times_of_frame_at(*shot.sensor, shot.start).middle;
    for (const int quality : qualities) {
      if (messages.contains(quality)) continue;
      messages[quality] = std::make_shared<const std::string>(
          image_message(static_cast<std::uint8_t>(shot.camera), ImageFormat::jpeg,
                        static_cast<std::uint32_t>(shot.frame), time, Tools::file(taken, quality)));
    }
    shown.picture = taken.picture;
  }
};

PictureRoom::PictureRoom(ViewedRigPtr rig, Messenger& messenger, Background& background,
                         ImageStreams& streams)
    : rig_(std::move(rig)),
      messenger_(messenger),
      background_(background),
      streams_(streams),
      tools_(std::make_shared<Tools>(rig_)) {}

void PictureRoom::show(const ValueShot& shot, const std::vector<ImageStreams::Key>& to, double now) {
  busy_.insert(shot.shot.camera);
  auto sent = std::make_shared<Sent>();
  sent->shown.shot = shot;
  sent->to = to;
  for (const ImageStreams::Key& key : to) {
    sent->qualities.push_back(streams_.quality(key));
    streams_.sent(key, shot.shot.frame, now);
  }
  auto job = [this, sent, tools = tools_, alive = std::weak_ptr(alive_)]() -> Background::After {
    try {
      sent->make_messages(*tools);
    } catch (const std::exception&) {
      sent->messages.clear();
    }
    return [this, sent, alive] {
      if (!alive.expired()) deliver(*sent);
    };
  };
  background_.run(Lane::pictures, std::move(job));
}

void PictureRoom::deliver(const Sent& sent) {
  const std::size_t camera = sent.shown.shot.shot.camera;
  busy_.erase(camera);
  for (std::size_t i = 0; i < sent.to.size(); ++i) {
    const ImageStreams::Key& key = sent.to[i];
    const auto message = sent.messages.find(sent.qualities[i]);
    if (message == sent.messages.end()) {
      streams_.failed(key);
    } else if (streams_.contains(key)) {
      messenger_.post(key.client, image_stream(camera), message->second);
      last_[key] = sent.shown;
    }
  }
}

void PictureRoom::pixel(const ImageStreams::Key& key, const ValueShot& newest, int u, int v, Reply reply) {
  if (waiting_ >= most_waiting) throw ViewRefusal("too many pixels are requested at once");
  ++waiting_;
  const auto found = last_.find(key);
  const Shown shown = found != last_.end() ? found->second : Shown{newest, nullptr};
  auto job = [this, shown, u, v, reply = std::move(reply), tools = tools_,
              alive = std::weak_ptr(alive_)]() -> Background::After {
    ViewAnswer answer;
    try {
      answer = tools->pixel(shown, u, v);
    } catch (const std::exception& error) {
      answer.error = error.what();
    }
    return [this, answer, reply, alive] {
      if (alive.expired()) return;
      --waiting_;
      reply(answer);
    };
  };
  background_.run(Lane::pictures, std::move(job));
}

bool PictureRoom::file(const ValueShot& shot, std::function<void(HttpAnswer)> answer) {
  if (waiting_ >= most_waiting) return false;
  ++waiting_;
  auto job = [this, shot, answer = std::move(answer), tools = tools_,
              alive = std::weak_ptr(alive_)]() -> Background::After {
    HttpAnswer made{200, "image/png", "", ""};
    try {
      const auto picture = tools->take(shot).picture;
      made.body = std::visit([](const auto& image) { return png(image, {.level = 1}); }, *picture);
    } catch (const std::exception&) {
      made = {500, "application/json", R"({"error":"the picture could not be taken"})", ""};
    }
    answer(std::move(made));
    return [this, alive] {
      if (!alive.expired()) --waiting_;
    };
  };
  background_.run(Lane::pictures, std::move(job));
  return true;
}

std::optional<PictureRoom::Shown> PictureRoom::last_sent(const ImageStreams::Key& key) const {
  const auto found = last_.find(key);
  return found == last_.end() ? std::nullopt : std::optional(found->second);
}

void PictureRoom::close(ClientId client) {
  std::erase_if(last_, [&](const auto& entry) { return entry.first.client == client; });
}

}  // namespace flexura
