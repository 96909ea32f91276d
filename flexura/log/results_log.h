#pragma once

#include <filesystem>
#include <stdexcept>
#include <vector>

#include "flexura/base/source.h"
#include "flexura/store/mcap_reader.h"

namespace flexura {

/// Calls `read` and returns its result. If `read` throws because the log is damaged, throws InputError
/// instead.
template <class Read>
auto from_log(Read&& read) {
  try {
    return read();
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw InputError(std::vector<Problem>{{{}, error.what()}});
  }
}

/// Returns the path of the file `name` in a results folder. Throws InputError if the file is missing, or is a
/// link to a place outside the folder.
[[nodiscard]] std::filesystem::path file_of_results(const std::filesystem::path& results, const char* name);

/// Opens the log of a results folder. Throws InputError if the log is missing or damaged.
[[nodiscard]] McapReader open_log(const std::filesystem::path& results);

}  // namespace flexura
