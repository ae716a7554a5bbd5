#!/bin/sh
# Do the stubs accept and refuse what they should, and do they accept what the documentation tells to type?
#   typed.sh SOURCE
# Skipped where there is no mypy; scripts/test.sh --all installs it.
cd "$1/tests/python" || exit 1
command -v mypy >/dev/null || { echo "no mypy here: skipped"; exit 77; }
export MYPYPATH="$1/python"
mypy="/usr/bin/mypy --python-version 3.11 --cache-dir /dev/null --no-error-summary"
found=$($mypy --strict typed.py | sed -n 's/^typed.py:\([0-9]*\): error: .*\[\(.*\)\]$/\1 \2/p')
wanted=$(grep -n '# error: ' typed.py | sed 's/:.*# error: / /')
[ "$found" = "$wanted" ] || {
  printf 'wanted:\n%s\nfound:\n%s\n' "$wanted" "$found"
  $mypy --strict typed.py
  exit 1
}

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
./code_of_docs.py "$scratch" ../../README.md ../../docs/use/guide.md ../../docs/use/python.md || exit 1
status=0
for code in "$scratch"/*.py; do $mypy --check-untyped-defs "$code" || status=1; done
exit $status
