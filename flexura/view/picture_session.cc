#include "flexura/view/picture_session.h"

#include <utility>

namespace flexura {

PictureSession::PictureSession(const ViewedRigPtr& rig, Messenger& messenger, Background& background)
    : viewed_(rig),
      messenger_(messenger),
      background_(background),
      room_(rig, messenger, background, streams_) {}

void PictureSession::closed(ClientId client) {
  streams_.close(client);
  room_.close(client);
}

std::size_t PictureSession::place_of(const std::string& camera) const {
  const auto place = viewed_->camera(camera);
  if (!place) throw ViewRefusal("there is no camera " + Node{camera, {}}.brief());
  return *place;
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

void PictureSession::Taker::operator()(const PingRequest& /*ping*/) const { done(); }

}  // namespace flexura
