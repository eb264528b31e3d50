#!/bin/sh
# Debian's changelog from the headings of ours: debian_changelog.sh CHANGELOG VERSION RELEASE. "## 0.2.0 (2026-11-26)" is a
# release of that day. "## Unreleased" is the project's version, on the day of the last commit.
set -eu
sed -n 's/^## \([0-9.]*\) (\([0-9-]*\))$/\1 \2/p; s/^## Unreleased$/unreleased -/p' "$1" | while read -r version day; do
  distribution=stable
  if [ "$version" = unreleased ]; then
    version=$2 distribution=UNRELEASED
    day=$(git -C "$(dirname "$1")" log -1 --format=%cs 2>/dev/null || date -u +%F)
  fi
  printf 'tremie (%s-%s) %s; urgency=medium\n\n' "$version" "$3" "$distribution"
  printf '  * Version %s; changelog.gz lists what changed for users.\n\n' "$version"
  printf ' -- Tremie contributors <maintainers@tremie.invalid>  %s\n\n' "$(LC_ALL=C date -u -R -d "$day")"
done
