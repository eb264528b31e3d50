#!/bin/sh
# Runs every fuzz target for SECONDS each (20), two at a time: tests/fuzz/run.sh [SECONDS]. Needs the preset sanitize to be
# built. What is found lies in build/sanitize/found.
set -e
cd "$(dirname "$0")/../.."
seconds=${1:-20}
here=$PWD
build=$here/build/sanitize
mkdir -p "$build/found"
run() {
  target=$1
  shift
  echo "fuzz $target"
  # Targets that read a file by its name write it here; a study finds its base scene beside it.
  mkdir -p "$build/fuzz/$target" "$build/corpus/$target"
  cp "$here/apparatus/scenes/slump_flow_mix_c.toml" "$build/fuzz/$target/base.toml"
  cp -r "$here/reference_data/mixes" "$build/fuzz/$target/"
  (cd "$build/fuzz/$target" && "$build/fuzz_$target" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=1024 -max_len=8192 \
    -artifact_prefix="$build/found/$target-" "$build/corpus/$target" "$@") >"$build/found/$target.log" 2>&1 ||
    { tail -n 60 "$build/found/$target.log"; return 1; }
}
scene() { run scene "$here/apparatus/scenes" "$here/reference_data/mixes" "$here/tests/fuzz/corpus/scene"; }
record() { run record "$here/reference_data/site_torque" "$here/reference_data/rheocem"; }
units() { run units "$here/tests/fuzz/corpus/units"; }
checkpoint() { run checkpoint "$here/tests/fuzz/corpus/checkpoint"; }
study() { run study "$here/tests/fuzz/corpus/study"; }
lab() { run lab "$here/tests/fuzz/corpus/lab"; }
both() {
  "$1" &
  other=$!
  "$2"
  wait $other
}
both scene record
both units checkpoint
both study lab
