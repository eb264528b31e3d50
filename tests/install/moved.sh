#!/bin/sh
# An installation that was moved finds its mixes beside it: moved.sh CMAKE BUILD_FOLDER. A mix that lies in no other
# folder shows which one is read.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$1" --install "$2" --prefix "$folder/first" >/dev/null
mv "$folder/first" "$folder/second"
mixes=$folder/second/share/tremie/reference_data/mixes
sed 's/"54 Pa"/"57 Pa"/' "$mixes/mix_a.toml" >"$mixes/mix_of_this_folder.toml"
printf 'apparatus = "slump_flow"\nmix = "mix_of_this_folder"\n' >"$folder/scene.toml"
cd /
"$folder/second/bin/tremie" check "$folder/scene.toml" | grep '^yield_stress = "57 Pa"'
