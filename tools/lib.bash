# SPDX-License-Identifier: Apache-2.0
# Shared by the scripts in this folder. Messages go to stderr, results to stdout.
# shellcheck shell=bash

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

say() { echo "${0##*/}: $*" >&2; }

# setup GROUP: installs the packages of that group, unless ALTIPLAN_SKIP_SETUP is set.
setup() {
  if [[ -z ${ALTIPLAN_SKIP_SETUP:-} ]]; then
    "$root/tools/setup" "$1"
  fi
}

# quietly COMMAND…: shows what the command prints only if it fails.
quietly() {
  local log status=0
  log=$(mktemp)
  "$@" >"$log" 2>&1 || status=$?
  if [[ $status -ne 0 ]]; then
    cat "$log" >&2
    say "failed (exit $status): $*"
  fi
  rm -f "$log"
  return "$status"
}

# configure PRESET TESTING: configures build/PRESET, unless it exists, with tests if TESTING is ON.
configure() {
  local folder=$root/build/$1
  if [[ ! -f $folder/build.ninja ]] ||
    { [[ $2 == ON ]] && ! grep -q '^BUILD_TESTING:BOOL=ON$' "$folder/CMakeCache.txt"; }; then
    quietly cmake -S "$root" --preset "$1" -DBUILD_TESTING="$2"
  fi
}

# build PRESET [TARGET…]
build() {
  local preset=$1 cache
  shift
  # ccache fails without a writable folder, e.g. for a user without a home folder.
  cache=$(ccache --get-config cache_dir 2>/dev/null) || cache=
  if [[ -z $cache ]] || ! mkdir -p "$cache" 2>/dev/null || [[ ! -w $cache ]]; then
    export CCACHE_DIR=$root/build/ccache
  fi
  if [[ ! -x $root/build/$preset/bin/altiplan-run ]]; then
    say "building into build/$preset; the first time takes some minutes"
  else
    say "building what changed into build/$preset"
  fi
  quietly cmake --build "$root/build/$preset" ${1:+--target "$@"}
}
