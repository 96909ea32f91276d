#pragma once

#include <string_view>
#include <typeinfo>

#include "flexura/base/field.h"
#include "flexura/base/node.h"
#include "flexura/base/table.h"

namespace flexura {

/// A message for a log. A message can have any type with a table of fields. This object refers to the message
/// and the topic without copying them, so it is valid only during the call that receives it.
class LoggedMessage {
 public:
  /// `time`: time of the message in the log, s since the experiment's start.
  template <HasFields M>
  LoggedMessage(std::string_view topic, double time, const M& message)
      : topic_(topic),
        time_(time),
        message_(&message),
        type_(typeid(M)),
        schema_(fields_of(&message).info()),
        write_([](const void* value) { return Codec<M>::write(*static_cast<const M*>(value)); }) {}

  [[nodiscard]] std::string_view topic() const { return topic_; }
  [[nodiscard]] double time() const { return time_; }
  [[nodiscard]] const TableInfo& schema() const { return schema_; }
  /// Returns the message as the node that is written to the log.
  [[nodiscard]] Node node() const { return write_(message_); }
  /// Returns the message if its type is M, otherwise null.
  template <class M>
  [[nodiscard]] const M* as() const {
    return type_ == typeid(M) ? static_cast<const M*>(message_) : nullptr;
  }

 private:
  std::string_view topic_;
  double time_;
  const void* message_;
  const std::type_info& type_;
  const TableInfo& schema_;
  Node (*write_)(const void*);
};

}  // namespace flexura
