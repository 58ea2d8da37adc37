#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Wrong files and options through the program: exit code and message of each.
# Usage: bad_input_test.bash PROGRAM SOURCE_DIR
set -u
program=$1
pipeline=$2/configs/pipelines/ridge_crossing.yaml
scenario=$2/configs/scenarios/jacksboro_ridge.yaml
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
failed=0

# expect CODE TEXT ARGUMENT…: the exit code, and a text in what is printed
expect() {
  local code=$1 text=$2 output got
  shift 2
  output=$("$program" "$@" 2>&1 < /dev/null)
  got=$?
  if [[ $got -ne $code || $output != *"$text"* ]]; then
    printf 'altiplan %s\n  expected %d and "%s", got %d:\n%s\n' "$*" "$code" "$text" "$got" "$output"
    failed=1
  fi
}

: > "$scratch/empty.yaml"
echo 3 > "$scratch/three.yaml"
printf 'altiplan: 1\r\nsteps:\r\n\t- plan: astar\r\n' > "$scratch/tab.yaml"
expect 3 'the file is empty' run "$scratch/empty.yaml"
expect 3 "three.yaml:1:1: expected keys with values" run "$scratch/three.yaml"
expect 3 'tab.yaml:3:1: a tab indents this line' validate "$scratch/tab.yaml"
expect 3 'this is a scenario, expected a pipeline' run "$scenario"
expect 3 'this is a pipeline, expected a scenario' run "$pipeline" --scenario "$pipeline"
expect 3 'this is a folder' run "$2/configs"
expect 3 'is a folder, expected a JSON file' check "$scratch"
expect 3 'expected a result of format 1' check "$scratch/three.yaml"
expect 2 "unknown command 'flyy'" flyy
expect 2 "expected a whole number" run "$pipeline" --seed -1
expect 2 "expected a whole number" run "$pipeline" --seed 99999999999999999999
expect 3 '--set steps.0.plan=asta: steps.0.plan:' run "$pipeline" --set steps.0.plan=asta
expect 3 '--set scenario=none.yaml: scenario:' run "$pipeline" --set scenario=none.yaml
expect 3 'at most 1e+08 s' run "$pipeline" --set steps.0.within_s=1e300
expect 3 'at most 1e+09 MB' run "$pipeline" --set steps.0.within_mb=1e300
expect 3 'need far too many MB' run "$pipeline" --set 'steps.0.with.cell_m=[0.001, 0.001, 0.001]'
expect 1 'cannot be flown' run "$pipeline" --set 'scenario.start={at_m: [4000, 5000, 0]}'

# A result is written through a link, which stays; into a pipe, which stays a pipe.
echo old > "$scratch/real.json"
ln -s real.json "$scratch/link.json"
expect 0 'stands' run "$pipeline" --out "$scratch/link.json"
if [[ ! -L $scratch/link.json ]] || ! grep -q '"altiplan": 1' "$scratch/real.json"; then
  echo '--out does not write through a link'
  failed=1
fi
mkfifo "$scratch/pipe"
cat "$scratch/pipe" > "$scratch/read.json" &
expect 0 'stands' run "$pipeline" --out "$scratch/pipe"
if [[ ! -p $scratch/pipe ]]; then
  echo '--out replaces a pipe by a file'
  failed=1
  kill %1
fi
wait
grep -q '"altiplan": 1' "$scratch/read.json" || { echo '--out writes nothing into a pipe'; failed=1; }
# Where it cannot be written the result is shown. Never as root before the pipe above holds: a
# program that renames would put a file in place of the device.
if [[ $failed -eq 0 && -c /dev/full ]]; then
  expect 3 "the route of 'bspline' stands" run "$pipeline" --out /dev/full
  expect 3 "cannot write '/dev/full'" run "$pipeline" --out /dev/full
  expect 3 "the route of 'bspline' stands" run "$pipeline" --trace /dev/full
fi
exit "$failed"
