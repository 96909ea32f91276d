#!/usr/bin/env bash
# arms in front of photographs, found by background picture, region and model: ./dev study clutter [ARMS] [SEED]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
arms=${1:-250}
seed=${2:-1}
page=docs/studies/clutter.md
build=${FLEXURA_STUDY_BUILD:-build/release}

if [ -z "${FLEXURA_STUDY_BUILD:-}" ]; then cmake --preset release; fi
cmake --build "$build" --target clutter_study
# The commit that the program was built from, and whether it has changes.
sources=$(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' "$build/CMakeCache.txt")
commit=$(git -C "$sources" describe --always --exclude '*' --abbrev=7 --dirty=', changed')
mkdir -p docs/studies build/studies
table=$(mktemp)
trap 'rm "$table"' EXIT
"$build/bin/clutter_study" "$arms" "$seed" >"$table"
{
  echo "# Arms in front of clutter"
  echo
  echo "The study measures pictures of random arms in front of photographs. The photographs are from the Debian packages \`opencv-doc\` and \`visp-images-data\`: textures, calibration boards, rooms, objects and paintings. Each arm has one to four sections and one of six colours. Two cameras see it. The pictures have 640 x 480 px, noise of 0.5 to 4 (of 255), and a PSF of 0.5 to 1.2 px. The light falls by up to 30 % from the middle to the edge, and soft shadows are on the background. Two cables of the arm's colour are behind the arm, and one thin wire is in front. The picture of the background has independent noise, and its light differs by up to 7 %."
  echo
  echo "- *Finder* measures the arm in each picture ([Vision](../vision.md#arms-in-front-of-anything)). The region is a rectangle 25 px around the arm's image. The colour is the median along the arm. The pixel of the base is known."
  echo "- *Model* fits the tube to both pictures ([Estimation](../estimation.md#near-a-guess)). Each bend of the guess has a normally distributed error with a standard deviation of 0.1 rad. For the *wrong guess* the standard deviation is 0.3 rad, but the fit assumes 0.1 rad."
  echo "- Where *a part is hidden*, a plate, 40 px wide, covers 15 % of the arm's length and extends 20 px further. The arm also casts a shadow on the background."
  echo "- *Axis* is the distance between points of the measured axis and the exact image of the backbone. The table has the median of all pictures' medians, and the 95 % quantile of all points in trusted answers."
  echo "- An answer is *trusted* if it has no notes. It is *wrong* if more than 5 % of its axis points are more than 1.5 px from the exact image. It is also *wrong* if the axis is shorter than 80 % of the arm's image."
  echo "- *Squared error / expectation* is the squared error of the bends, weighted by the inverse of their covariance, per bend, of trusted answers; it should be 1."
  echo
  echo '```console'
  echo "\$ ./dev study clutter $arms $seed"
  echo '```'
  echo
  echo "The results are from commit $commit."
  echo
  cat "$table"
} >build/studies/clutter.md
mv build/studies/clutter.md "$page"
echo "wrote $page"
