#include "flexura/experiment/drive_commands.h"

#include <fmt/format.h>

#include <span>
#include <string>
#include <utility>

#include "flexura/kinematics/tendons.h"
#include "flexura/log/logged_message.h"
#include "flexura/log/messages.h"

namespace flexura {
namespace {

// Long lists are written in pieces, to limit the memory.
constexpr std::size_t piece = std::size_t{256} << 10;

}  // namespace

DriveCommands::DriveCommands(Arm arm, Drive drive, const std::filesystem::path& file)
    : arm_(std::move(arm)), drive_(std::move(drive)) {
  if (file.empty()) return;
  file_.emplace(file);
  rows_.cell("time");
  for (std::size_t i = 0; i < drive_.axes.size(); ++i) rows_.cell(drive_.axis_name(i));
  for (std::size_t i = 0; i < drive_.axes.size(); ++i) rows_.cell(drive_.axis_name(i) + "_rate");
  rows_.end_row();
}

void DriveCommands::step(double time, const ArmState& state, Recorder& recorder) {
  const TendonDisplacements desired = tendon_displacements(arm_, drive_, state);
  std::vector<std::int64_t> before;
  if (commander_) {
    before = commander_->positions();
    commander_->follow(desired);
  } else {
    commander_.emplace(drive_, desired);
    before = commander_->positions();
    time_ = time;
  }
  DriveCommandsMessage message{time, commander_->positions(), {}};
  for (std::size_t i = 0; i < before.size(); ++i) {
    const auto moved = static_cast<double>(message.positions[i] - before[i]);
    message.rates.push_back(time > time_ ? moved / (time - time_) : 0.0);
  }
  time_ = time;
  recorder.write({drive_commands_topic, message.time, message});
  if (!file_) return;
  rows_.cell(time);
  for (const std::int64_t position : message.positions) rows_.cell(fmt::format("{}", position));
  rows_.cells(message.rates);
  rows_.end_row();
  if (rows_.text().size() >= piece) write_rows();
}

std::vector<std::int64_t> DriveCommands::positions_after(std::span<const ArmState> way) const {
  std::optional<MotorCommander> commander = commander_;
  for (const ArmState& state : way) {
    const TendonDisplacements desired = tendon_displacements(arm_, drive_, state);
    if (!commander) commander.emplace(drive_, desired);
    commander->follow(desired);
  }
  return commander ? commander->positions() : std::vector<std::int64_t>{};
}

void DriveCommands::write_rows() {
  file_->append(std::as_bytes(std::span(rows_.text())));
  rows_ = {};
}

void DriveCommands::close() {
  if (!file_) return;
  write_rows();
  file_->close();
}

}  // namespace flexura
