#include "flexura/campaign/mpi_engine.h"

#include <fmt/format.h>
// Without Open MPI's C++ classes, which need another library.
#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

#include <chrono>
#include <cstdio>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "flexura/campaign/rank_dealer.h"
#include "flexura/campaign/row_text.h"

namespace flexura {
namespace {

// What a message is. Rank 0 sends deals and ends, the others send rows, failures and byes.
enum Tag : int { deal_tag = 1, end_tag = 2, row_tag = 3, failure_tag = 4, bye_tag = 5 };

// Waiting in MPI itself would keep a processor busy.
constexpr std::chrono::microseconds patience{2000};

struct Message {
  int tag = 0, from = 0;
  std::string text;
};

void send(int to, Tag tag, std::string_view text) {
  MPI_Send(text.data(), static_cast<int>(text.size()), MPI_BYTE, to, tag, MPI_COMM_WORLD);
}

// Returns a message that has arrived, if there is one.
std::optional<Message> next_message() {
  int has_one = 0;
  MPI_Status status;
  MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &has_one, &status);
  if (has_one == 0) return std::nullopt;
  int size = 0;
  MPI_Get_count(&status, MPI_BYTE, &size);
  Message message{status.MPI_TAG, status.MPI_SOURCE, std::string(static_cast<std::size_t>(size), '\0')};
  MPI_Recv(message.text.data(), size, MPI_BYTE, message.from, message.tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return message;
}

// Passes the messages of RankDealer through MPI.
class MpiLink : public RankLink {
 public:
  void deal(std::size_t rank, std::int64_t id) override {
    send(static_cast<int>(rank), deal_tag, std::to_string(id));
  }
  void end(std::size_t rank) override { send(static_cast<int>(rank), end_tag, ""); }
  [[nodiscard]] std::optional<RankMessage> arrived() override {
    std::optional<Message> message = next_message();
    if (!message) return std::nullopt;
    RankMessage received{RankMessage::Kind::row, static_cast<std::size_t>(message->from),
                         std::move(message->text)};
    if (message->tag == failure_tag) received.kind = RankMessage::Kind::failure;
    if (message->tag == bye_tag) received.kind = RankMessage::Kind::bye;
    return received;
  }
};

// Sends finished runs to rank 0; returns false after a failure of this machine.
bool report(WorkerPool& pool) {
  try {
    for (const CampaignRow& one : pool.take(patience)) send(0, row_tag, row_text(one));
    return true;
  } catch (const std::exception& error) {
    send(0, failure_tag, error.what());
    return false;
  }
}

}  // namespace

MpiSession::MpiSession() {
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks_);
}

MpiSession::~MpiSession() {
  if (rank_ == 0 && !has_told_) tell("");
  if (!given_up_.empty()) {  // The regular end of MPI waits for all ranks.
    std::fprintf(stderr, "error: %s\n", given_up_.c_str());
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
  MPI_Finalize();
}

void MpiSession::tell(const std::string& text) {
  has_told_ = true;
  auto size = static_cast<std::int64_t>(text.size());
  MPI_Bcast(&size, 1, MPI_INT64_T, 0, MPI_COMM_WORLD);
  std::string sent = text;
  MPI_Bcast(sent.data(), static_cast<int>(size), MPI_BYTE, 0, MPI_COMM_WORLD);
}

std::string MpiSession::hear() {
  std::int64_t size = 0;
  MPI_Bcast(&size, 1, MPI_INT64_T, 0, MPI_COMM_WORLD);
  std::string text(static_cast<std::size_t>(size), '\0');
  MPI_Bcast(text.data(), static_cast<int>(size), MPI_BYTE, 0, MPI_COMM_WORLD);
  return text;
}

MpiEngine::MpiEngine(MpiSession& session, RunFunction run, std::size_t threads)
    : session_(session), run_(std::move(run)), threads_(threads) {}

std::size_t MpiEngine::workers() const { return threads_ * static_cast<std::size_t>(session_.ranks()); }

void MpiEngine::execute(const EngineJob& job) {
  MpiLink link;
  RankDealer dealer(link, static_cast<std::size_t>(session_.ranks() - 1), threads_);
  try {
    deal(job, dealer);
  } catch (...) {
    dismiss(dealer);
    throw;
  }
  dismiss(dealer);
}

void MpiEngine::deal(const EngineJob& job, RankDealer& dealer) {
  WorkerPool pool(run_, threads_);
  while (!job.is_cancelled()) {
    std::vector<CampaignRow> rows = dealer.turn(job);
    while (pool.pending() < runs_ahead * threads_) {
      const std::optional<std::int64_t> id = job.next();
      if (!id) break;
      pool.add(*id);
    }
    if (pool.pending() == 0 && dealer.pending() == 0 && rows.empty()) return;
    std::vector<CampaignRow> own = pool.take(rows.empty() ? patience : std::chrono::microseconds(0));
    rows.insert(rows.end(), own.begin(), own.end());
    if (!job.done(rows)) return;
  }
}

void MpiEngine::dismiss(RankDealer& dealer) {
  // A rank answers between two messages, also while it executes runs. One that does not has died.
  constexpr std::chrono::seconds longest_silence{10};
  const auto start = std::chrono::steady_clock::now();
  const std::vector<std::size_t> lost = dealer.dismiss([&] {
    std::this_thread::sleep_for(patience);
    return std::chrono::steady_clock::now() - start < longest_silence;
  });
  if (lost.empty()) return;
  const std::string who =
      lost.size() == 1 ? fmt::format("rank {} does", lost.front()) : fmt::format("{} ranks do", lost.size());
  session_.give_up(who + " not answer: start the same command again to continue");
  throw std::runtime_error(who + " not answer");
}

void serve_runs(const RunFunction& run, std::size_t threads) {
  WorkerPool pool(run, threads);
  bool is_well = true;
  while (true) {
    while (const std::optional<Message> message = next_message()) {
      if (message->tag == end_tag) {
        send(0, bye_tag, "");
        return;
      }
      pool.add(std::stoll(message->text));
    }
    if (is_well && pool.pending() > 0)
      is_well = report(pool);
    else
      std::this_thread::sleep_for(patience);
  }
}

}  // namespace flexura
