#pragma once

#include <gtest/gtest.h>

#include <string>

#include "flexura/base/source.h"
#include "flexura/experiment/experiment.h"

namespace flexura {

/// What is said of an experiment file "x.toml" with this text; "no error" of a good one.
inline std::string error_of_file(const std::string& text) {
  try {
    (void)parse_experiment(text, "x.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// The text with its first `from` replaced; a failure where there is none.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// A text and what its error must say.
struct BadFile {
  const char* what;
  std::string text;
  std::string error;
};

}  // namespace flexura
