#!/usr/bin/env bash
# What the viewer adds to a full build, in seconds of one core's time: tools/page_build_time.sh [FOLDER]
# Works in FOLDER (a new one in /tmp), the measured steps without ccache; the repository stays as it is.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
root=$PWD
folder=${1:-$(mktemp -d)}
mkdir -p "$folder"
git archive HEAD | tar -x -C "$folder"
cd "$folder"
TIMEFORMAT='%U %S'

took() {  # WHAT COMMAND...: prints what it took
  local name=$1 spent
  shift
  # The command's own output goes to the log; the time is all that is left of standard error.
  spent=$({ time "$@" >>log.txt 2>&1; } 2>&1)
  awk -v name="$name" -v spent="$spent" 'BEGIN { split(spent, part, " "); printf "| %s | %.1f |\n", name, part[1] + part[2] }'
}

echo "| step | s |"
echo "| --- | --- |"
took "\`npm ci\`, packages in npm's cache" npm --prefix viewer ci
cmake --preset release >>log.txt
# What comes before them is not theirs.
ninja -C build/release -j"$(nproc)" flexura_experiment >>log.txt
export CCACHE_DISABLE=1
took "the page: \`vite build\`, compressing, embedding" ninja -C build/release -j1 flexura_app_page
took "compiling \`flexura/serve\`" ninja -C build/release -j1 flexura_serve
took "compiling \`flexura/view\`" ninja -C build/release -j1 flexura_view
cd "$root"
[ $# -gt 0 ] || rm -r "$folder"
