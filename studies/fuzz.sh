#!/usr/bin/env bash
# a million seeded cases of every fuzz target under ASan + UBSan: ./dev study fuzz [CASES] [SEED]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
cases=${1:-1000000}
seed=${2:-1}
page=docs/studies/fuzz.md

./dev build asan
export ASAN_OPTIONS=detect_leaks=1:detect_stack_use_after_return=1 UBSAN_OPTIONS=print_stacktrace=1
# An answer of inverse kinematics takes a thousand times as long as reading its line: a fiftieth of the cases.
mapfile -t targets < <(find flexura -name '*_fuzz.cc' -exec basename {} .cc \; | sort)

# As many at a time as there are cores; each in a folder of its own, for the input that it leaves when it fails.
run_target() {
  local target=$1 folder=$PWD/build/studies/fuzz/$1 root=$PWD
  mkdir -p "$folder"
  cd "$folder"
  "$root/build/asan/bin/$target" --corpus "$root/tests/corpus/$target" --cases "$cases" --seed "$seed" >log 2>&1 || {
    echo "FAILED: $folder/log" >&2
    return 1
  }
}
export -f run_target
export cases seed
printf '%s\n' "${targets[@]}" | xargs -P "$(nproc)" -I{} bash -euo pipefail -c 'run_target {}'

mkdir -p docs/studies
{
  echo "# Fuzzing"
  echo
  echo "Every reader of foreign text, fed its committed corpus (\`tests/corpus/TARGET\`) and seeded mutations of it,"
  echo "under AddressSanitizer, LeakSanitizer and UndefinedBehaviorSanitizer (GCC $(g++ -dumpfullversion))."
  echo "A case fails when the target crashes, lets an exception out, or takes more than half a minute."
  echo
  echo '```console'
  echo "\$ ./dev study fuzz $cases $seed"
  echo '```'
  echo
  echo "| target | corpus files | mutated cases | failures | cases a second |"
  echo "| --- | ---: | ---: | ---: | ---: |"
  for target in "${targets[@]}"; do
    awk -v target="$target" '
      / files, seed / { files = $1 }
      / cases\/s$/ { speed = $1 }
      / cases, no failure$/ { cases = $1 }
      END { if (cases == "") exit 1; printf "| `%s` | %d | %d | 0 | %d |\n", target, files, cases, speed }
    ' "build/studies/fuzz/$target/log"
  done
  echo
  echo "As many targets ran at a time as there are cores ($(nproc)); the speed is of the sanitized build."
} >"$page.new"
mv "$page.new" "$page"
echo "wrote $page"
