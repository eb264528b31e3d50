#!/bin/bash
# The figures of explicit.md: the paper's scenes to 20 s, and what changes when one thing is changed.
#
#   paper_study.sh PROGRAM scenes      about 75 s of CPU a scene
#   paper_study.sh PROGRAM variants    20 mm cells, 3 s of flow: 6 s each
#
# One line a run: name, exit code, spread and height mm, peak of the mean shear rate 1/s, lambda at start and end, volume
# change, CPU s. Runs go to ./paper_study.
set -u
program=$(realpath "$1")
what=${2:-scenes}
scenes=$(realpath "$(dirname "$0")/../../apparatus/scenes")
out=paper_study
mkdir -p "$out"

run() {  # name, scene, KEY=VALUE ...
  local name=$1 scene=$2 sets=()
  shift 2
  for set in "$@"; do sets+=(--set "$set"); done
  timeout 1800 "$program" run "$scenes/$scene.toml" --set model.space=quarter "${sets[@]}" --threads 1 \
    --out "$out/$name" --force --quiet >"$out/$name.log" 2>&1
  local code=$?
  printf '%s | %s' "$name" "$code"
  for key in spread_mm height_mm shear_rate_mean_peak_per_s flocculation_mean_start flocculation_mean_end volume_change \
    cpu_s; do
    printf ' | %.5g' "$(sed -n "s/^ *\"$key\": *\([-0-9.e]*\),*\$/\1/p" "$out/$name/summary.json" | head -1)"
  done
  echo
}

flip=(model.transfer=flip model.flip_blend=1.0)
no_build_up='mix.thixotropy.critical_shear_rate="1e-6 1/s"'

if [ "$what" = scenes ]; then
  for scene in "$scenes"/paper_*.toml; do run "$(basename "$scene" .toml)" "$(basename "$scene" .toml)"; done
  for scene in paper_mix_a paper_mix_a_rest240 paper_mix_a_alpha003; do run "${scene}_flip" $scene "${flip[@]}"; done
  for scene in paper_mix_a_rest240 paper_mix_a_alpha003; do run "${scene}_no_build_up" $scene "$no_build_up"; done
  exit
fi

for scene in paper_mix_a paper_mix_a_rest240; do
  variant() {
    local name=$1
    shift
    run "$scene-$name" $scene 'model.cell="20 mm"' 'test.duration="3 s"' "$@"
  }
  variant base
  variant flip "${flip[@]}"
  variant usl model.scheme=explicit
  variant splines model.shape=b_spline
  variant pressure_by_point model.pressure=point
  variant m_1_s 'model.regularisation="1 s"'
  variant m_20_s 'model.regularisation="20 s"' model.time_step=auto
  variant K_1_MPa 'mix.bulk_modulus="1 MPa"'
  variant friction_0.2 floor.coefficient=0.2
  variant no_slip floor.contact=no_slip
  variant 3_points model.points_per_cell=3
  variant cone_gone_at_once test.lift_speed=instant
  variant 15_mm 'model.cell="15 mm"'
done
run paper_mix_a-10_mm paper_mix_a 'model.cell="10 mm"' 'test.duration="0.6 s"'
run paper_mix_a-10_mm_flip paper_mix_a 'model.cell="10 mm"' 'test.duration="0.6 s"' "${flip[@]}"
run paper_mix_a_rest240-10_mm paper_mix_a_rest240 'model.cell="10 mm"' 'test.duration="0.6 s"'
run paper_mix_a_rest240-10_mm_flip paper_mix_a_rest240 'model.cell="10 mm"' 'test.duration="0.6 s"' "${flip[@]}"
scene=paper_mix_a_rest240
variant roussel mix.thixotropy.kinetics=roussel
variant gate_1 'mix.thixotropy.critical_shear_rate="1 1/s"'
variant no_build_up "$no_build_up"
