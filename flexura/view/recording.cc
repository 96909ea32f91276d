#include "flexura/view/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "flexura/base/source.h"
#include "flexura/base/table.h"
#include "flexura/log/messages.h"
#include "flexura/log/results.h"
#include "flexura/log/results_log.h"
#include "flexura/math/median.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"
#include "flexura/tasks/calibrate/calibration_messages.h"
#include "flexura/tasks/servo/servo_messages.h"
#include "flexura/view/truth_extras.h"

namespace flexura {
namespace {

// Upper limit for a summary file, which is a list of findings.
constexpr std::size_t largest_summary = std::size_t{64} << 20;

template <class M>
M message_of(const McapMessage& message) {
  return read_as<M>(parse_json(message.text(), "the log's " + message.channel->topic));
}

// Returns the camera of an observation; std::nullopt for a damaged one.
template <class Observation>
std::optional<std::size_t> camera_of(const ViewedRig& rig, const McapMessage& message) {
  try {
    return rig.camera(message_of<Observation>(message).camera);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

ViewedRigPtr rig_of(const std::filesystem::path& folder) {
  return std::make_shared<const ViewedRig>(load_experiment(file_of_results(folder, experiment_file_name)));
}

double number_of(const Node& node, std::string_view key, double otherwise) {
  const Node* found = node.find(key);
  const double* value = found == nullptr ? nullptr : found->as<double>();
  return value == nullptr ? otherwise : *value;
}

}  // namespace

Recording::Recording(const std::filesystem::path& folder)
    : folder_(folder), rig_(rig_of(folder)), log_(open_log(folder)) {
  index();
  if (states_.empty()) throw input_error(folder.string(), "its log has no state of the arm");
  // Checks all states now, so that no damaged one is found during viewing.
  for (std::size_t place = 0; place < states_.size(); ++place) (void)state(place);
  read_marks();
}

void Recording::index() {
  images_.resize(rig_->cameras.size());
  heads_.resize(rig_->cameras.size());
  stages_.resize(rig_->cameras.size());
  servo_observations_.resize(rig_->cameras.size());
  calibration_observations_.resize(rig_->cameras.size());
  for (const McapMessage& message : log_.messages()) {
    const std::string& topic = message.channel->topic;
    const Entry entry{message.log_time, &message};
    if (topic == arm_state_topic) states_.push_back(entry);
    if (topic == arm_truth_topic) truths_.push_back(entry);
    if (topic == arm_energy_topic) energies_.push_back(entry);
    if (topic == arm_tensions_topic) tensions_.push_back(entry);
    if (topic == arm_contacts_topic) contacts_.push_back(entry);
    if (topic == servo_steps_topic) servo_steps_.push_back(entry);
    if (topic == calibration_decisions_topic) decisions_.push_back(entry);
    const bool is_servo = topic == servo_observations_topic,
               is_calibration = topic == calibration_observations_topic;
    if (is_servo || is_calibration) {
      const auto camera = is_servo ? camera_of<ServoObservationMessage>(*rig_, message)
                                   : camera_of<CalibrationObservationMessage>(*rig_, message);
      if (camera) (is_servo ? servo_observations_ : calibration_observations_)[*camera].push_back(entry);
    }
    for (std::size_t i = 0; i < rig_->cameras.size(); ++i) {
      const std::string& name = rig_->cameras[i].config().name;
      if (topic == image_topic(name)) images_[i].push_back(entry);
      if (topic == head_topic(name)) heads_[i].push_back(entry);
      if (topic == stage_topic(name)) stages_[i].push_back(entry);
    }
  }
  const auto sort = [](Entries& entries) { std::ranges::stable_sort(entries, {}, &Entry::time); };
  sort(states_);
  std::ranges::for_each(images_, sort);
  std::ranges::for_each(heads_, sort);
  std::ranges::for_each(stages_, sort);
  for (Entries* entries : {&truths_, &energies_, &tensions_, &contacts_}) sort(*entries);
  sort(servo_steps_);
  sort(decisions_);
  std::ranges::for_each(servo_observations_, sort);
  std::ranges::for_each(calibration_observations_, sort);
  servo_interval_ = interval_of(servo_steps_);
}

void Recording::read_marks() {
  for (const McapMessage& message : log_.messages()) {
    if (message.channel->topic != events_topic) continue;
    const auto event = message_of<EventMessage>(message);
    const double time = seconds(message.log_time);
    marks_.push_back({time, time, level_name(event.level), event.name, event.message});
  }
  read_summary();
  for (const McapDamage& damage : log_.damage())
    marks_.push_back({seconds(damage.from), seconds(damage.to), "warning", "log",
                      "the log is damaged: messages are missing"});
  if (log_.truncated())
    marks_.push_back(
        {duration(), duration(), "warning", "log", "the run was interrupted: its log ends here"});
}

// Reads from the summary how long violations last; the log has only their starts. A damaged summary, for
// example after a full disk, is ignored.
void Recording::read_summary() {
  if (is_missing(folder_ / summary_file_name)) return;
  const auto file = file_of_results(folder_, summary_file_name);
  Node summary;
  try {
    summary = parse_json(read_text_file(file, largest_summary), file.string());
  } catch (const InputError& error) {
    marks_.push_back({0, 0, "warning", "summary", error.what()});
    return;
  }
  const Node* reported = summary.find("outcome");
  if (const auto* outcome = reported == nullptr ? nullptr : reported->as<std::string>()) {
    end_ = {condition_after(*outcome), ""};
    const Node* reasons = summary.find("reasons");
    const auto* lines = reasons == nullptr ? nullptr : reasons->as<Node::Array>();
    const auto* first = lines == nullptr || lines->empty() ? nullptr : lines->front().as<std::string>();
    if (first != nullptr) end_.text = *first;
  }
  const Node* line = summary.find("headline");
  if (const auto* headline = line == nullptr ? nullptr : line->as<std::string>()) headline_ = *headline;
  mark_violations(summary);
}

void Recording::mark_violations(const Node& summary) {
  const Node* list = summary.find("violations");
  const auto* violations = list == nullptr ? nullptr : list->as<Node::Array>();
  if (violations == nullptr) return;
  for (const Node& violation : *violations) {
    const Node* text = violation.find("text");
    const auto* written = text == nullptr ? nullptr : text->as<std::string>();
    if (written == nullptr) continue;
    for (Mark& mark : marks_) {
      if (mark.name == "unsafe" && mark.text == *written)
        mark.end = std::max(mark.time, number_of(violation, "end", mark.time));
    }
  }
}

double Recording::seconds(std::uint64_t nanoseconds) { return static_cast<double>(nanoseconds) / 1e9; }

std::size_t Recording::place_at(const Entries& entries, double time) {
  constexpr double latest = 1e9;  // In s; requested times may have any value.
  const std::uint64_t desired = nanoseconds(std::clamp(time, 0.0, latest));
  const auto after = std::ranges::upper_bound(entries, desired, {}, &Entry::time);
  return after == entries.begin() ? 0 : static_cast<std::size_t>(after - entries.begin()) - 1;
}

double Recording::interval_of(const Entries& entries) {
  std::vector<std::uint64_t> intervals;
  for (std::size_t i = 1; i < entries.size(); ++i) intervals.push_back(entries[i].time - entries[i - 1].time);
  if (intervals.empty()) return 0;
  return seconds(median(std::span(intervals)));
}

std::size_t Recording::state_at(double time) const { return place_at(states_, time); }

ArmState Recording::state(std::size_t place) const {
  const auto message = message_of<ArmStateMessage>(*states_.at(place).message);
  ArmState state;
  for (const auto& bend : message.bends) state.bends.emplace_back(bend[0], bend[1]);
  state.stretches = message.stretches;
  constexpr double largest = 1e6;  // Plausibility limit for any log content.
  const std::size_t sections = rig_->model.driven().sections.size();
  const auto is_shape = [](const Eigen::Vector2d& bend) { return bend.norm() < largest; };
  const auto is_stretch = [](double stretch) { return stretch > 1 / largest && stretch < largest; };
  if (state.bends.size() != sections || state.stretches.size() != sections ||
      !std::ranges::all_of(state.bends, is_shape) || !std::ranges::all_of(state.stretches, is_stretch)) {
    throw input_error(folder_.string(),
                      fmt::format("the log's state at {} s does not fit the log's arm", message.time));
  }
  return state;
}

Conditioned Recording::condition(double time) const {
  const auto broken = std::ranges::find_if(marks_, [&](const Mark& mark) {
    return mark.name == "unsafe" && mark.level == "error" && time >= mark.time && time <= mark.end;
  });
  if (broken != marks_.end()) return {Condition::unsafe, broken->text};
  // The last state is shown from its time on.
  if (state_at(time) + 1 == states()) return end_;
  return {Condition::running, ""};
}

std::optional<std::size_t> Recording::image_at(std::size_t camera, double time) const {
  constexpr double rounding = 1e-6;  // s
  const Entries& images = images_.at(camera);
  if (images.empty() || seconds(images.front().time) > time + rounding) return std::nullopt;
  return place_at(images, time + rounding);
}

Recording::LoggedImage Recording::image(std::size_t camera, std::size_t place) const {
  auto message = message_of<ImageMessage>(*images_.at(camera).at(place).message);
  if (message.format != "png") throw input_error(folder_.string(), "an image in the log is not a PNG file");
  return {static_cast<double>(message.timestamp.sec) + 1e-9 * static_cast<double>(message.timestamp.nsec),
          std::move(message.data.data)};
}

std::optional<ServoStep> Recording::servo_step(double time) const {
  if (servo_steps_.empty()) return std::nullopt;
  const Entry& entry = servo_steps_[place_at(servo_steps_, time)];
  // A servo commands at equal intervals: after a few of them without a command it has ended.
  constexpr double few = 3, least = 0.1;  // s
  const double sent = seconds(entry.time);
  if (time < sent || time > sent + std::max(least, few * servo_interval_)) return std::nullopt;
  return message_of<ServoStep>(*entry.message);
}

// Of the picture that is shown then.
template <class Observation>
std::optional<Recording::PictureEntry> Recording::observation_at(const Entries& observations,
                                                                 std::size_t camera, double time) const {
  if (observations.empty()) return std::nullopt;
  if (images_[camera].empty()) {
    const Entry& entry = observations[place_at(observations, time)];
    if (seconds(entry.time) > time) return std::nullopt;
    // Without film it is the picture of the state at its exposure.
    const double exposed = message_of<Observation>(*entry.message).time;
    return PictureEntry{entry.message, static_cast<std::int64_t>(state_at(exposed))};
  }
  // The picture and its observation are logged at the time when the picture was received.
  const auto place = image_at(camera, time);
  if (!place) return std::nullopt;
  const auto [first, last] =
      std::ranges::equal_range(observations, images_[camera][*place].time, {}, &Entry::time);
  if (first == last) return std::nullopt;
  return PictureEntry{first->message, static_cast<std::int64_t>(*place)};
}

std::optional<std::size_t> Recording::measured_state(std::size_t camera, double time) const {
  if (!images_.at(camera).empty()) return std::nullopt;
  const std::string& name = rig_->cameras[camera].config().name;
  const auto number_in = [&](const auto& pictures) -> std::optional<std::size_t> {
    for (const auto& picture : pictures)
      if (picture.observation.camera == name && picture.number)
        return static_cast<std::size_t>(*picture.number);
    return std::nullopt;
  };
  try {
    if (const auto shown = servo(time)) return number_in(shown->pictures);
    if (const auto shown = calibration(time)) return number_in(shown->pictures);
  } catch (const InputError&) {
    return std::nullopt;  // Damaged observations are ignored.
  }
  return std::nullopt;
}

std::optional<ShownServo> Recording::servo(double time) const {
  auto step = servo_step(time);
  if (!step) return std::nullopt;
  ShownServo shown{std::move(*step), {}};
  for (std::size_t camera = 0; camera < rig_->cameras.size(); ++camera)
    if (const auto entry = observation_at<ServoObservationMessage>(servo_observations_[camera], camera, time))
      shown.pictures.push_back({message_of<ServoObservationMessage>(*entry->message), entry->number});
  return shown;
}

std::optional<ShownCalibration> Recording::calibration(double time) const {
  if (decisions_.empty()) return std::nullopt;
  ShownCalibration shown;
  const auto has_begun = [&](const Entry& entry) { return seconds(entry.time) <= time; };
  const Entry& last = decisions_[place_at(decisions_, time)];
  std::uint64_t begun = 0;  // In ns. Observations before this belong to a calibration that has ended.
  if (has_begun(last)) {
    auto decision = message_of<CalibrationDecisionMessage>(*last.message);
    if (decision.ended.value_or(false)) {
      begun = last.time + 1;
    } else {
      shown.decision = std::move(decision);
    }
  }
  for (std::size_t camera = 0; camera < rig_->cameras.size(); ++camera) {
    const Entries& all = calibration_observations_[camera];
    const auto entry = observation_at<CalibrationObservationMessage>(all, camera, time);
    if (!entry || all[place_at(all, time)].time < begun || !has_begun(all[place_at(all, time)])) continue;
    shown.pictures.push_back({message_of<CalibrationObservationMessage>(*entry->message), entry->number});
  }
  if (!shown.decision && shown.pictures.empty()) return std::nullopt;
  return shown;
}

// The rig's time has additional steps while a task waits: interpolates between logged times.
std::optional<std::vector<ArmSample>> Recording::truth(double time) const {
  constexpr double rounding = 1e-6, longest = 0.5, late = 0.1;  // s
  if (truths_.empty() || seconds(truths_.front().time) > time + rounding) return std::nullopt;
  const std::size_t place = place_at(truths_, time + rounding);
  const Entry& before = truths_[place];
  const double begun = seconds(before.time);
  LoggedArm arm = logged_arm(message_of<PosesMessage>(*before.message));
  if (place + 1 < truths_.size() && seconds(truths_[place + 1].time) - begun <= longest) {
    const Entry& after = truths_[place + 1];
    const double part = std::max(0.0, time - begun) / (seconds(after.time) - begun);
    if (part > 0) arm = between(arm, logged_arm(message_of<PosesMessage>(*after.message)), part);
  } else if (time - begun > late) {
    return std::nullopt;
  }
  return samples_of(arm);
}

// Returns the message at or just before a time; std::nullopt if that is too old, or damaged.
template <class M>
std::optional<M> Recording::newest(const Entries& entries, double time) {
  constexpr double rounding = 1e-6, late = 0.1;  // s
  if (entries.empty()) return std::nullopt;
  const Entry& entry = entries[place_at(entries, time + rounding)];
  const double age = time - seconds(entry.time);
  if (age < -rounding || age > late) return std::nullopt;
  try {
    return message_of<M>(*entry.message);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

Recording::LoggedForces Recording::forces(double time) const {
  LoggedForces forces;
  forces.energy = newest<EnergyMessage>(energies_, time);
  if (const auto tensions = newest<TensionsMessage>(tensions_, time)) {
    forces.tensions = tensions->tensions;
    forces.lost_steps = tensions->lost_steps.value_or(std::vector<double>{});
  }
  if (auto contacts = newest<ContactsMessage>(contacts_, time))
    forces.contacts = std::move(contacts->contacts);
  return forces;
}

CameraStance Recording::stance(std::size_t camera, double time) const {
  CameraReading reading = rig_->first_reading(camera);
  try {
    if (const Entries& entries = heads_.at(camera); !entries.empty()) {
      const auto head = message_of<HeadReadingMessage>(*entries[place_at(entries, time)].message);
      reading.head = {head.pan, head.tilt, head.zoom};
    }
    if (const Entries& entries = stages_.at(camera); !entries.empty()) {
      const auto stage = message_of<StageReadingMessage>(*entries[place_at(entries, time)].message);
      reading.stage.offset = Eigen::Vector3d(stage.offset.data());
    }
  } catch (const InputError&) {
    return rig_->first_stance(camera);
  }
  return rig_->stance(camera, reading);
}

}  // namespace flexura
