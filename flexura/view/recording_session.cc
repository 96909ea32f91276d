#include "flexura/view/recording_session.h"

#include <fmt/format.h>

#include <exception>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/base/source.h"
#include "flexura/log/results.h"
#include "flexura/picture/image_file.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"
#include "flexura/view/answers.h"
#include "flexura/view/live_rig.h"
#include "flexura/view/moves.h"
#include "flexura/view/pixel.h"
#include "flexura/view/series.h"
#include "flexura/view/truth_extras.h"

namespace flexura {
namespace {

// The number of no image, for streams.
constexpr std::int64_t no_image = -1;
constexpr std::size_t largest_report = std::size_t{256} << 20;

// A link that leads out of the folder is not part of the results.
std::filesystem::path report_of(const Recording& recording) {
  return file_inside(recording.folder(), report_file_name);
}

bool has_report(const Recording& recording) {
  try {
    return !report_of(recording).empty();
  } catch (const InputError&) {
    return false;
  }
}

// Adds the logged forces of a rod. The log does not contain the tendon displacements.
void add_forces(const ViewedRig& rig, const Recording::LoggedForces& forces, StateMessage& state) {
  if (const auto& energy = forces.energy)
    state.energy = RodEnergy{energy->kinetic, energy->strain, energy->gravity};
  state.contacts = contact_samples(rig, forces.contacts);
  if (forces.tensions.size() != rig.actuators.size()) return;
  for (std::size_t i = 0; i < forces.tensions.size(); ++i)
    state.actuators.push_back(
        {0, forces.tensions[i], i < forces.lost_steps.size() ? forces.lost_steps[i] : 0});
}

}  // namespace

struct RecordingSession::Table {
  std::optional<SeriesTable> made;
};

struct RecordingSession::Taker : PictureSession::Taker {
  RecordingSession& session;
  using PictureSession::Taker::operator();

