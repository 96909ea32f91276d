#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/base/node.h"

namespace flexura {

/// A table that an export makes from messages of certain topics in a log.
class LogTable {
 public:
  virtual ~LogTable() = default;
  LogTable() = default;
  LogTable(const LogTable&) = delete;
  LogTable& operator=(const LogTable&) = delete;

  [[nodiscard]] virtual std::string file_name()
      const = 0;  ///< Returns the name of the table's file, such as "servo.csv".
  /// Returns true if the table needs messages of this topic.
  [[nodiscard]] virtual bool takes(std::string_view topic) const = 0;
  /// Adds a message of a topic that the table needs, in the order of the log. `time`: time of the message in
  /// the log, s. Throws InputError or std::runtime_error if the message is invalid.
  virtual void add(std::string_view topic, double time, const Node& message) = 0;
  /// Returns the text of the file; "" if no file is to be written.
  [[nodiscard]] virtual std::string text() const = 0;
};

using LogTables = std::vector<std::unique_ptr<LogTable>>;

}  // namespace flexura
