#!/usr/bin/env bash
# rigs calibrated from rough guesses, and the paper's methods: ./dev study calibration [TRIALS] [SEED] [DRAWN] [PRINTED] [BUNDLES]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
trials=${1:-100}
seed=${2:-1}
drawn=${3:-20}
printed=${4:-20}
bundles=${5:-$drawn}
page=docs/studies/calibration.md
build=${FLEXURA_STUDY_BUILD:-build/release}

if [ -z "${FLEXURA_STUDY_BUILD:-}" ]; then cmake --preset release; fi
cmake --build "$build" --target calibration_study paper_study
# Trials of other commits are kept apart.
trials_kept=build/studies/calibration/$(git rev-parse --short HEAD)
picture=docs/images/calibration-study.svg
mkdir -p docs/studies "$trials_kept"
{
  echo "# Calibrating random rigs"
  echo
  echo "Two cameras with heads in steps of 0.075 degrees view an arm of three sections and 1 m from 2.5 m, in front and beside. True values differ from the model, uniformly within:"
  echo
  echo "| number | bound |"
  echo "| --- | --- |"
  echo "| mount: rotation; position | 10 degrees pan and tilt, 1 roll; 0.2 m per axis |"
  echo "| focal length; ratio fy/fx; principal point; k1 | 10 %; 0.1 %; 10 px; 0.02 |"
  echo "| zeros of head axes; tilt axis point and pupil; pupil shift | 1 degree; 3 mm per axis; 1 mm per unit of zoom ratio |"
  echo "| section bends; lengths | 1 %; 0.5 % |"
  echo
  echo "All are estimated, with each pose's bends and each position's true angles ([the model](../calibration.md))."
  echo
  echo "Each camera takes twelve pictures: three from the start, eight chosen, one after the move. A picture has the visible ones of nine markers and forty centerline points, with normal noise; nothing is drawn."
  echo
  echo '```console'
  echo "\$ ./dev study calibration $trials $seed $drawn $printed $bundles"
  echo '```'
  echo
  "$build/bin/calibration_study" "$trials" "$seed"
  echo
  echo "## The five methods, with drawn pictures"
  echo
  echo "Simulated rigs at their ports: 640 x 480 px, f = 800 px at ratio 1, noise 2 to 3 of 255, head steps 0.075 degrees. Starting errors are uniform within 10 degrees in pan and tilt, 1 in roll, 0.2 m per axis. Zooms are 1 to 2.5, principal points 1 px off, bends 1 %, lengths 0.5 %. Both bundles have principal points 10 px, head zeros 1 degree, tilt axes 3 mm per axis and k1 0.02 off. The cylinder (radius 0.1 m) is 1.5 m away, the arm 2.5 m. Results are simulated true values."
  echo
  "$build/bin/paper_study" "$drawn" "$seed" "$printed" "$bundles" "$trials_kept" "$trials_kept/picture.svg"
  echo "![Where the printed methods start and what comes of them; which share of the starts each method brings how near](../images/calibration-study.svg)"
} >"$trials_kept/page.md"
mv "$trials_kept/page.md" "$page"
mv "$trials_kept/picture.svg" "$picture"
echo "wrote $page"
