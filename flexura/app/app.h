#pragma once

namespace flexura {

/// The command line program `flexura`. Returns the exit status: 0 done; 1 the run ended but missed what it
/// was asked; 2 bad input; 3 equipment or system failure. Never throws.
[[nodiscard]] int run_app(int argc, const char* const* argv) noexcept;

}  // namespace flexura
