#!/usr/bin/env bash
# Installs the named Debian packages that are missing: as root, or by sudo.
# usage: tools/apt.sh PACKAGE...
# Exit code 0: all there. 1: some are missing and apt may not be used or failed; their names are printed.
set -euo pipefail

missing=()
for package in "$@"; do
    status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
    [ "$status" = installed ] || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

give_up() {
    echo "missing: ${missing[*]} ($1)" >&2
    exit 1
}

command -v apt-get >/dev/null || give_up "no apt-get here: install what your system calls them"
if [ "$(id -u)" = 0 ]; then
    as_root=(env)
elif command -v sudo >/dev/null && { [ -t 0 ] || sudo -n true 2>/dev/null; }; then
    as_root=(sudo)
else
    give_up "neither root nor sudo: ask for 'apt-get install ${missing[*]}'"
fi
as_root+=(DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300)

echo "installing: ${missing[*]}"
if ! compgen -G '/var/lib/apt/lists/*_Packages*' >/dev/null; then
    "${as_root[@]}" update >/dev/null || give_up "apt-get update failed"
fi
# A list that has grown old names files that the mirror no longer has: update once and try again.
install=("${as_root[@]}" install -y --no-install-recommends "${missing[@]}")
"${install[@]}" >/dev/null || { "${as_root[@]}" update >/dev/null && "${install[@]}" >/dev/null; } || give_up "apt-get install failed"
