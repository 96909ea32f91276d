#include "flexura/view/picture_session.h"

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "flexura/port/camera_port.h"
#include "flexura/sim/simulated_camera.h"
#include "flexura/view/arm_layers.h"
#include "flexura/view/seeing_choice.h"
#include "flexura/vision/eight_bits.h"

namespace flexura {

PictureSession::PictureSession(const ViewedRigPtr& rig, Messenger& messenger, Background& background)
    : viewed_(rig),
      messenger_(messenger),
      background_(background),
      room_(rig, messenger, background, streams_),
      measures_(background, Lane::measures),
      colors_(background, Lane::measures) {}

void PictureSession::closed(ClientId client) {
  streams_.close(client);
  room_.close(client);
  measures_.close(client);
  colors_.close(client);
}

std::size_t PictureSession::place_of(const std::string& camera) const {
  const auto place = viewed_->camera(camera);
  if (place) return *place;
  std::vector<std::string> names;
  for (const Camera& known : viewed_->cameras) names.push_back(Node{known.config().name, {}}.brief());
  const std::string expected =
      names.empty() ? "this rig has no cameras" : fmt::format("expected one of {}", fmt::join(names, ", "));
  throw ViewRefusal(
      fmt::format("camera = {}: there is no camera with this name; {}", Node{camera, {}}.brief(), expected));
}

PictureSession::Look PictureSession::look_at_sent(const ImageStreams::Key& key) {
  const auto sent = room_.last_sent(key);
  if (!sent)
    throw ViewRefusal(
        fmt::format("no picture of the camera {} was sent yet: expected an earlier request for images",
                    Node{viewed_->cameras[key.camera].config().name, {}}.brief()));
  return [sent = *sent, rig = viewed_] {
    const Shot& shot = sent.shot.shot;
    return SeenPicture{shot.camera, shot.frame, shot.sensor->white(), sent.picture,
                       rig->reading(shot.camera, stance_in(sent.shot))};
  };
}

void PictureSession::Taker::done(Node result) const { reply({std::move(result), ""}); }

void PictureSession::Taker::operator()(const ImagesRequest& images) const {
  pictures.streams_.set({client, pictures.place_of(images.camera)}, images.rate,
                        static_cast<int>(images.quality));
  done();
}

void PictureSession::Taker::operator()(const AckRequest& ack) const {
  pictures.streams_.ack({client, pictures.place_of(ack.camera)}, ack.number);
  done();
}

void PictureSession::Taker::operator()(const ColorRequest& color) const {
  const std::size_t camera = pictures.place_of(color.camera);
  pictures.colors_.ask(
      {client, camera},
      [look = pictures.look({client, camera}), u = static_cast<int>(color.u), v = static_cast<int>(color.v)] {
        const SeenPicture seen = look();
        return color_answer(eight_bits(*seen.picture, seen.white), seen.number, u, v);
      },
      std::move(reply));
}

void PictureSession::Taker::operator()(const MeasureRequest& measure) const {
  const std::size_t camera = pictures.place_of(measure.camera);
  const auto names = layer_names();
  std::vector<std::string> layers =
      measure.layers.value_or(std::vector<std::string>(names.begin(), names.end()));
  pictures.measures_.ask(
      {client, camera},
      [rig = pictures.viewed_, look = pictures.look({client, camera}), layers = std::move(layers),
       choice = measure.seeing] { return measure_answer(*rig, look(), layers, choice ? &*choice : nullptr); },
      std::move(reply));
}

void PictureSession::Taker::operator()(const ShapeRequest& shape) const {
  const std::size_t cameras = pictures.viewed_->cameras.size();
  if (cameras < 2) throw ViewRefusal("a shape needs pictures of two cameras: this rig has fewer cameras");
  for (const CameraSeeingChoice& choice : shape.seeing) (void)pictures.place_of(choice.camera);
  std::vector<Look> looks;
  looks.reserve(cameras);
  for (std::size_t camera = 0; camera < cameras; ++camera) looks.push_back(pictures.look({client, camera}));
  pictures.measures_.ask(
      {client, cameras},
      [rig = pictures.viewed_, looks = std::move(looks), choices = shape.seeing] {
        std::vector<SeenPicture> seen;
        for (const Look& look : looks) seen.push_back(look());
        return shape_answer(*rig, seen, choices);
      },
      std::move(reply));
}

void PictureSession::Taker::operator()(const PingRequest& /*ping*/) const { done(); }

}  // namespace flexura
