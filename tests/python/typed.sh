#!/bin/sh
# Do the stubs accept and refuse what they should?  typed.sh SOURCE
# Skipped where there is no mypy; scripts/test.sh --all installs it.
cd "$1/tests/python" || exit 1
command -v mypy >/dev/null || { echo "no mypy here: skipped"; exit 77; }
found=$(MYPYPATH="$1/python" /usr/bin/mypy --strict --python-version 3.11 --cache-dir /dev/null --no-error-summary typed.py |
  sed -n 's/^typed.py:\([0-9]*\): error: .*\[\(.*\)\]$/\1 \2/p')
wanted=$(grep -n '# error: ' typed.py | sed 's/:.*# error: / /')
[ "$found" = "$wanted" ] && exit 0
printf 'wanted:\n%s\nfound:\n%s\n' "$wanted" "$found"
MYPYPATH="$1/python" /usr/bin/mypy --strict --python-version 3.11 --cache-dir /dev/null typed.py
exit 1
