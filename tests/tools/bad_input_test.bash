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
expect 3 'is a folder, expected a file' run "$2/configs"
expect 3 'is a folder, expected a file' check "$scratch"
mkdir "$scratch/folder.csv"
expect 3 'is a folder, expected a file' check --route "$scratch/folder.csv" --scenario "$scenario"
echo '[[1, 2, 3], [1e308, 0, 0]]' > "$scratch/far.json"
expect 3 'point 1 lies beyond 1e8 m' check --route "$scratch/far.json" --scenario "$scenario"
expect 3 'is already read or written by this command' run "$pipeline" --out "$scenario"
expect 3 'expected a result of format 1' check "$scratch/three.yaml"
expect 2 "unknown command 'flyy'" flyy
expect 2 "expected a whole number" run "$pipeline" --seed -1
expect 2 "expected a whole number" run "$pipeline" --seed 99999999999999999999
expect 3 '--set steps.0.plan=asta: steps.0.plan:' run "$pipeline" --set steps.0.plan=asta
expect 3 '--set scenario=none.yaml: scenario:' run "$pipeline" --set scenario=none.yaml
expect 3 'at most 1e+08 s' run "$pipeline" --set steps.0.within_s=1e300
expect 3 'at most 1e+09 MiB' run "$pipeline" --set steps.0.within_mb=1e300
expect 3 'need far too many MB' run "$pipeline" --set 'steps.0.with.cell_m=[0.001, 0.001, 0.001]'
expect 1 'cannot be flown' run "$pipeline" --set 'scenario.start={at_m: [4000, 5000, 0]}'

# refused TEXT SCENARIO_LINE [ARGUMENT…]: a scenario with that line is refused by `run`: exit code 3,
# the message on stderr, nothing on stdout, and the result of the run before is left as it was.
echo before > "$scratch/result.json"
refused() {
  local text=$1 output got
  cat > "$scratch/small.yaml" << EOF
altiplan: 1
volume: {min_m: [0, 0, 0], max_m: [1000, 1000, 500]}
environment:
  - $2
start: {at_m: [10, 10, 400]}
goal: {at_m: [900, 900, 400]}
EOF
  shift 2
  printf 'altiplan: 1\nscenario: small.yaml\nsteps: [{plan: astar}]\n' > "$scratch/plan.yaml"
  output=$("$program" run "$scratch/plan.yaml" --out "$scratch/result.json" "$@" \
    2>&1 > "$scratch/stdout" < /dev/null)
  got=$?
  if [[ $got -ne 3 || $output != *"$text"* || -s $scratch/stdout ||
    $(cat "$scratch/result.json") != before ]]; then
    printf '%s\n  expected 3 and "%s", got %d:\n%s\n' "$(sed -n 4p "$scratch/small.yaml")" \
      "$text" "$got" "$output"
    failed=1
  fi
}

: > "$scratch/empty"
echo 'no raster' > "$scratch/text.tif"
mkdir "$scratch/folder"
head -c 3000 /dev/zero > "$scratch/N47E008.hgt"
asc() { printf 'ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize %s\n%s\n' "$2" "$3" > "$scratch/$1.asc"; }
asc letters 500 '1 2 a b'
asc short 500 '1 2 3'
asc cellsize 0 '1 2 3 4'
for file in empty text.tif folder N47E008.hgt letters.asc short.asc cellsize.asc none.tif; do
  refused "environment.0.terrain" "terrain: {file: $file}"
done
geojson() { printf '%s' "$2" > "$scratch/$1.geojson"; }
collection() {
  geojson "$1" '{"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {},
    "geometry": '"$2"'}]}'
}
geojson text 'zones'
geojson number 5
geojson open '{"type": "FeatureCollection", "features": ['
geojson type '{"type": "Topology"}'
geojson deep "$(printf '[%.0s' {1..5000})"
geojson large '{"type": "FeatureCollection", "features": 1e400}'
collection ring '{"type": "Polygon", "coordinates": [[[8, 47], [9, 47], [8, 47]]]}'
collection unclosed '{"type": "Polygon", "coordinates": [[[8, 47], [9, 47], [9, 48], [8, 48]]]}'
collection words '{"type": "Polygon", "coordinates": [[["8", "47"], [9, 47], [9, 48], [8, 47]]]}'
collection latitude '{"type": "Polygon", "coordinates": [[[8, 147], [9, 47], [9, 48], [8, 147]]]}'
for file in empty text.geojson number.geojson open.geojson type.geojson deep.geojson large.geojson \
  ring.geojson unclosed.geojson words.geojson latitude.geojson folder none.geojson; do
  refused "environment.0.zones" "zones: {file: $file, ceiling_m: 100, floor_m: 0}" \
    --set 'scenario.frame={origin_lonlat: [8.5, 47.5]}'
