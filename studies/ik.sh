#!/usr/bin/env bash
# inverse kinematics of random targets in and out of reach: ./dev study ik [SAMPLES]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
samples=${1:-} # For each row of the tables; default: as in the campaign files.
page=docs/studies/ik.md
build=${FLEXURA_STUDY_BUILD:-build/release}

if [ -z "${FLEXURA_STUDY_BUILD:-}" ]; then
  cmake --preset release
  cmake --build "$build" --target flexura
fi
mkdir -p docs/studies build/studies
{
  cat <<'END'
# Inverse kinematics

Each run of this study is an experiment: a `move` task of a random arm ([inverse kinematics](../inverse-kinematics.md)). The target is the tip that the arm has in a random shape. Each table is a [campaign](../campaigns.md) of `examples/22_ik_study`. The solver has the default tolerances (1e-9 of the length; 1e-9 rad).

- *Position error* and *angle error* are the differences between the target and the tip that forward kinematics computes for the answer. The bounds are twice the tolerances of the longest arm. The columns "within the bounds" count only runs that are done.
- *Wrongly refused*: the solver states that a reachable target is out of reach. *Starting states*: number of states from which the solver started.
- A run is *done* if the motion to the answer is within all limits and reaches the target within 1e-6 of the length.

END
  echo '```console'
  echo "\$ ./dev study ik${samples:+ $samples}"
  echo '```'
  echo
  FLEXURA_STUDY_BUILD=$build tools/study_page.sh 22_ik_study "$samples" reachable half_turn full_turn unreachable
  cat <<'END'
Tests compare the answers for unreachable targets with those of a search without derivatives (`flexura/kinematics/inverse_test.cc`).
END
} >build/studies/ik.md
mv build/studies/ik.md "$page"
echo "wrote $page"
