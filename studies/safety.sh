#!/usr/bin/env bash
# checks of random motions held against dense samples: ./dev study safety [MOTIONS] [SAMPLES] [SEED]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
motions=${1:-1000}
samples=${2:-100000}
seed=${3:-1}
page=docs/studies/safety.md
build=${FLEXURA_STUDY_BUILD:-build/release}

if [ -z "${FLEXURA_STUDY_BUILD:-}" ]; then cmake --preset release; fi
cmake --build "$build" --target safety_study
mkdir -p docs/studies build/studies
{
  echo "# Checks of motions against dense samples"
  echo
  echo "Random arms of one to six sections, every fourth of them planar, with random limits and radii, each among a random"
  echo "plane, ball, rod and box. Eight motions each: hold, linear with minimum jerk, trapezoid, sine, linear and smooth"
  echo "keyframes, a trapezoid by rates and accelerations of each section, a move of the tip to a place; and of planar arms"
  echo "two more, a move of the cord angles with a law for each section and a swing of these. Each is checked as"
  echo "[safety](../safety.md) tells, and then sampled at $samples even steps by other code"
  echo "([limits](../../tests/support/sampled_check.h), [clearances](../../tests/support/sampled_clearance.h)); the motions, the sections' frames and"
  echo "the distance from a point to an obstacle are the simulator's own."
  echo
  echo "Bends, mean bend rates, stretches and folding are compared at every step. Clearances, of the arm to itself and"
  echo "to each obstacle, are found by points along the sections and a descent from the nearest ones, at every hundredth"
  echo "step; and at every step between two of these wherever one of them lies outside the reported contacts and nearer"
  echo "than four times what any of the points moves in between, so that none of the others can be in contact either."
  echo "Every section before every obstacle, and every pair of sections, is held against the spans reported of it, and"
  echo "the worst value of every span against the samples within and against the state at its time (in pairs of"
  echo "sections only to 1 % of the arm's length, where neighbours begin)."
  echo "Reported times count with the resolution that the check"
  echo "promises, 1e-4 s for contacts. A contact counts from 2e-6 m of depth. Worst values count as promised, too: short"
  echo "by no more than 1e-4 (of the value; of a depth, m) where the check does not say by how much they may be."
  echo
  echo '```console'
  echo "\$ ./dev study safety $motions $samples $seed"
  echo '```'
  echo
  "$build/bin/safety_study" "$motions" "$samples" "$seed"
} >build/studies/safety.md
mv build/studies/safety.md "$page"
echo "wrote $page"
