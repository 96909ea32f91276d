#include "flexura/log/export_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "flexura/base/table.h"
#include "flexura/log/messages.h"
#include "flexura/log/results.h"
#include "flexura/log/results_log.h"
#include "flexura/store/csv.h"
#include "flexura/store/json.h"
#include "flexura/store/mcap_reader.h"
#include "flexura/store/text_file.h"

namespace flexura {
namespace {

// Adds "base_1_x" and so on: users count sections from 1.
void name_columns(CsvText& csv, std::string_view stem, std::size_t count) {
  for (std::size_t i = 1; i <= count; ++i) csv.cell(fmt::format("{}_{}", stem, i));
}

// Adds the columns of the base positions of each `part`, and of the tip with its orientation.
void name_places(CsvText& csv, std::string_view part, std::size_t count) {
  for (std::size_t i = 0; i <= count; ++i) {
    const std::string stem = i < count ? fmt::format("{}_{}", part, i + 1) : "tip";
    for (const char axis : {'x', 'y', 'z'}) csv.cell(fmt::format("{}_{}", stem, axis));
  }
  for (const char axis : {'w', 'x', 'y', 'z'}) csv.cell(fmt::format("tip_q{}", axis));
}

void add_places(CsvText& csv, const PosesMessage& poses) {
  for (const PoseMessage& pose : poses.poses)
    csv.cells(std::array{pose.position.x, pose.position.y, pose.position.z});
  const QuaternionMessage& q = poses.poses.back().orientation;
  csv.cells(std::array{q.w, q.x, q.y, q.z});
}

void name_columns(CsvText& csv, const ArmStateMessage& state) {
  const std::size_t sections = state.bends.size();
  csv.cell("time");
  if (state.archings) name_columns(csv, "arching", sections);
  if (state.cord_angles) name_columns(csv, "cord_angle", sections);
  for (std::size_t i = 1; i <= sections; ++i) {
    csv.cell(fmt::format("bend_x_{}", i));
    csv.cell(fmt::format("bend_y_{}", i));
  }
  name_columns(csv, "stretch", sections);
  name_places(csv, "base", sections);
  csv.end_row();
}

void add_row(CsvText& csv, const ArmStateMessage& state, const PosesMessage& poses) {
  csv.cell(state.time);
  if (state.archings) csv.cells(*state.archings);
  if (state.cord_angles) csv.cells(*state.cord_angles);
  for (const auto& bend : state.bends) csv.cells(bend);
  csv.cells(state.stretches);
  add_places(csv, poses);
  csv.end_row();
}

// Checks the sizes: columns are those of one arm.
void check_sizes(const ArmStateMessage& state, std::size_t sections, const PosesMessage& poses) {
  const bool fits = state.bends.size() == sections && state.stretches.size() == sections &&
                    (!state.archings || state.archings->size() == sections) &&
                    (!state.cord_angles || state.cord_angles->size() == sections) &&
                    poses.poses.size() == sections + 1;
  if (!fits)
    throw std::runtime_error(fmt::format("the log's state at {} s does not fit the log's arm", state.time));
}

// /arm/state and /arm/poses, which follows it.
class StatesTable : public LogTable {
 public:
  [[nodiscard]] std::string file_name() const override { return "states.csv"; }
  [[nodiscard]] bool takes(std::string_view topic) const override {
    return topic == arm_state_topic || topic == arm_poses_topic;
  }
  void add(std::string_view topic, double /*time*/, const Node& message) override {
    if (topic == arm_state_topic) {
      state_ = read_as<ArmStateMessage>(message);
      if (!sections_) name_columns(csv_, *state_);
      sections_ = sections_.value_or(state_->bends.size());
    } else if (state_) {
      const auto poses = read_as<PosesMessage>(message);
      check_sizes(*state_, *sections_, poses);
      add_row(csv_, *state_, poses);
      state_.reset();
    }
  }
  [[nodiscard]] std::string text() const override {
    return sections_ ? csv_.text() : "time\n";  // For a run that was stopped at once.
  }

 private:
  CsvText csv_;
  std::optional<ArmStateMessage> state_;  // Waiting for its poses.
  std::optional<std::size_t> sections_;
};

// /arm/truth: the true arm, with equal numbers of arcs in all rows.
class TruthTable : public LogTable {
 public:
  [[nodiscard]] std::string file_name() const override { return "truth.csv"; }
  [[nodiscard]] bool takes(std::string_view topic) const override { return topic == arm_truth_topic; }
  void add(std::string_view /*topic*/, double time, const Node& message) override {
    const auto poses = read_as<PosesMessage>(message);
    if (poses.poses.empty()) return;
    if (!arcs_) {
      arcs_ = poses.poses.size() - 1;
      csv_.cell("time");
      name_places(csv_, "arc", *arcs_);
      csv_.end_row();
    }
    if (poses.poses.size() != *arcs_ + 1)
      throw std::runtime_error(fmt::format("the number of arcs of the log's true arm changes at {} s", time));
    csv_.cell(time);
    add_places(csv_, poses);
    csv_.end_row();
  }
  [[nodiscard]] std::string text() const override { return csv_.text(); }

