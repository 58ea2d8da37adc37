# SPDX-License-Identifier: Apache-2.0
# setup_test.bash SOURCE: tools/setup against an apt-get and a dpkg-query of our own, which note each
# call and install nothing.
set -euo pipefail
setup=$1/tools/setup

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/bin"
export WORK=$work

# Knows what is listed in $WORK/installed.
cat >"$work/bin/dpkg-query" <<'SCRIPT'
#!/bin/bash
grep -qx -- "${!#}" "$WORK/installed" || exit 1
echo -n installed
SCRIPT
# Knows no package before an update; fails to install while $WORK/broken is there.
cat >"$work/bin/apt-get" <<'SCRIPT'
#!/bin/bash
echo "$*" >>"$WORK/calls"
case "$*" in
  update) touch "$WORK/updated" ;;
  *--print-uris*)
    [[ -f $WORK/updated ]] || { echo "E: Unable to locate package" >&2 && exit 100; }
    echo "'http://deb/a.deb' a.deb 1500000 SHA256:0"
    echo "'http://deb/b.deb' b.deb 600000 SHA256:0"
    ;;
  install*)
    [[ ! -f $WORK/broken ]] || { echo "E: no space left" >&2 && exit 100; }
    ;;
esac
SCRIPT
printf '#!/bin/bash\necho 0\n' >"$work/bin/id"
chmod +x "$work"/bin/*
export PATH=$work/bin:$PATH

fail() {
  echo "$*: $(cat "$work/stderr" "$work/calls")"
  exit 1
}
# try STATUS ARGUMENT…: runs setup afresh and compares its exit status.
try() {
  local expected=$1 status=0
  shift
  : >"$work/calls"
  "$setup" "$@" 2>"$work/stderr" || status=$?
  [[ $status -eq $expected ]] || fail "setup $*: expected status $expected, found $status"
}
says() { grep -q -- "$1" "$work/stderr" || fail "expected the message '$1'"; }
calls() {
  [[ $(grep -c -- "$1" "$work/calls" || true) -eq $2 ]] || fail "expected $2 calls of '$1'"
}

# All that build needs, as setup itself says where there is nothing.
: >"$work/installed"
touch "$work/updated"
try 0 build
says "2 packages, 2.1 MB to download"
calls "^install .*--no-install-recommends -q .*cmake" 1
calls "^update" 0
for heavy in ompl benchmark clang chromium scipy gtest; do
  calls "$heavy" 0
done
sed -n 's/^tools.setup: installing for .build.: \(.*\) (.*/\1/p' "$work/stderr" | tr ' ' '\n' \
  >"$work/installed"

# Nothing is run when everything is there, and test asks for what build lacks.
try 0
calls . 0
try 0 test
calls "^install .* libgtest-dev" 2
calls "cmake" 0

# What benchmarks alone need comes with bench only.
try 0 bench
calls "^install .* libbenchmark-dev" 2

# Package lists are fetched once where they are missing.
rm "$work/updated"
try 0 ci
calls "^update" 1
says "fetching the package lists"

# What apt-get said is shown when it fails.
touch "$work/broken"
try 1 ci
says "E: no space left"
says "apt-get install failed"

try 1 everything
says "expected build, test, ci, docs, bench, package or abi, found 'everything'"
calls . 0
