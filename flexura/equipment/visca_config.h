#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/camera/head.h"
#include "flexura/equipment/guard.h"
#include "flexura/equipment/visca_codec.h"

namespace flexura {

/// A serial line or a network address with one or more VISCA heads.
struct ViscaBusConfig {
  std::string link;  ///< Address as in parse_link_address().
  /// Default: `stream` for a serial line or TCP, `sony` for UDP port 52381, `datagram` for another UDP port.
  std::optional<ViscaFraming> framing = {};
  /// Whether the program numbers the heads of a chain at the start, beginning with 1. Default: only on a
  /// serial line.
  std::optional<bool> set_addresses = {};
  double reply_timeout = 0.25;  ///< Longest wait for the answer of a head, s; > 0, at most 10.
  std::int64_t tries = 3;  ///< Number of times that a message is sent before a head counts as lost; 1 to 20.
};

/// Pan or tilt of a VISCA head. Positions are in counts, as the head's manual lists them.
struct ViscaTurnConfig {
  double counts_per_degree =
      14.4;               ///< Counts per degree; below 0 if counts grow to the camera's right, or downwards.
  std::int64_t zero = 0;  ///< Count at the head's angle 0.
  std::array<std::int64_t, 2> limits = {-2448,
                                        2448};  ///< Smallest and largest count that the program commands.
  std::int64_t digits = 4;                      ///< Number of hexadecimal digits of a position; 4 or 5.
  std::int64_t speed = 24;     ///< Speed byte of moves, as the head's manual lists it; 0 to 24.
  std::int64_t tolerance = 2;  ///< Largest distance from the target at which a move counts as done, counts.
};
/// The pan axis. The defaults fit Sony EVI heads and most heads with the same commands.
struct ViscaPanConfig : ViscaTurnConfig {
  ViscaPanConfig() { counts_per_degree = -14.4; }
};
/// The tilt axis.
struct ViscaTiltConfig : ViscaTurnConfig {
  ViscaTiltConfig() { limits = {-432, 1296}, speed = 20; }
};

/// The zoom of a VISCA head.
struct ViscaZoomConfig {
  /// Zoom counts, ascending, 0 to 65535; at least 2. The first and the last count limit the commands.
  std::vector<std::int64_t> counts = {0, 0x4000};
  /// Zoom position (HeadState::zoom) at each of the counts, ascending. Between the counts, the zoom position
  /// is interpolated linearly. Default: the counts.
  std::optional<std::vector<double>> positions = {};
  std::int64_t tolerance = 16;  ///< Largest distance from the target at which zooming counts as done, counts.
};

/// A pan/tilt/zoom head that is moved by VISCA commands.
struct ViscaConfig {
  ViscaBusConfig bus;  ///< Connection to the head. Heads with the same link are on one chain.
  std::int64_t address =
      1;  ///< Address of the head: its place in the chain, 1 to 7. Over UDP, the address is always 1.
  ViscaPanConfig pan;
  ViscaTiltConfig tilt;
  ViscaZoomConfig zoom;
  /// Whether the program accepts a position only if two answers agree, because packets have no checksum.
  /// Default: true, except with the framing `sony`.
  std::optional<bool> confirm = {};
  /// Time for which a head may rest away from its target, s; > 0. After this time the command is repeated. A
  /// head must also stop within this time after a halt.
  double stall_time = 1;
};

const Table<ViscaBusConfig>& fields_of(const ViscaBusConfig*);
const Table<ViscaPanConfig>& fields_of(const ViscaPanConfig*);
const Table<ViscaTiltConfig>& fields_of(const ViscaTiltConfig*);
const Table<ViscaZoomConfig>& fields_of(const ViscaZoomConfig*);
const Table<ViscaConfig>& fields_of(const ViscaConfig*);

/// Returns the reason why a configuration is invalid; "" if it is valid.
[[nodiscard]] std::string visca_problem(const ViscaBusConfig& config);
[[nodiscard]] std::string visca_problem(const ViscaConfig& config);

/// Returns the configured framing, or its default. Throws std::invalid_argument for an invalid link.
[[nodiscard]] ViscaFraming visca_framing(const ViscaBusConfig& config);
/// Returns whether the program numbers the heads of a chain. Throws std::invalid_argument for an invalid
/// link.
[[nodiscard]] bool visca_sets_addresses(const ViscaBusConfig& config);
/// Returns the numbers of digits of positions.
[[nodiscard]] ViscaDigits visca_digits(const ViscaConfig& config);

/// Positions of a head's axes, counts.
struct ViscaCounts {
  std::int64_t pan = 0, tilt = 0, zoom = 0;
  bool operator==(const ViscaCounts&) const = default;
};
/// Returns the counts nearest to a state, within the limits. The state must be finite.
[[nodiscard]] ViscaCounts visca_counts(const ViscaConfig& config, const HeadState& state);
/// Returns the state at these counts, also outside the limits.
[[nodiscard]] HeadState visca_state(const ViscaConfig& config, const ViscaCounts& counts);

/// Returns a model of the head in which the resolution of each axis is at least one count of the head.
[[nodiscard]] HeadConfig with_visca_resolution(HeadConfig head, const ViscaConfig& config);

/// Returns the messages that stop a head (Guard).
[[nodiscard]] StopMessages visca_stop(const ViscaConfig& config);

}  // namespace flexura
