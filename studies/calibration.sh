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
# Trials of other code are none of this one's.
trials_kept=build/studies/calibration/$(git rev-parse --short HEAD)
picture=docs/images/calibration-study.svg
mkdir -p docs/studies "$trials_kept"
{
  echo "# Calibrating random rigs"
  echo
  echo "Two cameras 2.5 m in front of and beside an arm of three sections and 1 m, each with a head that counts in"
  echo "steps of 0.075 degrees, are believed to stand as they were meant to. In truth, evenly within these bounds, their"
  echo "mounts are turned by 10 degrees in pan and in tilt and by 1 in roll and stand 0.2 m off along each axis, focal"
  echo "lengths are 10 % off and principal points 10 px in u and in v; the arm's sections bend by 1 % more or less and"
  echo "are 0.5 % longer or shorter. Zeros of the heads' axes are 1 degree off, a point of each tilt axis and each pupil 3 mm"
  echo "along each axis, the pupils' shifts with the zoom 1 mm for each 1 of ratio, fy 0.1 %, k1 0.02. All of that is"
  echo "estimated, and the bends of each pose and the angles of each stance beside them ([the model](../calibration.md))."
  echo
  echo "Twelve pictures a camera: three from where the heads stand, eight chosen for what they will tell, and one after"
  echo "the heads have moved to the wanted configuration. Each shows those of nine markers and forty axis points that"
  echo "are inside, with normal noise in each; nothing is drawn."
  echo
  echo '```console'
  echo "\$ ./dev study calibration $trials $seed $drawn $printed $bundles"
  echo '```'
  echo
  "$build/bin/calibration_study" "$trials" "$seed"
  echo
  echo "## The five methods, with drawn pictures"
  echo
  echo "Simulated rigs at their ports: pictures of 640 x 480 px with f = 800 px at ratio 1, a noise of 2 to 3 of 255, heads"
  echo "that count in steps of 0.075 degrees. Evenly within these bounds, cameras start turned by 10 degrees in pan and in"
  echo "tilt and by 1 in roll, 0.2 m off along each axis, at a zoom of 1 to 2.5, with a principal point 1 px off (10 px for"
  echo "both bundles, whose heads' zeros are 1 degree off, tilt axes 3 mm along each axis and k1 0.02, too); the arm's sections bend by 1 % more or less and are 0.5 % longer or shorter. The cylinder (radius 0.1 m) is 1.5 m away, the"
  echo "arm 2.5 m. What remains is the simulated truth's."
  echo
  "$build/bin/paper_study" "$drawn" "$seed" "$printed" "$bundles" "$trials_kept" "$trials_kept/picture.svg"
  echo "![Where the printed methods start and what comes of them; which share of the starts each method brings how near](../images/calibration-study.svg)"
} >"$trials_kept/page.md"
mv "$trials_kept/page.md" "$page"
mv "$trials_kept/picture.svg" "$picture"
echo "wrote $page"
