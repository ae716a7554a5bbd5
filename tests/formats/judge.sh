#!/bin/sh
# Writes the samples and lets the judges of one format read them: judge.sh WRITE_SAMPLES FORMAT; without a format those
# of wedges and pyramids, in all formats; parts FORMAT: those of meshes in parts; fields, polyhedra: of these, in all
# formats.
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
"$1" "$folder" || exit 1
if [ $# -eq 1 ]; then /usr/bin/python3 "$(dirname "$0")/mixed_judges.py" "$folder"
elif [ "$2" = polyhedra ]; then /usr/bin/python3 "$(dirname "$0")/poly_judges.py" "$folder"
elif [ "$2" = fields ]; then /usr/bin/python3 "$(dirname "$0")/field_judges.py" "$folder"
elif [ "$2" = parts ]; then /usr/bin/python3 "$(dirname "$0")/parts_judges.py" "$folder" "$3"
else /usr/bin/python3 "$(dirname "$0")/judges.py" "$folder" "$2"
fi