done
refused 'environment.0.zones' 'zones: {list: [{cylinder: {at_m: [0, 0], radius_m: 5}, from: tomorrow}]}'
refused 'environment.0.zones' 'zones: {list: [{polygon: {outline_m: [[0, 0], [1, 1]]}}]}'
refused 'needs the height of its antenna' 'radar: {at_m: [500, 500], range_m: 50}'
refused '--set' 'box: {min_m: [0, 0, 0], max_m: [1, 1, 1]}' --set steps.7.with.cell_m=5
refused '--set' 'box: {min_m: [0, 0, 0], max_m: [1, 1, 1]}' --set steps.0.with.celll_m=5
refused '--set' 'box: {min_m: [0, 0, 0], max_m: [1, 1, 1]}' --set 'steps.0.with.cell_m=[5, 5'
refused '--set' 'box: {min_m: [0, 0, 0], max_m: [1, 1, 1]}' --set 'scenario.start.at_m=[1, 2, x]'
refused '--set' 'box: {min_m: [0, 0, 0], max_m: [1, 1, 1]}' --set scenario.environment.3.box=1
if [[ $(id -u) -ne 0 ]]; then
  cp "$scratch/small.yaml" "$scratch/closed.yaml"
  chmod 0 "$scratch/closed.yaml"
  expect 3 'closed.yaml' validate "$scratch/closed.yaml"
else
  echo 'skipped as root: a file that may not be read'
fi

# What `check` is given.
for text in '' '5' '[' '[[1, 2, 3]' '[[1, 2], [3, 4]]' '[["a", 2, 3], [4, 5, 6]]' '{"route": 5}' \
  '[[1, 2, 1e400], [4, 5, 6]]' '[]' \
  '{"a": [1, 2, 3], "b": [4, 5, 6]}' '{"route": {"0": [1, 2, 3]}}' '[{"x": 1, "y": 2, "z": 3}]' 'null' $'x,y,z\n1,2,3\n4,5,6\n' $'\xff\xfe[' \
  '[[1, 2, null], [4, 5, 6]]' '[[1, 2, NaN], [4, 5, 6]]' '[[true, 2, 3], [4, 5, 6]]' \
  '[[1, 2, 3, 4], [4, 5, 6, 7]]' '[{"x": 1, "y": 2, "z": 3}]' '[[1, 2, 3], [4, 5, 6]] x' \
  '{"type": "LineString", "coordinates": [[1, 2, 3], [4, 5, 6]]}' \
  '{"type": "FeatureCollection", "features": []}'; do
  printf '%s' "$text" > "$scratch/route.json"
  expect 3 'route.json' check --route "$scratch/route.json" --scenario "$scratch/small.yaml"
done
printf '%s' "$(printf '[%.0s' {1..100000})" "$(printf ']%.0s' {1..100000})" > "$scratch/deep.json"
expect 3 'deep.json' check --route "$scratch/deep.json" --scenario "$scratch/small.yaml"
expect 3 'deep.json' check "$scratch/deep.json"
for text in '' '5' '{}' '{"altiplan": 2}' '{"altiplan": 1}' '{"altiplan": 1, "route": [[1, 2, 3]]}'; do
  printf '%s' "$text" > "$scratch/stored.json"
  expect 3 'stored.json' check "$scratch/stored.json"
