#!/bin/sh
# Writes the samples and lets the judges of one format read them: judge.sh WRITE_SAMPLES FORMAT
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
"$1" "$folder" || exit 1
/usr/bin/python3 "$(dirname "$0")/judges.py" "$folder" "$2"
