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
  echo "# Accuracy of camera calibration"
  echo
  echo "The study calibrates simulated rigs with random errors of the model. Two cameras view an arm of three sections and 1 m from the front and from the side, at a distance of 2.5 m. Their heads have steps of 0.075 degrees. True values differ from the model by errors that are uniformly distributed within these bounds:"
  echo
  echo "| parameter | bound of the error |"
  echo "| --- | --- |"
  echo "| rotation of the mount; position | 10 degrees in pan and tilt, 1 degree in roll; 0.2 m per axis |"
  echo "| focal length; ratio fy/fx; principal point; k1 | 10 %; 0.1 %; 10 px; 0.02 |"
  echo "| zero offsets of the head; positions of tilt axis and pupil; pupil shift | 1 degree; 3 mm per axis; 1 mm per unit of zoom ratio |"
  echo "| bends of sections; lengths | 1 %; 0.5 % |"
  echo
  echo "The calibration estimates all these errors, the bends in each pose, and the true angles of each head position ([model](../calibration.md#the-model))."
  echo
  echo "Each camera takes twelve pictures: three from its start, eight chosen by the planner, and one after the last motion. No pictures are rendered: a picture is the list of the visible points among nine markers and forty centerline points, with normally distributed noise."
  echo
  echo '```console'
  echo "\$ ./dev study calibration $trials $seed $drawn $printed $bundles"
  echo '```'
  echo
  "$build/bin/calibration_study" "$trials" "$seed"
  echo
  echo "## Comparison of methods with rendered pictures"
  echo
  echo "Each method calibrates complete simulated rigs with rendered pictures. The pictures have 640 x 480 px, f = 800 px at ratio 1, and noise 2 to 3 of 255. The head steps are 0.075 degrees. Starting errors are uniformly distributed within 10 degrees in pan and tilt, 1 degree in roll, and 0.2 m per axis. Zoom ratios are 1 to 2.5. Errors of the model are up to 1 px in principal points, 1 % in bends and 0.5 % in lengths. For both bundle methods the errors of the model are larger: 10 px in principal points and 1 degree in zero offsets. Further errors are 3 mm per axis in positions of tilt axes, and 0.02 in k1. The cameras are 1.5 m from the cylinder (radius 0.1 m), or 2.5 m from the arm. All results are true values, which the simulation knows."
  echo
  "$build/bin/paper_study" "$drawn" "$seed" "$printed" "$bundles" "$trials_kept" "$trials_kept/picture.svg"
  echo "![Starting errors and results of the methods as printed in the paper, and the distribution of the final angle errors of all methods](../images/calibration-study.svg)"
} >"$trials_kept/page.md"
mv "$trials_kept/page.md" "$page"
mv "$trials_kept/picture.svg" "$picture"
echo "wrote $page"
