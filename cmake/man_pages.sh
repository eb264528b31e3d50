#!/bin/sh
# Man pages from the program's own help: man_pages.sh HELP2MAN PROGRAM FOLDER. One for tremie, one a command.
set -eu
folder=$3
rm -rf "$folder"
mkdir -p "$folder"
version=$("$2" --version)
version=${version% for *}
# page NAME PROGRAM-AND-COMMAND DESCRIPTION
page() {
  "$1" --no-info --version-string "$version" --name "$4" "$3" |
    sed -e "s/^\.TH TREMIE /.TH $(printf %s "$2" | tr a-z A-Z) /" -e "/^\.SH NAME/{n;s/^tremie /$2 /;s/^tremie\\\\-/$2 \\\\-/}" |
    gzip -9n >"$folder/$2.1.gz"
}
page "$1" tremie "$2" "virtual test apparatus for thixotropic fresh concrete"
# A command that is not in this build has no help, and no page.
"$2" --commands | while IFS="$(printf '\t')" read -r command description; do
  "$2" "$command" --help >/dev/null 2>&1 || continue
  page "$1" "tremie-$command" "$2 $command" "$description"
done
