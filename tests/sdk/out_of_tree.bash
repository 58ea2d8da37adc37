# SPDX-License-Identifier: Apache-2.0
# out_of_tree.bash SOURCE BUILD: installs the build, moves the installation, builds the plugin that
# CONTRIBUTING.md shows against it, and runs that plugin with the installed program.
set -euo pipefail
source_folder=$1
build_folder=$2

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

cmake --install "$build_folder" --prefix "$work/first" >install.log
mv first prefix
for file in bin/altiplan lib/cmake/altiplan/altiplan-config.cmake; do
  [[ -f prefix/$file ]] || { echo "not installed: $file" && exit 1; }
done

# The first block of a language in CONTRIBUTING.md.
block() { awk -v open="^\`\`\`$1\$" '/^```$/ { if (on) exit } on; $0 ~ open { on = 1 }' \
  "$source_folder/CONTRIBUTING.md"; }
mkdir straight
block cpp >straight/straight.cpp
block cmake >straight/CMakeLists.txt
cmake -S straight -B build -G Ninja -DCMAKE_PREFIX_PATH="$work/prefix" >configure.log
cmake --build build

cat >scenario.yaml <<'YAML'
altiplan: 1
environment:
  - box: {min_m: [400, 100, 0], max_m: [600, 300, 100]}
volume: {min_m: [0, -500, 0], max_m: [1000, 500, 200]}
start: {at_m: [0, 0, 50]}
goal: {at_m: [1000, 0, 50]}
YAML
cat >pipeline.yaml <<'YAML'
altiplan: 1
scenario: scenario.yaml
steps:
  - plan: straight
    with: {climb_first_m: 10}
YAML
prefix/bin/altiplan run pipeline.yaml --plugin-path build --out result.json
python3 - <<'PYTHON'
import json
result = json.load(open("result.json"))
assert result["status"] == "solved", result["message"]
assert result["route"] == [[0, 0, 50], [0, 0, 60], [1000, 0, 50]], result["route"]
PYTHON
