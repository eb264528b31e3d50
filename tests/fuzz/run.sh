#!/bin/sh
# Runs every fuzz target for SECONDS each (20): tests/fuzz/run.sh [SECONDS]. Needs the preset fuzz to be built. What is
# found lies in build/fuzz/found.
set -e
cd "$(dirname "$0")/../.."
mkdir -p build/fuzz/found
run() {
  target=$1
  shift
  mkdir -p "build/fuzz/corpus/$target"
  "build/fuzz/fuzz_$target" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=1024 -max_len=8192 \
    -artifact_prefix="build/fuzz/found/$target-" "build/fuzz/corpus/$target" "$@"
}
seconds=${1:-20}
run scene apparatus/scenes reference_data/mixes
run units tests/fuzz/corpus/units
run record reference_data/site_torque reference_data/rheocem
run checkpoint tests/fuzz/corpus/checkpoint
