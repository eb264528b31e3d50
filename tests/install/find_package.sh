#!/bin/sh
# A program of somebody else's finds the installed libraries where they were moved to, and runs a scene with them:
# find_package.sh CMAKE BUILD_FOLDER SOURCES. Reiner-Riwlin with tau_0 = 54 Pa, mu = 35.8 Pa.s at 0.5 rev/s in ICAR's gap:
# 4 pi h [Omega mu + tau_0 ln(R_o/R_i)]/(R_i^-2 - R_o^-2) = 1.252919 N.m, all of the gap sheared. And a
# film's surface, stepped with the library alone, moves within 0.5 % of its closed form (0.1 % on these cells).
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$1" --install "$2" --prefix "$folder/first" >/dev/null
mv "$folder/first" "$folder/second"
cd /
"$1" -S "$3" -B "$folder/build" -DCMAKE_PREFIX_PATH="$folder/second" >/dev/null
"$1" --build "$folder/build" >/dev/null
"$folder/build/consumer" | tee "$folder/said"
"$folder/build/one_body" | tee -a "$folder/said"
grep -q '^torque_N_m 1.252919' "$folder/said"
grep -q '^spread' "$folder/said"
grep -Eq '^surface_over_exact (1.00[0-4]|0.99[5-9])[0-9]$' "$folder/said"
