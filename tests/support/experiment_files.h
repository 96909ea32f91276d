#pragma once

#include <gtest/gtest.h>

#include <string>

#include "flexura/base/source.h"
#include "flexura/experiment/experiment.h"

namespace flexura {

/// Returns the error message for an experiment file "x.toml" with this text; "no error" if it is valid.
inline std::string error_of_file(const std::string& text) {
  try {
    (void)parse_experiment(text, "x.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// Returns the text with the first `from` replaced; a test failure if it does not occur.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// An invalid file and the expected text of its error.
struct BadFile {
  const char* what;
  std::string text;
  std::string error;
};

}  // namespace flexura
