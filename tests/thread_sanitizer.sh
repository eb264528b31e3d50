#!/usr/bin/env bash
# Two threads under the thread sanitizer: tests/thread_sanitizer.sh library, the loops of libmpm, two to four minutes; without
# "library" every apparatus too, ten minutes on two cores. Needs clang 14 and its OpenMP, whose tool (archer) tells the
# sanitizer what OpenMP orders.
set -euo pipefail
cd "$(dirname "$0")/.."
cmake -S . -B build/thread -G Ninja -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_C_COMPILER=clang \
      -DCMAKE_CXX_FLAGS="-O1 -g1" -DTREMIE_SANITIZE=thread -DTREMIE_PICTURES=OFF -DTREMIE_PYTHON=OFF
export OMP_TOOL_LIBRARIES=/usr/lib/llvm-14/lib/libarcher.so TSAN_OPTIONS="ignore_noninstrumented_modules=1 exitcode=66"
cmake --build build/thread --target library_with_two_threads
# This sanitizer does not know every layout of the address space that a kernel may choose.
fixed_addresses=$(setarch -R true 2>/dev/null && echo "setarch -R" || true)
$fixed_addresses build/thread/library_with_two_threads
[ "${1:-}" != library ] || exit 0

cmake --build build/thread --target tremie
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
races=0
scene() {  # NAME and what follows tremie run
  local name=$1 code=0
  shift
  $fixed_addresses build/thread/tremie run "$@" --threads 2 --out "$out/$name" --quiet 2> "$out/$name.log" || code=$?
  echo "$name: exit $code, $(grep -c 'WARNING: ThreadSanitizer' "$out/$name.log" || true) races"
  if grep -q 'ThreadSanitizer' "$out/$name.log" || { [ "$code" -ne 0 ] && [ "$code" -ne 3 ]; }; then
    cat "$out/$name.log" >&2
    races=1
  fi
}
coarse='model.cell=["20 mm","10 mm"]'
scene section apparatus/scenes/slump_flow_mix_a.toml --set "$coarse" --set test.duration="0.5 s"
scene quarter apparatus/scenes/slump_flow_mix_a_quarter.toml --set "$coarse" --set test.duration="0.3 s"
scene box apparatus/scenes/l_box.toml --set model.space=half --set test.bars=2 --set model.cell="20 mm" --set test.duration="0.05 s"
scene vane apparatus/scenes/icar_vane_mix_a.toml --set model.space=plane --set test.duration="0.2 s"
scene explicit apparatus/scenes/paper_mix_a.toml --set test.duration="0.02 s"
exit $races
