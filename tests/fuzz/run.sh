#!/bin/sh
# Runs every fuzz target for SECONDS each (20): tests/fuzz/run.sh [SECONDS]. Needs the preset sanitize to be built. What is
# found lies in build/sanitize/found.
set -e
cd "$(dirname "$0")/../.."
seconds=${1:-20}
here=$PWD
build=$here/build/sanitize
mkdir -p "$build/found" "$build/fuzz"
# Targets that read a file by its name find a study's base scene beside it.
cp apparatus/scenes/slump_flow_mix_c.toml "$build/fuzz/base.toml"
cp -r reference_data/mixes "$build/fuzz/"
run() {
  target=$1
  shift
  echo "fuzz $target"
  mkdir -p "$build/corpus/$target"
  (cd "$build/fuzz" && "$build/fuzz_$target" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=1024 -max_len=8192 \
    -artifact_prefix="$build/found/$target-" "$build/corpus/$target" "$@") >"$build/found/$target.log" 2>&1 ||
    { tail -n 60 "$build/found/$target.log"; exit 1; }
}
run scene "$here/apparatus/scenes" "$here/reference_data/mixes" "$here/tests/fuzz/corpus/scene"
run units "$here/tests/fuzz/corpus/units"
run record "$here/reference_data/site_torque" "$here/reference_data/rheocem"
run checkpoint "$here/tests/fuzz/corpus/checkpoint"
run study "$here/tests/fuzz/corpus/study"
run lab "$here/tests/fuzz/corpus/lab"
