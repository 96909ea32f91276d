#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "flexura/view/background.h"
#include "flexura/view/condition.h"
#include "flexura/view/live_rig.h"
#include "flexura/view/messenger.h"
#include "flexura/view/moves.h"
#include "flexura/view/picture_session.h"
#include "flexura/view/run_link.h"
#include "flexura/view/run_pace.h"
#include "flexura/view/run_reporter.h"
#include "flexura/view/session.h"

namespace flexura {

/// Session with a simulated rig that clients can move. During a run, the session shows the newest state of
/// the run.
class LiveSession : public PictureSession {
 public:
  struct Config {
    double start = 0;  ///< Initial time of the clock of advance(), s.
    /// Folder for the results of runs. If the folder exists, -2, -3, ... is appended.
    std::filesystem::path results;
    /// A run that was started outside this session. Clients can change its speed, but can neither cancel nor
    /// halt it, and cannot move anything during the run.
    std::shared_ptr<RunLink> run = {};
    double speed = 0;  ///< Initial speed of `run` relative to real time; 0: as fast as possible.
  };

  LiveSession(const ViewedRigPtr& rig, Messenger& messenger, Background& background, Config config);

  /// Cancels a run that this session has started. Does not wait for the run's end.
  void cancel();

  [[nodiscard]] Hello hello() const override;
  void opened(ClientId client) override;
  void closed(ClientId client) override;
  void take(ClientId client, const Ask& ask, Reply reply) override;
  void take(const Document& document, std::function<void(HttpAnswer)> answer) override;
  [[nodiscard]] RigInstant instant(ClientId client) override;
  void advance(double now) override;

  /// Returns the results folder of the last finished run with results.
  [[nodiscard]] const std::optional<std::filesystem::path>& results() const { return results_; }
  /// Returns whether tasks are running, started in this session or outside.
  [[nodiscard]] bool is_running() const { return run_ != nullptr; }
  /// Returns whether a run can only continue if advance() is called, even without connected clients.
  [[nodiscard]] bool is_pacing() const { return is_watched_run() && run_ != nullptr && pace_->speed() > 0; }
  /// Returns whether a run started outside this session has ended.
  [[nodiscard]] bool is_over() const { return is_watched_run() && run_ == nullptr; }

 private:
  struct Taker;
  // A requested move that is being checked or waits for its check.
  struct Move {
    std::variant<ArmState, TipRequest, TendonPull> target;
    double duration = 0;
    Reply reply;
  };
  // The result of the check of a move.
  struct Judged {
    ArmState state;
    std::optional<InverseResult> found;
    std::string danger;
  };
  static Judged judge(const ViewedRig& rig, const ArmState& from, const Move& move);

  [[nodiscard]] bool is_watched_run() const { return config_.run != nullptr; }
  [[nodiscard]] Look look(const ImageStreams::Key& key) override { return look_at_sent(key); }
  void require_free() const;
  void move(Move move);
  void look_at(Move move);
  void finish(const Move& move, const Judged& judged);
  void start_run(const RunRequest& request, const Reply& reply);
  void follow_run();
  void stay_where_it_ended();
  void aim_at_readings();
  void halt();
  void reset();
  void weigh(bool on);
  void push(ClientId client, const PushRequest& request);
  void release();
  void watch_yielding();
  void report_pace();
  [[nodiscard]] Conditioned condition();
  [[nodiscard]] std::string run_danger();
  void report_condition();
  void keep_clear(double next);
  void move_on(double next);
  void report_warning();
  void send_states();
  void send_images();
  [[nodiscard]] bool is_run_shown() const { return run_ != nullptr && news_.time; }
  [[nodiscard]] Backbone shown_backbone();
  [[nodiscard]] std::vector<CameraStance> run_stances() const;
  [[nodiscard]] ValueShot newest_shot(std::size_t camera);
  [[nodiscard]] const RunLink::Measured* measured(std::size_t camera) const;
  [[nodiscard]] ValueShot measured_shot(std::size_t camera, const RunLink::Measured& seen);
  [[nodiscard]] const TrueArm* run_truth() const;
  void event(const char* level, const std::string& name, const std::string& text);
  void notice(const char* level, const std::string& name, const std::string& text);
  void warn(const std::string& text);
  void broadcast(const Node& message);

  Config config_;
  double clock_ = 0;  // Time of advance(), s.
  LiveRig rig_;
  std::vector<HeadState> head_targets_;  // Last commanded targets, by camera.
  std::vector<StageState> stage_targets_;
  std::uint32_t sequence_ = 0;
  std::uint16_t leaps_ = 0;
  std::set<ClientId> clients_;
  bool is_looking_ = false;
  std::optional<Move> waiting_;
  std::uint64_t generation_ = 0;  // Moves of an older generation are discarded.
  bool is_touching_ = false;
  std::optional<ClientId> pushing_client_;  // Client that pushes the arm.
  bool is_slow_ = false;
  double warned_ = -1;   // Time of the last warning, s.
  std::string warning_;  // Last warning sent about the arm's state.
  std::shared_ptr<RunLink> run_;
  RunLink::News news_;           // Newest news of the run.
  std::optional<RunPace> pace_;  // Pace of a run that was started in this session.
  double paced_at_ = 0;          // Time of advance() at the last pacing, s.
  RunReporter reporter_;
  std::optional<std::filesystem::path> results_;
  // Condition after tasks or a halt, valid until something is moved; and the condition that clients know.
  std::optional<Conditioned> left_;
  Conditioned reported_;
};

}  // namespace flexura
