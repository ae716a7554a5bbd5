#!/usr/bin/env bash
# All files of cad-models/ (bench/models/get-cad.sh) through octafront-cad: a table, one line a file, on standard output.
#   bench/campaigns/cad-campaign.sh [DEFLECTION [ANGLE [SECONDS]]]     DEFLECTION: of a file's diagonal; SECONDS: of CPU, per file
set -euo pipefail
cd "$(dirname "$0")/../.."
cmake --build --preset release --target octafront_cad_program cad_survey >&2
exec build/release/tests/cad/program/cad_survey "${1:-5e-4}" "${2:-.25}" "${3:-60}" cad-models/*