done
"$program" run "$pipeline" --out "$scratch/sound.json" > /dev/null
expect 0 'valid' check "$scratch/sound.json"
# stored TEXT KEY VALUE: with this value of a key of the result, `check` refuses it.
stored() {
  /usr/bin/python3 - "$scratch" "$2" "$3" << 'EOF'
import json, sys
folder, key, value = sys.argv[1:]
result = json.load(open(folder + "/sound.json"))
assert key in result, key
result[key] = json.loads(value)
json.dump(result, open(folder + "/stored.json", "w"))
EOF
  expect 3 "$1" check "$scratch/stored.json"
}
stored 'seed: expected a whole number from 0' seed '"x"'
stored "scenario: expected text, found 'null'" scenario null
stored "status: expected one of solved, no_route, " status null
stored 'status: expected one of solved, no_route, ' status '"great"'
stored 'this is a pipeline, expected a scenario' scenario "\"$pipeline\""
stored 'nowhere.yaml: there is no such file' pipeline '"nowhere.yaml"'
stored 'is not an index of this list' overrides '{"set": {"steps.9.plan": "astar"}}'
stored "overrides.set.steps.0.plan: expected text, found '5'" overrides '{"set": {"steps.0.plan": 5}}'
stored 'stored.json' files 5
stored "point 0 of the route: expected [x, y, z] in metres, found a list of 2" route '[[1, 2]]'
stored "'track' not found" flight '{}'
stored 'the flight has no track' flight '{"track": []}'
stored "flight.track.0: expected [t, x, y, z] in seconds and metres, found a list of 3" flight '{"track": [[0, 1, 2]]}'

"$program" run "$pipeline" --out "$scratch/result.json" > /dev/null
for seed in 1.5 1e300 -1 9223372036854775808; do
  sed "s/\"seed\": [0-9]*/\"seed\": $seed/" "$scratch/result.json" > "$scratch/seed.json"
  expect 3 'seed: expected a whole number' check "$scratch/seed.json"
done

sed 's/"status": /"status": "failed", "status": /' "$scratch/result.json" > "$scratch/twice.json"
expect 3 "twice.json: the key 'status' is given twice in one object" check "$scratch/twice.json"
printf 'x_m,y_m,z_m,altitude_m,altitude_frame\n1,2,3,3,moon\n' > "$scratch/moon.csv"
expect 3 "moon.csv:2: expected sea, ground or home as altitude_frame, found 'moon'" \
  check --route "$scratch/moon.csv" --scenario "$scratch/small.yaml"
# A mission is known by its name.
printf '{"fileType": "Plan"}' > "$scratch/m.qgc-plan"
expect 3 'or a mission whose name ends in .plan, ' \
  check --route "$scratch/m.qgc-plan" --scenario "$scratch/small.yaml"
# No control character of a file reaches the terminal.
printf 'QGC WPL 110\n\033[31mred\a 0 0 16 0 0 0 0 1 2 3 1\n' > "$scratch/red.waypoints"
expect 3 "red.waypoints:2: expected a number as number, found '?[31mred?'" \
  check --route "$scratch/red.waypoints" --scenario "$scratch/small.yaml"

# The test runner refuses an option that ctest would pass over to run everything.
said=$(ALTIPLAN_SKIP_SETUP=1 "$2/tools/test" --quik 2>&1 < /dev/null)
if [[ $? -ne 2 || $said != *"expected --quick or an option of ctest, found '--quik'"* ]]; then
  printf 'tools/test --quik\n%s\n' "$said"
  failed=1
fi

# A decimal comma in the environment changes no number that is read or written.
if localedef -i de_DE -f UTF-8 "$scratch/de_DE.UTF-8" 2> /dev/null &&
  [[ $(LOCPATH=$scratch LC_ALL=de_DE.UTF-8 bash -c 'printf %.1f 2,5' 2> /dev/null) == 2,5 ]]; then
  "$program" run "$pipeline" --out "$scratch/point.json" > /dev/null
  LOCPATH=$scratch LC_ALL=de_DE.UTF-8 "$program" run "$pipeline" --out "$scratch/comma.json" > /dev/null
  if ! diff <(grep -v time_s "$scratch/point.json") <(grep -v time_s "$scratch/comma.json"); then
    echo 'a decimal comma in the locale changes the result'
    failed=1
  fi
else
  echo 'skipped: there is no localedef with the sources of de_DE for a locale with a decimal comma'
fi
exit "$failed"
