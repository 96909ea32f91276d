#!/usr/bin/env bash
# all property tests, with many times as many random cases: ./dev study properties [TIMES] [FOLDER...]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
times=${1:-10}
if [ $# -gt 1 ]; then folders=("${@:2}"); else mapfile -t folders < <(awk '/^[0-9]/ { print $2 }' flexura/floors.txt); fi
page=docs/studies/properties.md
build=${FLEXURA_STUDY_BUILD:-build/release}

if [ -z "${FLEXURA_STUDY_BUILD:-}" ]; then cmake --preset release; fi
mkdir -p docs/studies build/studies
targets=()
for folder in "${folders[@]}"; do
  for size in test full_test; do
    if compgen -G "flexura/$folder/*_$size.cc" >/dev/null; then targets+=("${folder}_$size"); fi
  done
done
cmake --build "$build" --target "${targets[@]}"
{
  echo "# Properties over many random cases"
  echo
  echo "Tests draw few of the random cases that they could, so that all of them take minutes. Here each draws $times times as"
  echo "many (\`FLEXURA_CASES\`), the first of which are the tests' own."
  echo
  echo '```console'
  echo "\$ ./dev study properties ${*:-$times}"
  echo '```'
  echo
  echo "Of commit $(git describe --always --exclude '*' --abbrev=7 --dirty=', changed')."
  echo
  echo "| program | tests | passed | failed |"
  echo "| --- | ---: | ---: | --- |"
  for target in "${targets[@]}"; do
    log=build/studies/$target.log
    status=0
    FLEXURA_CASES=$times "$build/bin/$target" >"$log" 2>&1 || status=$?
    failed=$(sed -n 's/^\[  FAILED  \] \([A-Za-z0-9_/.]*\)$/\1/p' "$log" | sort -u | paste -sd ' ')
    [ "$status" -eq 0 ] || failed=${failed:-exit status $status}
    echo "| \`$target\` | $(sed -n 's/^\[==========\] \([0-9]*\) tests\? from .* ran.*/\1/p' "$log") |" \
      "$(sed -n 's/^\[  PASSED  \] \([0-9]*\) tests\?.*/\1/p' "$log") |" \
      "$failed |"
  done
} >build/studies/properties.md
mv build/studies/properties.md "$page"
echo "wrote $page"
