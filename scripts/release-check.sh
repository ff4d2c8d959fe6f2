#!/usr/bin/env bash
# Says what still stands between this checkout and a release to crates.io: scripts/release-check.sh
# It publishes nothing. What it asks for is listed at its end; then `.ci/run` has to pass, too, and
# `cargo publish --workspace` does the rest.
set -uo pipefail
cd "$(dirname "$0")/.."

problems=()
problem() { problems+=("$1"); }

manifest=$(cargo metadata --no-deps --locked --format-version 1) || exit
# Packages that are published, a line each: name, version, repository.
packages=$(python3 -c '
import json, sys
for package in json.load(sys.stdin)["packages"]:
    if package["publish"] is None:
        print(package["name"], package["version"], package["repository"] or "-")
' <<<"$manifest") || exit
version=$(awk 'NR == 1 { print $2 }' <<<"$packages")

[ -z "$(git status --porcelain)" ] || problem "the checkout has changes that are not committed"
[ "$(awk '{ print $2 }' <<<"$packages" | sort -u | wc -l)" = 1 ] || problem "not all packages have version $version"
while read -r name _ repository; do
  [ "$repository" != - ] || problem "$name: its manifest has no \`repository\`, the address where its sources are"
done <<<"$packages"
grep -q "^## $version, [0-9]\{4\}-[0-9][0-9]-[0-9][0-9]$" CHANGELOG.md ||
  problem "CHANGELOG.md has no heading \`## $version, YYYY-MM-DD\`"
! grep -q "^## Unreleased" CHANGELOG.md || problem "CHANGELOG.md has an \`Unreleased\` part"
for folder in arl-lang arl-robot arl-motion arl-rt drivers library arl-sources arl-macros transpiler wire terminal runs project editor command; do
  for file in LICENSE-MIT LICENSE-APACHE; do
    cmp -s "$file" "$folder/$file" || problem "$folder/$file is not the licence of this project"
  done
done

# What was public must still be so, where a release with the same first part that counts is out.
if known=$(cargo info --registry crates-io arl-rt 2>&1); then
  released=$(awk '$1 == "version:" { print $2 }' <<<"$known")
  if command -v cargo-semver-checks >/dev/null; then
    for name in arl-lang arl-robot arl-motion arl-rt arl-drivers arl-library; do
      cargo semver-checks --package "$name" || problem "$name: its version promises more than it keeps"
    done
  else
    problem "\`cargo install cargo-semver-checks\` first: $released is out, and nobody has compared with it"
  fi
elif ! grep -q "could not find" <<<"$known"; then
  problem "nobody knows what is out: $(tail -n 1 <<<"$known")"
fi

ARL_MSRV=required .ci/run package msrv || problem "\`.ci/run package msrv\` failed"

if [ ${#problems[@]} -gt 0 ]; then
  printf '\nnot yet:\n'
  printf -- '- %s\n' "${problems[@]}"
  exit 1
fi
printf '\nready: .ci/run, then git tag v%s, then cargo publish --workspace\n' "$version"
