#!/usr/bin/env bash
# median axes, markers and two-view shapes of random arms against the renderer's truth: ./dev study seeing [CASES] [SEED]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
cases=${1:-10000}
seed=${2:-1}
page=docs/studies/seeing.md
build=${FLEXURA_STUDY_BUILD:-build/release}

if [ -z "${FLEXURA_STUDY_BUILD:-}" ]; then cmake --preset release; fi
cmake --build "$build" --target seeing_study shape_study
# Whose programs these are, and whether they are as committed.
sources=$(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' "$build/CMakeCache.txt")
commit=$(git -C "$sources" describe --always --exclude '*' --abbrev=7 --dirty=', changed')
mkdir -p docs/studies build/studies
parts=$(mktemp -d)
trap 'rm -r "$parts"' EXIT
"$build/bin/seeing_study" "$cases" "$seed" >"$parts/axes" &
"$build/bin/shape_study" "$cases" "$seed" >"$parts/shapes"
wait $!
{
  echo "# Seeing random arms"
  echo
  echo "Random arms of one to four sections and one radius, before a white ground, from 1.2 to 3 m away and from any side,"
  echo "by cameras without distortion, drawn by the"
  echo "[renderer](../renderer.md) with its noise and blur at 640 x 480 px, and measured as [vision](../vision.md) tells."
  echo "Noise is a standard deviation in values of 8 bits, the PSF one in pixels. The median axis, corrected for the camera,"
  echo "is held against the exact image of the backbone: the distance of each sample of which both borders are seen,"
  echo "from that curve. *Median* and *90 %* are of the rms of each picture; *rms* and *99 %* of all samples together;"
  echo "*middle*: without the correction. *Not seen* are the samples that the axis bridges, where the arm lies on itself,"
  echo "hides an end, or points at the camera; *bridged ones too* counts them as well. Arms *that cross themselves* do so with"
  echo "the image of their backbone. *Ends* is the median distance of a free end from the backbone's. The aim of 0.02 px is"
  echo "for noise 2 and a PSF of 0.7 px; the program judges it. (There a maximum-likelihood estimate of each line of pixels"
  echo "by itself can reach 0.013 px, and the border of a mask gives 0.18 px.)"
  echo
  echo '```console'
  echo "\$ ./dev study seeing $cases $seed"
  echo '```'
  echo
  echo "Of commit $commit."
  echo
  cat "$parts/axes"
  echo
  echo "## Two views to a shape"
  echo
  echo "Arms of the same kind before two cameras, 1.5 to 3 m away and at a right angle to each other to within nine degrees;"
  echo "noise from 0 to 4, PSF from 0.5 to 1.2 px. Errors are root mean squares of the positions along the arm, in percent of"
  echo "its length. *Trusted* are the answers that come without a note ([estimating](../estimation.md)), *marked* those with"
  echo "one; the rest was not found, with the reason. *Over sigma* is the error over the standard deviation that came with"
  echo "the answer, and *within 50 %, 95 %* how often the true bends lie in the region that the covariance expects so often,"
  echo "both of the trusted ones. Quantiles are by nearest rank. The second table has the aims, % of the length, and whether"
  echo "they are met, as the program finds. The covariance is tested twice by chi^2, at the bounds that chance exceeds once in"
  echo "a thousand: the bends' errors, squared by their covariance, are to be as large on average as it expects; and the true"
  echo "bends' regions are to lie evenly from 0 to 100 % (ten equal parts). The last"
  echo "table has both of the known arm by the noise of the pictures."
  echo
  echo "For comparison, of real pictures where these are drawn: a network that was taught one robot of two segments tells"
  echo "its shape from one picture to 0.36 % of its length on average, 70 times a second (C. Shentu et al., MoSS, 2023)."
  echo
  cat "$parts/shapes"
} >build/studies/seeing.md
mv build/studies/seeing.md "$page"
echo "wrote $page"
