#include <algorithm>
#include <array>
#include <cstdlib>

#include "flexura/campaign/mpi_engine.h"

namespace flexura {

bool is_started_by_mpi() {
  // Set by mpirun of Open MPI, and by srun with PMIx or PMI.
  constexpr std::array ranks = {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"};
  return std::ranges::any_of(ranks, [](const char* rank) { return std::getenv(rank) != nullptr; });
}

}  // namespace flexura