  void operator()(const AtRequest& at) const {
    double& time = session.times_[client];
    time = at.time;
    session.send_state(client);
    const Recording& recording = *session.recording_;
    const double shown = recording.time_of_state(recording.state_at(time));
    done({Node::Table{{"time", {}, {shown, {}}}}, {}});
  }
  void operator()(const PixelRequest& pixel) const {
    session.report_pixel({client, session.place_of(pixel.camera)}, static_cast<int>(pixel.u),
                         static_cast<int>(pixel.v), std::move(reply));
  }
  void operator()(const PointRequest& point) const {
    const Recording& recording = *session.recording_;
    const ArmState state = recording.state(recording.state_at(session.times_[client]));
    done(point_answer(session.viewed()->model.backbone(state), point.s));
  }
  void operator()(const BackboneRequest& backbone) const {
    done(backbone_answer(
        session.viewed()->model.backbone(requested_shape(session.viewed()->model.driven(), backbone))));
  }
  void operator()(const CancelRequest&) const { throw ViewRefusal("no run is active"); }
  void operator()(const OpenRequest&) const { throw ViewRefusal("the recording is already open"); }
  template <class Other>
  void operator()(const Other&) const {
    throw ViewRefusal("this is a recording, in which nothing can be moved");
  }
};

RecordingSession::RecordingSession(RecordingPtr recording, Messenger& messenger, Background& background)
    : PictureSession(recording->rig(), messenger, background),
      recording_(std::move(recording)),
      table_(std::make_shared<Table>()) {}

Hello RecordingSession::hello() const {
  Hello hello;
  hello.mode = "recording";
  hello.title = viewed()->experiment.title;
  hello.scene = scene_node(*viewed());
  hello.controls = controls_node(*viewed());
  hello.duration = recording_->duration();
  hello.interval = recording_->interval();
  hello.marks = recording_->marks();
  hello.quantities = SeriesTable::quantities(*recording_);
  hello.headline = recording_->headline();
  hello.report = has_report(*recording_);
  hello.readonly = true;
  return hello;
}

void RecordingSession::opened(ClientId client) {
  times_[client] = 0;
  reported_.erase(client);
  send_state(client);
}

void RecordingSession::closed(ClientId client) {
  times_.erase(client);
  reported_.erase(client);
  PictureSession::closed(client);
}

void RecordingSession::take(ClientId client, const Ask& ask, Reply reply) {
  std::visit(Taker{{*this, client, reply}, *this}, ask);
}

void RecordingSession::take(const Document& document, std::function<void(HttpAnswer)> answer) {
  if (const auto* image = std::get_if<ImageAsk>(&document)) {
    give_image(*image, std::move(answer));
  } else if (const auto* series = std::get_if<SeriesAsk>(&document)) {
    give_series(*series, std::move(answer));
  } else {
    give_report(std::move(answer));
  }
}

// Sent before the state, so that it has arrived when the state is drawn.
void RecordingSession::send_extras(ClientId client) {
  if (!recording_->has_servo() && !recording_->has_calibration() && !recording_->has_truth()) return;
  const double time = times_.at(client);
  Extras extras;
  extras.time = time;
  try {
    if (const auto servo = recording_->servo(time)) {
      extras = servo_extras(*viewed(), *servo);
    } else if (const auto calibration = recording_->calibration(time)) {
      extras = calibration_extras(*calibration);
    }
  } catch (const InputError&) {
    extras = {};  // Damaged messages are not drawn.
  }
  add_truth(time, extras);
  messenger().post(client, extras_stream, std::make_shared<const std::string>(extras_message(extras)));
}

// Adds the true arm at the time of the shown state's command.
void RecordingSession::add_truth(double time, Extras& extras) const {
  const std::size_t place = recording_->state_at(time);
  try {
    if (const auto truth = recording_->truth(recording_->time_of_state(place)))
      add_true_arm(*truth, viewed()->model.backbone(recording_->state(place)), extras);
  } catch (const InputError&) {
    return;  // Damaged messages are not drawn.
  }
}

void RecordingSession::send_state(ClientId client) {
  send_extras(client);
  const std::size_t place = recording_->state_at(times_.at(client));
  const double time = recording_->time_of_state(place);
  std::vector<CameraStance> stances;
  stances.reserve(viewed()->cameras.size());
  for (std::size_t i = 0; i < viewed()->cameras.size(); ++i) stances.push_back(recording_->stance(i, time));
  StateMessage state = still_state(*viewed(), time, recording_->state(place), stances);
  add_forces(*viewed(), recording_->forces(time), state);
  state.is_recording = true;
  const Conditioned condition = recording_->condition(time);
  state.is_unsafe = condition.condition == Condition::unsafe;
  if (reported_[client] != condition) messenger().send(client, condition_message(condition));
  reported_[client] = condition;
  state.sequence = sequence_++;
  messenger().post(client, state_stream, std::make_shared<const std::string>(state_message(state)));
}

std::optional<std::int64_t> RecordingSession::image_place(std::size_t camera, double time) const {
  std::optional<std::size_t> place;
  if (is_filmed(camera)) {
    place = recording_->image_at(camera, time);
  } else {
    place = recording_->measured_state(camera, time).value_or(recording_->state_at(time));
  }
  return place ? std::optional(static_cast<std::int64_t>(*place)) : std::nullopt;
}

std::int64_t RecordingSession::require_image(std::size_t camera, double time) const {
  const auto place = image_place(camera, time);
  if (!place)
    throw ViewRefusal(
        fmt::format("the camera {} has no picture at {:.4g} s: its first picture was taken later",
                    Node{viewed()->cameras[camera].config().name, {}}.brief(), time));
  return *place;
}

ValueShot RecordingSession::shot(std::size_t camera, std::int64_t number) const {
  const auto place = static_cast<std::size_t>(number);
  const double time = recording_->time_of_state(place);
  const CameraStance stance = recording_->stance(camera, time);
  // Its exposure has its middle at the time of the state that it shows.
  const double start = time - times_of_frame_at(viewed()->sensors.at(camera), 0).middle;
  return with_covers(value_shot(viewed(), camera, number, start, {{start, recording_->state(place), stance}}),
                     time);
}

void RecordingSession::advance(double now) {
  clock_ = now;
  for (const auto& [client, time] : times_) {
    for (std::size_t camera = 0; camera < viewed()->cameras.size(); ++camera) {
      const ImageStreams::Key key{client, camera};
      const auto place = image_place(camera, time);
      if (!streams().is_due(key, place.value_or(no_image), now)) continue;
      if (!place) {
        send_no_image(key, time);
      } else if (is_filmed(camera)) {
        send_image(key, *place);
      } else if (!room().is_busy(camera)) {
        show_state(key, *place);
      }
    }
  }
}

// Without logged images, the cameras show the arm as commanded.
void RecordingSession::show_state(const ImageStreams::Key& key, std::int64_t place) {
  try {
    room().show(shot(key.camera, place), {key}, clock_);
  } catch (const InputError&) {
    streams().sent(key, place, clock_);  // Prevents repeated attempts at a damaged state.
  }
}

// Reports to the client that there is no image, because the previous image has another time. Not
// acknowledged.
void RecordingSession::send_no_image(const ImageStreams::Key& key, double time) {
  streams().sent(key, no_image, clock_);
  streams().failed(key);
  messenger().post(key.client, image_stream(key.camera),
                   std::make_shared<const std::string>(
                       image_message(static_cast<std::uint8_t>(key.camera), ImageFormat::png, 0, time, "")));
}

// Sends a logged image unchanged.
void RecordingSession::send_image(const ImageStreams::Key& key, std::int64_t place) {
  streams().sent(key, place, clock_);
  background().run(Lane::pictures,
                   [this, key, place, recording = recording_, alive = this->alive()]() -> Background::After {
                     std::shared_ptr<const std::string> message;
                     try {
                       const Recording::LoggedImage image =
                           recording->image(key.camera, static_cast<std::size_t>(place));
                       message = std::make_shared<const std::string>(
                           image_message(static_cast<std::uint8_t>(key.camera), ImageFormat::png,
                                         static_cast<std::uint32_t>(place), image.time, image.png));
                     } catch (const std::exception&) {
                       return {};  // It stays unacknowledged, so that a damaged image is not sent repeatedly.
                     }
                     return [this, key, message, alive] {
                       if (!alive.expired() && streams().contains(key))
                         messenger().post(key.client, image_stream(key.camera), message);
                     };
                   });
}

void RecordingSession::report_pixel(const ImageStreams::Key& key, int u, int v, Reply reply) {
  const double time = times_.at(key.client);
  const std::int64_t place = require_image(key.camera, time);
  if (!is_filmed(key.camera)) {
    room().pixel(key, shot(key.camera, place), u, v, std::move(reply));
    return;
  }
  background().run(Lane::pictures,
                   [key, place, u, v, reply = std::move(reply), recording = recording_,
                    alive = this->alive()]() -> Background::After {
                     ViewAnswer answer;
                     try {
                       const auto image = recording->image(key.camera, static_cast<std::size_t>(place));
                       const std::int64_t bits = recording->rig()->sensors[key.camera].bits;
                       answer.result = pixel_node(read_png(image.png), bits, u, v, place, std::nullopt);
                     } catch (const std::exception& error) {
                       answer.error = error.what();
                     }
                     return [answer, reply, alive] {
                       if (!alive.expired()) reply(answer);
                     };
                   });
}

// With logged images, looks at the log's picture at the client's current time.
PictureSession::Look RecordingSession::look(const ImageStreams::Key& key) {
  if (!is_filmed(key.camera)) return look_at_sent(key);
  const std::int64_t place = require_image(key.camera, times_.at(key.client));
  return [key, place, recording = recording_] {
    const Recording::LoggedImage image = recording->image(key.camera, static_cast<std::size_t>(place));
    const ViewedRig& rig = *recording->rig();
    return SeenPicture{key.camera, place, rig.sensors[key.camera].white(),
                       std::make_shared<const Picture>(read_png(image.png)),
                       rig.reading(key.camera, recording->stance(key.camera, image.time))};
  };
}

void RecordingSession::give_image(const ImageAsk& ask, std::function<void(HttpAnswer)> answer) {
  const std::size_t camera = place_of(ask.camera);
  const std::int64_t place = require_image(camera, ask.time.value_or(recording_->duration()));
  if (!is_filmed(camera)) {
    if (!room().file(shot(camera, place), std::move(answer)))
      throw ViewRefusal("too many pictures are requested at once");
    return;
  }
  background().run(
      Lane::pictures,
      [camera, place, recording = recording_, answer = std::move(answer)]() -> Background::After {
        try {
          answer({200, "image/png", recording->image(camera, static_cast<std::size_t>(place)).png, ""});
        } catch (const std::exception& error) {
          answer(failure_answer(500, error.what()));
        }
        return {};
      });
}

void RecordingSession::give_series(const SeriesAsk& ask, std::function<void(HttpAnswer)> answer) {
  background().run(
      Lane::checks,
      [ask, recording = recording_, table = table_, answer = std::move(answer)]() -> Background::After {
        try {
          if (!table->made) table->made.emplace(*recording);
          answer({200, "application/json",
                  write_json(table->made->answer(ask.names, static_cast<std::size_t>(ask.points))), ""});
        } catch (const ViewRefusal& refusal) {
          answer(failure_answer(404, refusal.what()));
        } catch (const std::exception& error) {
          answer(failure_answer(500, error.what()));
        }
        return {};
      });
}

void RecordingSession::give_report(std::function<void(HttpAnswer)> answer) {
  background().run(Lane::checks, [recording = recording_, answer = std::move(answer)]() -> Background::After {
    try {
      answer(report_answer(read_text_file(report_of(*recording), largest_report)));
    } catch (const std::exception&) {
      answer(failure_answer(404, "the run has no report"));
    }
    return {};
  });
}

}  // namespace flexura
