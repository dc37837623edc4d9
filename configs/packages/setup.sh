#!/usr/bin/env bash
# Installs what debian.txt lists and this machine lacks. Exit code 2: somebody else must do it.
set -euo pipefail

list="$(dirname "${BASH_SOURCE[0]}")/debian.txt"

if ! command -v dpkg-query >/dev/null; then
    echo "setup: not a Debian system, so nothing is checked; $list names what vfplan needs." >&2
    exit 0
fi

mapfile -t wanted < <(sed -e 's/#.*//' -e 's/[[:space:]]*$//' -e '/^$/d' "$list")

# One query for all: packages that dpkg knows as installed, or that an installed one provides.
installed="$(dpkg-query -W -f '${db:Status-Status} ${binary:Package} ${Provides}\n' |
    sed -n 's/^installed //p' | sed -E 's/:[a-z0-9]+//g; s/\([^)]*\)//g; s/,/ /g' | tr -s ' ' '\n')"
missing=()
for package in "${wanted[@]}"; do
    grep -qxF -- "$package" <<<"$installed" || missing+=("$package")
done

if ((${#missing[@]} == 0)); then
    echo "setup: all ${#wanted[@]} packages are there."
    exit 0
fi

if ((EUID == 0)); then
    as_root=(env)
elif command -v sudo >/dev/null && sudo -n true 2>/dev/null; then
    as_root=(sudo -n env)
else
    {
        echo "setup: ${#missing[@]} of ${#wanted[@]} packages are missing, and only root can install them:"
        printf '    %s\n' "${missing[@]}"
        echo "Ask an administrator to run:"
        echo "    apt-get update && apt-get install --no-install-recommends -y ${missing[*]}"
    } >&2
    exit 2
fi

echo "setup: installing ${missing[*]}"
"${as_root[@]}" DEBIAN_FRONTEND=noninteractive apt-get update -q </dev/null
"${as_root[@]}" DEBIAN_FRONTEND=noninteractive apt-get install --no-install-recommends -y -q \
    "${missing[@]}" </dev/null
