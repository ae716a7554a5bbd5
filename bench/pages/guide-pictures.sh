#!/usr/bin/env bash
# Runs docs/use/guide.md and makes its pictures anew from what it leaves.
#   bench/pages/guide-pictures.sh [PYTHON]    an environment's Python that has octafront; by default that of the tests
set -euo pipefail
cd "$(dirname "$0")/../.."
source scripts/lib/apt.sh
need_packages python3-vtk9 python3-numpy xvfb xauth calculix-ccx tetgen chromium
python=${1:-build/release/tests/python/wheel/venv/bin/python}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$python" tests/docs/run_docs.py --all --keep "$work/guide" docs/use/guide.md >/dev/null
"$python" bench/pages/guide_page.py "$work/notebook.html"
chromium --headless --no-sandbox --disable-gpu --hide-scrollbars --force-device-scale-factor=1.5 --window-size=680,160 \
  --screenshot=docs/images/guide-notebook.png "file://$work/notebook.html" 2>/dev/null
render() { # mesh, picture, options
  local mesh=$1 picture=$2 && shift 2
  xvfb-run -a /usr/bin/python3 bench/pages/render.py "$mesh" "$picture" --size 800 560 "$@"
}
knot=(--cut 0,0,1 --keep 0.6 --view 0.2,-0.35,1)
render "$work"/guide/*/scan.vtu docs/images/guide-scan.png "${knot[@]}"
render "$work"/guide/*/bend.vtu docs/images/guide-sizes.png --cut 0,1,0 --up 0,0,1 --keep 0.5 --view 0.3,1,0.5
"$(dirname "$python")/octafront" convert "$work"/guide/*/knot.1.ele -o "$work/before.vtu" -q
render "$work/before.vtu" "$work/before.png" "${knot[@]}"
render "$work"/guide/*/better.vtu "$work/after.png" "${knot[@]}"
/usr/bin/python3 bench/pages/side_by_side.py docs/images/guide-improve.png "$work/before.png" "$work/after.png"
xvfb-run -a env PYTHONPATH=examples/solve /usr/bin/python3 bench/pages/guide_bracket.py "$(dirname "$work"/guide/*/pull.frd)" docs/images/guide-calculix.png
