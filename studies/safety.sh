#!/usr/bin/env bash
# checks of random motions compared with dense samples: ./dev study safety [MOTIONS] [SAMPLES] [SEED]
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
  echo "Random arms of one to six sections (every fourth planar), with random limits and radii, each with a random plane, ball, rod and box. Eight motions per arm: hold, minimum-jerk linear, trapezoid, sine, linear and smooth keyframes, a trapezoid with rates and accelerations per section, a move of the tip. Planar arms add two motions in cord angles: a move with a profile per section, and a sine. Each is checked ([safety](../safety.md)) and sampled at $samples even steps by independent code ([limits](../../tests/support/sampled_check.h), [clearances](../../tests/support/sampled_clearance.h)). Motions, section frames and point-obstacle distances are the simulator's own."
  echo
  echo "- Bends, mean bend rates, stretches and folding: every step."
  echo "- Clearances to itself and obstacles, by points and descents: every hundredth step, and every step between where a contact outside the reported ones is possible."
  echo "- Every section and obstacle, and every pair of sections, is compared with its reported spans. Each worst value is compared with the samples and with the state at its time (pairs to 1 % of the length, where neighbours begin)."
  echo "- Tolerances: 1e-4 s for contact times; contacts from 2e-6 m of depth; worst values may be 1e-4 short (relative; depths in m) where the check states no uncertainty."
  echo
  echo '```console'
  echo "\$ ./dev study safety $motions $samples $seed"
  echo '```'
  echo
  "$build/bin/safety_study" "$motions" "$samples" "$seed"
} >build/studies/safety.md
mv build/studies/safety.md "$page"
echo "wrote $page"
