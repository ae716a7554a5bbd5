#!/usr/bin/env bash
# Makes the page of `octafront ui`, build/ui/octafront-ui.html, which the program looks for beside itself and in its build tree.
# three.js and esbuild come from npm.
#   scripts/ui.sh                    makes the page
#   scripts/ui.sh --test             and tests it in Chromium, with what was built in build/release
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/lib/apt.sh
for program in node npm; do
  command -v "$program" >/dev/null || need_packages nodejs npm
done
work=$PWD/build/ui
mkdir -p "$work/npm"
cp web/ui/package.json "$work/npm/"
(cd "$work/npm" && npm install --ignore-scripts --no-audit --no-fund --no-package-lock --loglevel=error >/dev/null)
python3 web/ui/assemble.py "$work/npm/node_modules" "$work"
[ "${1:-}" = --test ] || exit 0
need_packages "${browser_packages[@]}"
/usr/bin/python3 tests/cli/ui_test.py build/release/cli/octafront samples
