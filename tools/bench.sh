#!/usr/bin/env bash
# All measurements of the speed, into runs/bench/, and their tables and roofline into docs/. Some ten minutes; a quiet
# machine gives the figures that it can reach.
# usage: tools/bench.sh [--keep-docs | --only-docs]    only runs/bench/, or only docs/ from what is there
set -euo pipefail
cd "$(dirname "$0")/.."

dgmpm=$(tools/program.sh)
out=runs/bench
[ "${1:-}" = --only-docs ] || "$dgmpm" bench --all "$out" --mesh meshes/square_unstructured.msh
[ "${1:-}" != --keep-docs ] || exit 0

# Between the markers of the document: machine and date, then the tables.
machine=$(sed -n 's/^# machine: //p' "$out/bench.csv")
{
    echo
    echo "Made by \`make bench\` on $(LC_ALL=C date '+%-d %B %Y'): $machine."
    echo
    cat "$out/tables.md"
    echo
} >"$out/section.md"
document=docs/performance.md
awk -v section="$out/section.md" '
    /<!-- bench:end -->/ { inside = 0 }
    !inside { print }
    /<!-- bench:begin -->/ { inside = 1; while ((getline line < section) > 0) print line }
' "$document" >"$out/performance.md"
grep -q '<!-- bench:end -->' "$out/performance.md" || { echo "$document has no bench markers" >&2; exit 1; }
cp "$out/performance.md" "$document"
cp "$out/roofline.svg" docs/img/roofline.svg
echo "tables in $document, picture in docs/img/roofline.svg"
