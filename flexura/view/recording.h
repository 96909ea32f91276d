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

/// A run's results, ready to be looked at: its log by time. A value that does not change; threads share it.
/// Of a run that was killed, what its log holds up to the last complete chunk.
class Recording {
 public:
  /// Of a folder made by `flexura run`. InputError when it is none, or its log is damaged or without a
  /// state.
  explicit Recording(const std::filesystem::path& folder);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] const ViewedRigPtr& rig() const { return rig_; }
  [[nodiscard]] const std::vector<Mark>& marks() const { return marks_; }
  [[nodiscard]] double duration() const { return seconds(states_.back().time); }  ///< s
  /// The median time from one state to the next, s; 0 where there is one alone.
  [[nodiscard]] double interval() const { return interval_of(states_); }

  /// How many states there are, never 0; the place of the one at or just before `time` s, or the first.
  [[nodiscard]] std::size_t states() const { return states_.size(); }
  [[nodiscard]] std::size_t state_at(double time) const;
  /// When it was, s; and the arm's shape. InputError where the log holds none that fits the arm.
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
  /// InputError where the log holds none.
  [[nodiscard]] LoggedImage image(std::size_t camera, std::size_t place) const;
  /// Whether the log has a servo; and its last command at a time, s, while one steers the arm. InputError
  /// where the log holds none that can be read.
  [[nodiscard]] bool has_servo() const { return !servo_steps_.empty(); }
  [[nodiscard]] std::optional<ServoStep> servo_step(double time) const;
  /// With what it sees in the pictures that are shown then.
  [[nodiscard]] std::optional<ShownServo> servo(double time) const;
  /// The place of the state that a camera without film saw when a servo or a calibration, while one goes on,
  /// measured what is drawn at a time, s; none at other times.
  [[nodiscard]] std::optional<std::size_t> measured_state(std::size_t camera, double time) const;
  /// Whether the log has a calibration; and what it had decided at a time, s, and measured in the pictures
  /// that are shown then, while one goes on. InputError likewise.
  [[nodiscard]] bool has_calibration() const { return !decisions_.empty(); }
  [[nodiscard]] std::optional<ShownCalibration> calibration(double time) const;
  /// Whether the log has how the arm truly lay; and how at a time, s, its base first and its tip last: none
  /// where the log has it of no time near that. InputError where it is no arm.
  [[nodiscard]] bool has_truth() const { return !truths_.empty(); }
  [[nodiscard]] std::optional<std::vector<ArmSample>> truth(double time) const;
  /// Forces of an arm that is an elastic rod, as the log has them at or just before a time.
  struct LoggedForces {
    std::optional<EnergyMessage> energy;   ///< None: not known then.
    std::vector<double> tensions;          ///< N; empty: not known then.
    std::vector<double> lost_steps;        ///< Likewise.
    std::vector<ContactMessage> contacts;  ///< Empty: none.
  };
  /// At a time, s. What cannot be read is not known.
  [[nodiscard]] LoggedForces forces(double time) const;
  [[nodiscard]] bool has_energy() const { return !energies_.empty(); }    ///< Whether the log has it at all.
  [[nodiscard]] bool has_contacts() const { return !contacts_.empty(); }  ///< Likewise.
  [[nodiscard]] bool has_tensions() const { return !tensions_.empty(); }  ///< Likewise.
  /// How a camera stood at a time, s, as the log has it, or else (a damaged message, too) as the experiment
  /// starts.
  [[nodiscard]] CameraStance stance(std::size_t camera, double time) const;

 private:
  struct Entry {
    std::uint64_t time = 0;  // ns
    const McapMessage* message = nullptr;
  };
  using Entries = std::vector<Entry>;  // by time
  [[nodiscard]] static double seconds(std::uint64_t nanoseconds);
  [[nodiscard]] static std::size_t place_at(const Entries& entries, double time);
  void index();
  [[nodiscard]] static double interval_of(const Entries& entries);
  struct PictureEntry {
    const McapMessage* message = nullptr;
    std::int64_t number =
        0;  // of the picture: its place among the camera's, or of an unfilmed one the state's
  };
  template <class Sighting>
  [[nodiscard]] std::optional<PictureEntry> sighting_at(const Entries& sightings, std::size_t camera,
                                                        double time) const;
  void read_marks();
  void read_summary();
  void mark_violations(const Node& summary);

  std::filesystem::path folder_;
  ViewedRigPtr rig_;
  McapReader log_;
  Entries states_;
  std::vector<Entries> images_, heads_, stages_;  // by camera
  template <class M>
  [[nodiscard]] static std::optional<M> newest(const Entries& entries, double time);
  Entries truths_, energies_, tensions_, contacts_;
  Entries servo_steps_;
  std::vector<Entries> servo_sightings_, calibration_sightings_;  // by camera
  Entries decisions_;                                             // of calibrations
  double servo_interval_ = 0;  // from one command of a servo to the next, s
  std::vector<Mark> marks_;
  Conditioned end_ = {Condition::halted, "the results do not say how the run ended"};
};

using RecordingPtr = std::shared_ptr<const Recording>;

}  // namespace flexura
