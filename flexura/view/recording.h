#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "flexura/log/messages.h"
#include "flexura/log/results_log.h"
#include "flexura/store/mcap_reader.h"
#include "flexura/tasks/servo/servo_messages.h"
#include "flexura/view/calibration_extras.h"
#include "flexura/view/condition.h"
#include "flexura/view/describe.h"
#include "flexura/view/servo_extras.h"
#include "flexura/view/viewed_rig.h"

namespace flexura {

/// Results of a run, prepared for viewing: the content of the log by time. A Recording is immutable, so that
/// threads can share it. For a run that was killed, a Recording has the log up to the last complete chunk.
class Recording {
 public:
  /// Opens a results folder of `flexura run`. Throws InputError if the folder is not a results folder, or if
  /// its log is damaged or has no state.
  explicit Recording(const std::filesystem::path& folder);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] const ViewedRigPtr& rig() const { return rig_; }
  /// Returns what is missing in the log (log_notes).
  [[nodiscard]] std::vector<std::string> notes() const { return log_notes(log_); }
  [[nodiscard]] const std::vector<Mark>& marks() const { return marks_; }
  [[nodiscard]] double duration() const {
    return seconds(states_.back().time);
  }  ///< Returns the time of the last state, s.
  /// Returns the median time between consecutive states, s; 0 if there is only one state.
  [[nodiscard]] double interval() const { return interval_of(states_); }

  /// Returns the number of states, which is never 0.
  [[nodiscard]] std::size_t states() const { return states_.size(); }
  /// Returns the index of the last state at or before `time` (s); 0 before the first state.
  [[nodiscard]] std::size_t state_at(double time) const;
  /// Returns the time of state number `place`, s.
  [[nodiscard]] double time_of_state(std::size_t place) const { return seconds(states_.at(place).time); }
  /// Returns the arm's shape in state number `place`. Throws InputError if the logged shape does not fit the
  /// arm.
  [[nodiscard]] ArmState state(std::size_t place) const;
  /// Returns the run's condition at a time, s. The condition is `unsafe` while a limit is violated, and
  /// otherwise `running`. At the end, the result is the condition in the results file.
  [[nodiscard]] Conditioned condition(double time) const;
  /// Returns the result of the run in one line, as in its summary; "" if the summary has none.
  [[nodiscard]] const std::string& headline() const { return headline_; }

  /// Returns how many images of a camera the log has.
  [[nodiscard]] std::size_t images(std::size_t camera) const { return images_.at(camera).size(); }
  /// Returns the index of a camera's last image at or before `time` (s); std::nullopt before the first image.
  [[nodiscard]] std::optional<std::size_t> image_at(std::size_t camera, double time) const;
  struct LoggedImage {
    double time = 0;  ///< Middle of the exposure, s.
    std::string png;
  };
  /// Returns an image. Throws InputError if the log has no image with this number.
  [[nodiscard]] LoggedImage image(std::size_t camera, std::size_t place) const;
  /// Returns whether the log has commands of a servo.
  [[nodiscard]] bool has_servo() const { return !servo_steps_.empty(); }
  /// Returns the servo's last command at a time, s; std::nullopt if no servo controls the arm at that time.
  /// Throws InputError if the logged command is invalid.
  [[nodiscard]] std::optional<ServoStep> servo_step(double time) const;
  /// Returns the servo's last command at a time, s, with its observations in the pictures shown at that time.
  [[nodiscard]] std::optional<ShownServo> servo(double time) const;
  /// Measurements drawn at a time (s) belong to a picture: returns the index of the state at which this
  /// picture was taken. A servo or a calibration has measured the picture. Returns std::nullopt for a camera
  /// with logged images, and at times without an active servo or calibration.
  [[nodiscard]] std::optional<std::size_t> measured_state(std::size_t camera, double time) const;
  /// Returns whether the log has a calibration.
  [[nodiscard]] bool has_calibration() const { return !decisions_.empty(); }
  /// Returns the last decision of the calibration at a time, s, with its observations in the pictures shown
  /// at that time. Returns std::nullopt if no calibration is active at that time. Throws InputError if the
  /// logged decision is invalid.
  [[nodiscard]] std::optional<ShownCalibration> calibration(double time) const;
  /// Returns whether the log has the true arm.
  [[nodiscard]] bool has_truth() const { return !truths_.empty(); }
  /// Returns the samples of the true arm from base to tip at a time, s; std::nullopt if the log has no true
  /// arm near that time. Throws InputError if the logged arm is invalid.
  [[nodiscard]] std::optional<std::vector<ArmSample>> truth(double time) const;
  /// Forces on an arm that is an elastic rod, as logged at or just before a time.
  struct LoggedForces {
    std::optional<EnergyMessage> energy;   ///< Energies; missing: unknown at that time.
    std::vector<double> tensions;          ///< Tension of each tendon, N; empty: unknown at that time.
    std::vector<double> lost_steps;        ///< Microsteps lost by each motor; empty: unknown at that time.
    std::vector<ContactMessage> contacts;  ///< Contacts of the arm; empty: no contacts.
  };
  /// Returns the logged tendon tensions, contacts and other forces at a time, s. Values of invalid messages
  /// count as unknown.
  [[nodiscard]] LoggedForces forces(double time) const;
  /// Returns whether the log has energies.
  [[nodiscard]] bool has_energy() const { return !energies_.empty(); }
  /// Returns whether the log has contacts.
  [[nodiscard]] bool has_contacts() const { return !contacts_.empty(); }
  /// Returns whether the log has tensions.
  [[nodiscard]] bool has_tensions() const { return !tensions_.empty(); }
  /// Returns the camera axis positions logged at a time, s. If there is no message or a damaged one, returns
  /// the positions at the start of the experiment.
  [[nodiscard]] CameraStance stance(std::size_t camera, double time) const;

 private:
  struct Entry {
    std::uint64_t time = 0;  // ns
    const McapMessage* message = nullptr;
  };
  using Entries = std::vector<Entry>;  // Ordered by time.
  [[nodiscard]] static double seconds(std::uint64_t nanoseconds);
  [[nodiscard]] static std::size_t place_at(const Entries& entries, double time);
  void index();
  [[nodiscard]] static double interval_of(const Entries& entries);
  struct PictureEntry {
    const McapMessage* message = nullptr;
    std::int64_t number = 0;  // Number of the picture: its index among the camera's images or, for a camera
                              // without images, that of the state.
  };
  template <class Observation>
  [[nodiscard]] std::optional<PictureEntry> observation_at(const Entries& observations, std::size_t camera,
                                                           double time) const;
  void read_marks();
  void read_summary();
  void mark_violations(const Node& summary);

  std::filesystem::path folder_;
  ViewedRigPtr rig_;
  McapReader log_;
  Entries states_;
  std::vector<Entries> images_, heads_, stages_;  // Entries of each camera.
  template <class M>
  [[nodiscard]] static std::optional<M> newest(const Entries& entries, double time);
  Entries truths_, energies_, tensions_, contacts_;
  Entries servo_steps_;
  std::vector<Entries> servo_observations_, calibration_observations_;  // Entries of each camera.
  Entries decisions_;                                                   // Decisions of calibrations.
  double servo_interval_ = 0;  // Interval between commands of a servo, s.
  std::vector<Mark> marks_;
  std::string headline_;
  Conditioned end_ = {Condition::halted, "the results do not say how the run ended"};
};

using RecordingPtr = std::shared_ptr<const Recording>;

}  // namespace flexura
