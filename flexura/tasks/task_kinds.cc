#include "flexura/tasks/task_kinds.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "flexura/base/table.h"
#include "flexura/tasks/task_runner.h"

namespace flexura {
namespace {

template <class Kind>
concept HasFiles =
    requires(Kind& task, const Setup& setup, const Node& written, const std::string& path,
             std::vector<Problem>& problems) { read_files(task, setup, written, path, problems); };

template <class Kind>
concept HasTables = requires(const Kind* null) { log_tables(null); };

template <class Kind>
void add_tables(LogTables& tables) {
  if constexpr (HasTables<Kind>)
    std::ranges::move(log_tables(static_cast<const Kind*>(nullptr)), std::back_inserter(tables));
}

template <class... Kinds>
LogTables tables_of(const std::variant<Kinds...>*) {
  LogTables tables;
  (add_tables<Kinds>(tables), ...);
  return tables;
}

}  // namespace

std::string task_name(const TaskConfig& task) {
  return std::visit(
      [&](const auto& one) { return one.name.empty() ? std::string(task_kind(task)) : one.name; }, task);
}

std::string_view task_kind(const TaskConfig& task) {
  return std::visit(
      []<class T>(const T&) -> std::string_view {
        return fields_of(static_cast<const T*>(nullptr)).info().name;
      },
      task);
}

void check_task(const TaskConfig& task, const Setup& setup, const std::string& path, Reader& reader) {
  std::visit([&](const auto& one) { check_keys(one, setup, path, reader); }, task);
}

void read_task_files(TaskConfig& task, const Setup& setup, const Node& written, const std::string& path,
                     std::vector<Problem>& problems) {
  std::visit(
      [&]<class Kind>(Kind& one) {
        if constexpr (HasFiles<Kind>) read_files(one, setup, written, path, problems);
      },
      task);
}

std::unique_ptr<TaskRunner> task_runner(const TaskConfig& task, const Setup& setup, std::size_t number) {
  return std::visit(
      [&](const auto& one) { return runner_of(one, setup, TaskLabel{task_name(task), number}); }, task);
}

LogTables task_tables() { return tables_of(static_cast<const TaskConfig*>(nullptr)); }

}  // namespace flexura
