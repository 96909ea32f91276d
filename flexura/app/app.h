#pragma once

namespace flexura {

/// Runs the command line program `flexura` and returns its exit status. 0: done; 1: the goal was not reached;
/// 2: bad input; 3: equipment or system failure. Never throws.
[[nodiscard]] int run_app(int argc, const char* const* argv) noexcept;

}  // namespace flexura