 private:
  CsvText csv_;
  std::optional<std::size_t> arcs_;
};

// /arm/tensions: of the true arm's tendons.
class TensionsTable : public LogTable {
 public:
  [[nodiscard]] std::string file_name() const override { return "tensions.csv"; }
  [[nodiscard]] bool takes(std::string_view topic) const override { return topic == arm_tensions_topic; }
  void add(std::string_view /*topic*/, double time, const Node& message) override {
    const auto pulls = read_as<TensionsMessage>(message);
    if (!tendons_) {
      tendons_ = pulls.tensions.size();
      csv_.cell("time");
      for (std::size_t i = 1; i <= *tendons_; ++i) csv_.cell(fmt::format("tension_{}", i));
      csv_.end_row();
    }
    if (pulls.tensions.size() != *tendons_)
      throw std::runtime_error(
          fmt::format("the number of tendons of the log's true arm changes at {} s", time));
    csv_.cell(time);
    for (const double tension : pulls.tensions) csv_.cell(tension);
    csv_.end_row();
  }
  [[nodiscard]] std::string text() const override { return csv_.text(); }

 private:
  CsvText csv_;
  std::optional<std::size_t> tendons_;
};

// /arm/energy: of the true arm in motion.
class EnergyTable : public LogTable {
 public:
  [[nodiscard]] std::string file_name() const override { return "energy.csv"; }
  [[nodiscard]] bool takes(std::string_view topic) const override { return topic == arm_energy_topic; }
  void add(std::string_view /*topic*/, double time, const Node& message) override {
    const auto energy = read_as<EnergyMessage>(message);
    if (!has_head_) {
      for (const char* title : {"time", "kinetic", "strain", "gravity"}) csv_.cell(std::string_view(title));
      csv_.end_row();
      has_head_ = true;
    }
    for (const double value : {time, energy.kinetic, energy.strain, energy.gravity}) csv_.cell(value);
    csv_.end_row();
  }
  [[nodiscard]] std::string text() const override { return csv_.text(); }

 private:
  CsvText csv_;
  bool has_head_ = false;
};

// /arm/contacts: of the true arm in motion, a row per contact.
class ContactsTable : public LogTable {
 public:
  [[nodiscard]] std::string file_name() const override { return "contacts.csv"; }
  [[nodiscard]] bool takes(std::string_view topic) const override { return topic == arm_contacts_topic; }
  void add(std::string_view /*topic*/, double time, const Node& message) override {
    const auto touching = read_as<ContactsMessage>(message);
    if (!has_head_) {
      for (const char* title : {"time", "s", "with", "point_x", "point_y", "point_z", "force_x", "force_y",
                                "force_z", "depth", "normal_force", "sticks"})
        csv_.cell(std::string_view(title));
      csv_.end_row();
      has_head_ = true;
    }
    for (const ContactMessage& contact : touching.contacts) {
      csv_.cells(std::array{time, contact.s});
      csv_.cell(contact.with);
      csv_.cells(std::array{contact.point.x, contact.point.y, contact.point.z, contact.force.x,
                            contact.force.y, contact.force.z, contact.depth});
      cell_or_empty(contact.normal_force);
      cell_or_empty(contact.sticks);
      csv_.end_row();
    }
  }
  [[nodiscard]] std::string text() const override { return csv_.text(); }

 private:
  // Logs of other programs may lack the value.
  template <typename T>
  void cell_or_empty(const std::optional<T>& value) {
    if (value)
      csv_.cell(static_cast<double>(*value));
    else
      csv_.cell(std::string_view());
  }

  CsvText csv_;
  bool has_head_ = false;
};

class EventsTable : public LogTable {
 public:
  EventsTable() {
    for (const char* title : {"time", "level", "name", "message"}) csv_.cell(std::string_view(title));
    csv_.end_row();
  }
  [[nodiscard]] std::string file_name() const override { return "events.csv"; }
  [[nodiscard]] bool takes(std::string_view topic) const override { return topic == events_topic; }
  void add(std::string_view /*topic*/, double time, const Node& message) override {
    const auto event = read_as<EventMessage>(message);
    csv_.cell(time);
    csv_.cell(level_name(event.level));
    csv_.cell(event.name);
    csv_.cell(event.message);
    csv_.end_row();
  }
  [[nodiscard]] std::string text() const override { return csv_.text(); }

 private:
  CsvText csv_;
};

// Fills the tables from the log.
void fill(LogTables& tables, const McapReader& log, const std::string& name, Progress* progress) {
  std::size_t done = 0;
  for (const McapMessage& message : log.messages()) {
    if (progress != nullptr)
      progress->update(static_cast<double>(done++) / static_cast<double>(log.messages().size()), "tables");
    const std::string& topic = message.channel->topic;
    for (const auto& table : tables)
      if (table->takes(topic))
        table->add(topic, static_cast<double>(message.log_time) * 1e-9, parse_json(message.text(), name));
  }
}

}  // namespace

ExportResult export_csv(const std::filesystem::path& results, LogTables more, Progress* progress) {
  const McapReader log = open_log(results);
  LogTables tables;
  tables.push_back(std::make_unique<StatesTable>());
  tables.push_back(std::make_unique<TruthTable>());
  tables.push_back(std::make_unique<TensionsTable>());
  tables.push_back(std::make_unique<EnergyTable>());
  tables.push_back(std::make_unique<ContactsTable>());
  tables.push_back(std::make_unique<EventsTable>());
  std::ranges::move(more, std::back_inserter(tables));
  from_log([&] { fill(tables, log, (results / log_file_name).string(), progress); });
  ExportResult result{make_new_folder(results / "csv"), log_notes(log)};
  for (const auto& table : tables)
    if (const std::string text = table->text(); !text.empty())
      write_new_file(result.folder / table->file_name(), text);
  return result;
}

}  // namespace flexura
