#include "flexura/app/compare_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>

#include "flexura/base/degree.h"
#include "flexura/base/node.h"
#include "flexura/base/work_progress.h"
#include "flexura/log/messages.h"
#include "flexura/log/results_log.h"
#include "flexura/report/comparison.h"
#include "flexura/store/json.h"
#include "flexura/tasks/servo/servo_messages.h"

namespace flexura {
namespace {

constexpr std::size_t most_sections = 8;
constexpr std::array<std::string_view, 3> axes = {"x", "y", "z"};

// What a log has over time.
struct Courses {
  std::array<TimedValues, 3> tip, true_tip;       // In m.
  std::vector<std::array<TimedValues, 2>> bends;  // Of each section, deg.
  TimedValues error;                              // Of servos: share of the length, power of ten.
};

void add(double time, double value, TimedValues& course) {
  // Some times are logged twice, as at the end of a task.
  if (!course.times.empty() && time <= course.times.back()) return;
  course.times.push_back(time), course.values.push_back(value);
}

std::optional<double> number_at(const Node& node, std::string_view key) {
  const Node* value = node.find(key);
  if (value == nullptr) return std::nullopt;
  if (const auto* whole = value->as<std::int64_t>()) return static_cast<double>(*whole);
  const auto* real = value->as<double>();
  return real == nullptr || !std::isfinite(*real) ? std::nullopt : std::optional(*real);
}

void add_tip(double time, const Node& message, std::array<TimedValues, 3>& tip) {
  const Node* poses = message.find("poses");
  const auto* list = poses == nullptr ? nullptr : poses->as<Node::Array>();
  if (list == nullptr || list->empty()) return;
  const Node* position = list->back().find("position");
  if (position == nullptr) return;
  for (std::size_t i = 0; i < 3; ++i)
    if (const auto value = number_at(*position, axes[i])) add(time, *value, tip[i]);
}

void add_bends(double time, const Node& message, Courses& courses) {
  const Node* bends = message.find("bends");
  const auto* list = bends == nullptr ? nullptr : bends->as<Node::Array>();
  if (list == nullptr) return;
  courses.bends.resize(std::max(courses.bends.size(), std::min(list->size(), most_sections)));
  for (std::size_t k = 0; k < std::min(list->size(), most_sections); ++k) {
    const auto* pair = (*list)[k].as<Node::Array>();
    for (std::size_t i = 0; pair != nullptr && i < std::min<std::size_t>(pair->size(), 2); ++i)
      if (const auto* value = (*pair)[i].as<double>()) add(time, *value / degree, courses.bends[k][i]);
  }
}

Courses courses_of(const std::string& folder, Progress& progress) {
  constexpr double least_error = 1e-7;
  const McapReader log = open_log(folder);
  Courses courses;
  std::size_t done = 0;
  for (const McapMessage& message : log.messages()) {
    progress.update(static_cast<double>(done++) / static_cast<double>(log.messages().size()), folder);
    const std::string& topic = message.channel->topic;
    const bool is_truth = topic == arm_truth_topic;
    if (topic != arm_state_topic && topic != arm_poses_topic && topic != servo_steps_topic && !is_truth)
      continue;
    const Node node = parse_json(message.text(), folder);
    const double time = 1e-9 * static_cast<double>(message.log_time);
    if (topic == arm_poses_topic) add_tip(time, node, courses.tip);
    if (is_truth) add_tip(time, node, courses.true_tip);
    if (topic == arm_state_topic) add_bends(time, node, courses);
    if (topic == servo_steps_topic)
      if (const auto rms = number_at(node, "rms"))
        add(time, std::log10(std::max(*rms, least_error)), courses.error);
  }
  return courses;
}

bool changes(const TimedValues& a, const TimedValues& b) {
  constexpr double invisible = 1e-9;
  if (a.times.empty() && b.times.empty()) return false;
  double least = a.values.empty() ? b.values.front() : a.values.front(), most = least;
  for (const TimedValues* course : {&a, &b})
    for (const double value : course->values) least = std::min(least, value), most = std::max(most, value);
  return most - least > invisible;
}

// Adds a chart unless nothing changes in it.
void draw(const std::string& name, const std::string& heading, const std::string& label, double least,
          const TimedValues& a, const TimedValues& b, std::vector<ReportFigure>& figures) {
  if (changes(a, b)) figures.push_back({name, overlaid_chart(heading, label, least, a, b)});
}

void draw_tips(const std::string& name, const std::string& heading, const std::array<TimedValues, 3>& a,
               const std::array<TimedValues, 3>& b, std::vector<ReportFigure>& figures) {
  for (std::size_t i = 0; i < 3; ++i)
    draw(fmt::format("{}-{}", name, axes[i]), heading, fmt::format("{} (m)", "XYZ"[i]), 1e-4, a[i], b[i],
         figures);
}

// Adds the distance between the tips while both runs last.
void draw_distance(const Courses& a, const Courses& b, std::vector<ReportFigure>& figures) {
  if (a.tip[0].times.empty() || b.tip[0].times.empty()) return;
  std::array<LineChart, 3> both;
  for (std::size_t i = 0; i < 3; ++i) both[i] = overlaid_chart("", "", 0, a.tip[i], b.tip[i]);
  LineChart chart{.heading = "distance between the tips of A and B",
                  .x_label = "t (s)",
                  .value_label = "mm",
                  .least = 0.01,
                  .series = {{.name = "distance", .values = {}}}};
  for (std::size_t k = 0; k < both[0].x.size(); ++k) {
    double square = 0;
    for (const LineChart& one : both)
      square += std::pow(one.series[0].values.at(k) - one.series[1].values.at(k), 2);
    chart.x.push_back(both[0].x[k]);
    chart.series[0].values.push_back(1e3 * std::sqrt(square));
  }
  figures.push_back({"tip-distance", std::move(chart)});
}

}  // namespace

std::vector<ReportFigure> comparison_figures(const std::string& a, const std::string& b, Progress& progress) {
  WorkProgress work(progress, {1, 1});
  const Courses first = from_log([&] { return courses_of(a, work.piece(0)); }),
                second = from_log([&] { return courses_of(b, work.piece(1)); });
  std::vector<ReportFigure> figures;
  draw_tips("tip", "end effector", first.tip, second.tip, figures);
  draw_distance(first, second, figures);
  if (!first.true_tip[0].times.empty() && !second.true_tip[0].times.empty())
    draw_tips("true-tip", "true end effector", first.true_tip, second.true_tip, figures);
  static const std::array<TimedValues, 2> none;
  for (std::size_t k = 0; k < std::max(first.bends.size(), second.bends.size()); ++k)
    for (std::size_t i = 0; i < 2; ++i)
      draw(fmt::format("bend-{}-{}", k + 1, axes[i]), fmt::format("section {}", k + 1),
           fmt::format("bend_{} (deg)", axes[i]), 0.1, k < first.bends.size() ? first.bends[k][i] : none[i],
           k < second.bends.size() ? second.bends[k][i] : none[i], figures);
  draw("servo-error", "servo: distance from the target shape, rms", "share of the length", 1, first.error,
       second.error, figures);
  if (!figures.empty() && figures.back().name == "servo-error")
    std::get<LineChart>(figures.back().content).is_log = true;
  return figures;
}

}  // namespace flexura
