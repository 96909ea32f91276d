#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "flexura/base/node.h"
#include "flexura/view/background.h"
#include "flexura/view/image_streams.h"
#include "flexura/view/latest_jobs.h"
#include "flexura/view/messenger.h"
#include "flexura/view/picture_room.h"
#include "flexura/view/seen_arm.h"
#include "flexura/view/session.h"

namespace flexura {

/// Common base class of sessions with live rigs and with recordings. A PictureSession sends the cameras'
/// pictures to the clients.
class PictureSession : public Session {
 public:
  void closed(ClientId client) override;

 protected:
  PictureSession(const ViewedRigPtr& rig, Messenger& messenger, Background& background);

  /// Handles the requests that live rigs and recordings have in common. The request handlers of live rigs and
  /// of recordings derive from this struct.
  struct Taker {
    PictureSession& pictures;
    ClientId client;
    Reply& reply;

    void done(Node result = {Node::Table{}, {}}) const;
    void operator()(const ImagesRequest& images) const;
    void operator()(const AckRequest& ack) const;
    void operator()(const ColorRequest& color) const;
    void operator()(const MeasureRequest& measure) const;
    void operator()(const ShapeRequest& shape) const;
    void operator()(const PingRequest& ping) const;
  };

  /// Function that returns a picture. The function is called on the thread of Lane::measures. The function
  /// throws an exception if there is no picture.
  using Look = std::function<SeenPicture()>;
  /// Returns a function for the picture that a client sees. Throws ViewRefusal if the client sees no picture.
  [[nodiscard]] virtual Look look(const ImageStreams::Key& key) = 0;
  /// Returns a function for the last picture that room() sent to the client.
  [[nodiscard]] Look look_at_sent(const ImageStreams::Key& key);

  [[nodiscard]] const ViewedRigPtr& viewed() const { return viewed_; }
  [[nodiscard]] Messenger& messenger() { return messenger_; }
  [[nodiscard]] Background& background() { return background_; }
  [[nodiscard]] ImageStreams& streams() { return streams_; }
  [[nodiscard]] PictureRoom& room() { return room_; }
  /// Returns a weak pointer that expires when this session ends, for jobs that may finish after the session.
  [[nodiscard]] std::weak_ptr<const bool> alive() const { return alive_; }
  /// Returns the index of the camera with this name. Throws ViewRefusal if there is no such camera.
  [[nodiscard]] std::size_t place_of(const std::string& camera) const;

 private:
  ViewedRigPtr viewed_;
  Messenger& messenger_;
  Background& background_;
  ImageStreams streams_;
  PictureRoom room_;
  LatestJobs measures_, colors_;
  std::shared_ptr<const bool> alive_ = std::make_shared<const bool>(true);
};

}  // namespace flexura
