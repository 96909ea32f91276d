#!/usr/bin/env bash
# how many ranks the first rank of a campaign can deal to: ./dev study dealing [MESSAGE_US]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
message=${1:-5} # Duration of sending or receiving a message, microseconds.
page=docs/studies/dealing.md
build=${FLEXURA_STUDY_BUILD:-build/release}

if [ -z "${FLEXURA_STUDY_BUILD:-}" ]; then cmake --preset release; fi
cmake --build "$build" --target dealing_study
mkdir -p docs/studies build/studies
{
  echo "# Distributing the runs of a campaign to many ranks"
  echo
  echo "Rank 0 of a [campaign with MPI](../campaigns.md#many-machines) distributes all runs and writes all rows. In this simulation, the code that distributes the runs, the rows (two parameters, three measures) and the SQLite file are the real ones. The other ranks, their runs and the network are simulated: durations of runs vary uniformly by 20 %, and each message that rank 0 sends or receives takes $message microseconds. The simulated time advances by the measured time of rank 0's work on this machine, and by the simulated time for which rank 0 waits. In the simulation, rank 0 executes no runs; in a campaign it does."
  echo
  echo '```console'
  echo "\$ ./dev study dealing $message"
  echo '```'
  echo
  "$build/bin/dealing_study" "$message"
} >build/studies/dealing.md
mv build/studies/dealing.md "$page"
echo "wrote $page"
