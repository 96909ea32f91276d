#include "flexura/view/campaign_watcher.h"

#include <algorithm>
#include <exception>

#include "flexura/base/node.h"
#include "flexura/base/one_line.h"
#include "flexura/campaign/campaign_report.h"
#include "flexura/store/json.h"
#include "flexura/view/answers.h"

namespace flexura {
namespace {

constexpr double reading_interval = 1;  // s

Node number_or_nothing(const std::optional<double>& value) { return value ? Node{*value, {}} : Node{}; }

Node statuses_node(const CampaignCounts& counts) {
  Node::Table table;
  for (const auto& [status, count] : counts.statuses) table.push_back({status, {}, {count, {}}});
  return {std::move(table), {}};
}

Node histograms_node(const std::vector<CampaignHistogram>& histograms) {
  Node::Array list;
  for (const CampaignHistogram& one : histograms) {
    Node::Array bins;
    for (const std::int64_t count : one.bins) bins.push_back({count, {}});
    list.push_back({Node::Table{{"name", {}, text_node(one.name)},
                                {"low", {}, {one.low, {}}},
                                {"high", {}, {one.high, {}}},
                                {"bins", {}, {std::move(bins), {}}}},
                    {}});
  }
  return {std::move(list), {}};
}

}  // namespace

CampaignWatcher::CampaignWatcher(std::filesystem::path file, Messenger& messenger, Background& background)
    : file_(std::move(file)), messenger_(messenger), background_(background) {}

void CampaignWatcher::opened(ClientId client) {
  clients_.insert(client);
  if (!text_.empty()) messenger_.send(client, text_);
}

void CampaignWatcher::closed(ClientId client) { clients_.erase(client); }

CampaignWatcher::Reading CampaignWatcher::read(const std::filesystem::path& file, double time) {
  Reading reading;
  reading.time = time;
  try {
    // Opened each time, since the file may have been replaced.
    CampaignResults results(file);
    reading.total = results.campaign().design().runs();
    reading.counts = results.counts();
    reading.histograms = histograms_of(results);
  } catch (const std::exception& error) {
    reading.error = one_line(error.what());
  }
  return reading;
}

void CampaignWatcher::advance(double now) {
  clock_ = now;
  if (clients_.empty() || is_reading_ || now < next_) return;
  is_reading_ = true;
  background_.run(Lane::campaign, [this, file = file_, now, alive = std::weak_ptr(alive_)] {
    return Background::After([this, reading = read(file, now), alive] {
      if (!alive.expired()) take(reading);
    });
  });
}

// Returns the number of new rows per second; std::nullopt if it is not known yet, or if there will be none.
std::optional<double> CampaignWatcher::rate(const Reading& reading) {
  constexpr double window = 30;  // s
  constexpr std::int64_t enough_rows = 10;
  const std::int64_t runs = reading.counts.runs;
  if (!reading.counts.reason.empty() || !reading.error.empty()) {
    grown_.clear();
    return std::nullopt;
  }
  if (!grown_.empty() && runs < grown_.back().second) grown_.clear();
  if (grown_.empty()) {
    grown_.emplace_back(reading.time, runs);
    return std::nullopt;
  }
  if (runs > grown_.back().second) grown_.emplace_back(reading.time, runs);
  // Rates of slow runs need a longer time.
  while (grown_.size() > 2 && grown_[1].first < reading.time - window &&
         runs - grown_[1].second >= enough_rows)
    grown_.pop_front();
  const auto rows = static_cast<double>(runs - grown_.front().second);
  const double silence = reading.time - grown_.back().first,
               grown = grown_.back().first - grown_.front().first;
  // The campaign has stopped if it would have had more rows meanwhile.
  if (silence > window && silence * rows > static_cast<double>(enough_rows) * grown) return 0;
  return rows / (reading.time - grown_.front().first);
}

void CampaignWatcher::take(const Reading& reading) {
  is_reading_ = false;
  // A reading of many rows takes a while, and may use a tenth of the time.
  next_ = clock_ + std::max(reading_interval, 9 * (clock_ - reading.time));
  const std::optional<double> rate = this->rate(reading);
  std::optional<double> left;
  if (rate && *rate > 0) left = static_cast<double>(reading.total - reading.counts.runs) / *rate;
  Node::Table message{{"type", {}, text_node("campaign")},
                      {"runs", {}, {reading.counts.runs, {}}},
                      {"total", {}, {reading.total, {}}},
                      {"statuses", {}, statuses_node(reading.counts)},
                      {"rate", {}, number_or_nothing(rate)},
                      {"left", {}, number_or_nothing(left)},
                      {"reason", {}, text_node(reading.counts.reason)},
                      {"measures", {}, histograms_node(reading.histograms)}};
  if (!reading.error.empty()) message.push_back({"error", {}, text_node(reading.error)});
  std::string text = write_json({std::move(message), {}});
  if (text == text_) return;
  text_ = std::move(text);
  for (const ClientId client : clients_) messenger_.send(client, text_);
}

void CampaignWatcher::give_report(std::function<void(HttpAnswer)> answer) {
  background_.run(Lane::campaign, [file = file_, answer = std::move(answer)]() -> Background::After {
    try {
      CampaignResults results(file);
      answer(report_answer(campaign_html(results, file.string())));
    } catch (const std::exception& error) {
      answer(failure_answer(500, one_line(error.what())));
    }
    return {};
  });
}

}  // namespace flexura
