// Takes the place of mpi_engine.cc where the program is built without MPI.
#include <string>
#include <utility>

#include "flexura/base/source.h"
#include "flexura/campaign/mpi_engine.h"

namespace flexura {

MpiSession::MpiSession() {
  throw input_error(
      "mpirun",
      "this program was built without MPI: install libopenmpi-dev and build the program again, or "
      "start it without mpirun");
}
MpiSession::~MpiSession() = default;
void MpiSession::tell(const std::string& /*text*/) {}
std::string MpiSession::hear() { return {}; }

MpiEngine::MpiEngine(MpiSession& session, RunFunction run, std::size_t threads)
    : session_(session), run_(std::move(run)), threads_(threads) {}
std::size_t MpiEngine::workers() const { return threads_ * static_cast<std::size_t>(session_.ranks()); }
void MpiEngine::execute(const EngineJob& /*job*/) {}
void MpiEngine::deal(const EngineJob& /*job*/, RankDealer& /*dealer*/) {}
void MpiEngine::dismiss(RankDealer& /*dealer*/) {}
void serve_runs(const RunFunction& /*run*/, std::size_t /*threads*/) {}

}  // namespace flexura
