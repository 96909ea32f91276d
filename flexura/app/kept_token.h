#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace flexura {

/// Where this user keeps what no other may read: $XDG_RUNTIME_DIR/flexura, or else flexura/viewer under
/// $XDG_CACHE_HOME or ~/.cache; "" where the environment names none of these.
[[nodiscard]] std::filesystem::path private_folder();

/// The token of the viewer on a port, kept in the file "token-PORT" of a folder for a day, so that a page
/// comes in again after the program was started again (docs/viewer-protocol.md says why that is safe). The
/// folder and the file must be this user's own and nobody else's to read, and are made so where they are
/// missing; a file that is not is made anew. A new token, kept nowhere, where there is no such folder.
/// std::system_error when the system has no random bytes.
[[nodiscard]] std::string kept_token(const std::filesystem::path& folder, std::uint16_t port);

}  // namespace flexura
