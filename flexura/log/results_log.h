#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
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

/// Opens a log, and skips its damaged chunks (log_notes). Throws InputError if the file is empty, is not a
/// log, or is damaged between its chunks.
[[nodiscard]] McapReader open_log_file(const std::filesystem::path& file);
/// Opens the log of a results folder. Throws InputError if the log is missing, and as open_log_file().
[[nodiscard]] McapReader open_log(const std::filesystem::path& results);

/// Returns what is missing in a log, one sentence each: the rest of an interrupted run, and damaged chunks.
[[nodiscard]] std::vector<std::string> log_notes(const McapReader& log);

}  // namespace flexura
