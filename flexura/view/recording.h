#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "flexura/log/messages.h"
#include "flexura/store/mcap_reader.h"
#include "flexura/tasks/servo/servo_messages.h"
#include "flexura/view/calibration_extras.h"
#include "flexura/view/condition.h"
#include "flexura/view/describe.h"
#include "flexura/view/servo_extras.h"
#include "flexura/view/viewed_rig.h"

namespace flexura {

/// Results of a run, ready for viewing: its log by time. Immutable and shared by threads. For a run that was
/// killed, it holds the log up to the last complete chunk.
class Recording {
 public:
  /// Opens a folder created by `flexura run`. Throws InputError if it is not one, or if its log is damaged or
  /// has no state.
  explicit Recording(const std::filesystem::path& folder);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] const ViewedRigPtr& rig() const { return rig_; }
  /// Returns whether the log has no end: the run was killed.
  [[nodiscard]] bool is_truncated() const { return log_.truncated(); }
  [[nodiscard]] const std::vector<Mark>& marks() const { return marks_; }
  [[nodiscard]] double duration() const { return seconds(states_.back().time); }  ///< s
  /// Returns the median time between consecutive states, s; 0 if there is only one.
  [[nodiscard]] double interval() const { return interval_of(states_); }

  /// Returns the number of states, never 0, and the index of the state at or just before `time` s, or the
  /// first.
  [[nodiscard]] std::size_t states() const { return states_.size(); }
  [[nodiscard]] std::size_t state_at(double time) const;
  /// Returns the time of a state, s, and the arm's shape. Throws InputError if the log has no shape that fits
  /// the arm.
  [[nodiscard]] double time_of_state(std::size_t place) const { return seconds(states_.at(place).time); }
  [[nodiscard]] ArmState state(std::size_t place) const;
  /// The run's condition at a time, s: unsafe while a limit is broken, at its end as its results say, else
  /// running.
  [[nodiscard]] Conditioned condition(double time) const;

  /// How many images the log has of a camera; the place of the one that came at or just before `time` s; none
  /// before the first.
  [[nodiscard]] std::size_t images(std::size_t camera) const { return images_.at(camera).size(); }
  [[nodiscard]] std::optional<std::size_t> image_at(std::size_t camera, double time) const;
  struct LoggedImage {
    double time = 0;  ///< Middle of its exposure, s.
    std::string png;
  };
  /// Throws InputError if the log has no such image.
  [[nodiscard]] LoggedImage image(std::size_t camera, std::size_t place) const;
  /// Returns whether the log has a servo, and its last command at a time, s, while a servo controls the arm.
  /// Throws InputError if the log has no readable command.
  [[nodiscard]] bool has_servo() const { return !servo_steps_.empty(); }
  [[nodiscard]] std::optional<ServoStep> servo_step(double time) const;
  /// Returns the servo's command, with its observations in the pictures shown at that time.
  [[nodiscard]] std::optional<ShownServo> servo(double time) const;
  /// The place of the state that a camera without film saw when a servo or a calibration, while one goes on,
  /// measured what is drawn at a time, s; none at other times.
  [[nodiscard]] std::optional<std::size_t> measured_state(std::size_t camera, double time) const;
  /// Whether the log has a calibration; and what it had decided at a time, s, and measured in the pictures
  /// that are shown then, while one goes on. InputError likewise.
  [[nodiscard]] bool has_calibration() const { return !decisions_.empty(); }
  [[nodiscard]] std::optional<ShownCalibration> calibration(double time) const;
  /// Returns whether the log has the true arm, and its samples at a time, s, from base to tip. Returns
  /// std::nullopt if the log has none near that time. Throws InputError if the logged arm is invalid.
  [[nodiscard]] bool has_truth() const { return !truths_.empty(); }
  [[nodiscard]] std::optional<std::vector<ArmSample>> truth(double time) const;
  /// Forces of an elastic-rod arm, as logged at or just before a time.
  struct LoggedForces {
    std::optional<EnergyMessage> energy;   ///< Missing: unknown at that time.
    std::vector<double> tensions;          ///< N; empty: unknown at that time.
    std::vector<double> lost_steps;        ///< Microsteps of each motor; empty: unknown at that time.
    std::vector<ContactMessage> contacts;  ///< Empty: no contacts.
  };
  /// Returns the forces at a time, s. Messages that cannot be read count as unknown.
  [[nodiscard]] LoggedForces forces(double time) const;
  /// Whether the log has energies at all.
  [[nodiscard]] bool has_energy() const { return !energies_.empty(); }
  /// Whether the log has contacts at all.
  [[nodiscard]] bool has_contacts() const { return !contacts_.empty(); }
  /// Whether the log has tensions at all.
  [[nodiscard]] bool has_tensions() const { return !tensions_.empty(); }
  /// Returns the camera axis positions logged at a time, s. Without a message, or with a damaged one, returns
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
    std::int64_t number =
        0;  // of the picture: its place among the camera's, or of an unfilmed one the state's
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
  std::vector<Entries> images_, heads_, stages_;  // By camera.
  template <class M>
  [[nodiscard]] static std::optional<M> newest(const Entries& entries, double time);
  Entries truths_, energies_, tensions_, contacts_;
  Entries servo_steps_;
  std::vector<Entries> servo_observations_, calibration_observations_;  // By camera.
  Entries decisions_;                                                   // Decisions of calibrations.
  double servo_interval_ = 0;  // Interval between commands of a servo, s.
  std::vector<Mark> marks_;
  Conditioned end_ = {Condition::halted, "the results do not say how the run ended"};
};

using RecordingPtr = std::shared_ptr<const Recording>;

}  // namespace flexura
