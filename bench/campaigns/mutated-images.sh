#!/usr/bin/env bash
# Reads damaged files of images, made of those in tests/corpus/image: numbers of headers changed, bits flipped, pieces
# cut out, repeated and mixed; and makes the surfaces of those that are small. Each must end, sound or with a reason.
#   bench/campaigns/mutated-images.sh [CASES]      by default 20,000; a case at fault is left as build/release/mutated_image_N
set -euo pipefail
cd "$(dirname "$0")/../.."
source scripts/lib/apt.sh
need_packages "${build_packages[@]}"
cmake --preset release >/dev/null
cmake --build --preset release --target test_images
cd build/release
OCTAFRONT_MUTATED_IMAGES=${1:-20000} exec tests/images/test_images --gtest_filter='MutatedImages.*'
