#!/usr/bin/env bash
# The benchmarks, by name. Builds what they need.
#   bench/run.sh status      every model of bench/models/models.csv: valid? how true is the boundary?   -> docs/measured/status.md
#   bench/run.sh derived     the clean models and what is derived from them: any element that nothing forces? any cliff?
#                                                                                    -> docs/measured/derived-status.md
#   bench/run.sh pipeline    three models at 100 k and 1 M elements, elements per second and stage -> docs/measured/benchmarks.md
#                            --beside PROGRAM: against another build of octafront, side by side
#   bench/run.sh surface     surfaces of all clean models and beside other remeshers  -> docs/measured/surface-status.md, benchmarks.md
#   bench/run.sh elements    --elements N met? prediction, sizes in the volume          -> docs/measured/benchmarks.md
#   bench/run.sh gradation   gradations from .05 to .5 side by side                       -> docs/measured/gradation.md
#   bench/run.sh volume      kept surfaces up to 10 M elements, against TetGen, HXT and Netgen -> docs/measured/volume-bench.md
#   bench/run.sh graded      sizes that follow curvature, against HXT and TetGen side by side; from STL -> docs/measured/graded.md
#   bench/run.sh peers       surfaces kept and made anew, against TetGen, Gmsh, Netgen and CGAL -> build/release/experiments/peers.json
#   bench/run.sh experiments [STEP...]   three methods, a skull and those peers: about 20 minutes -> docs/measured/experiments.md, peers.md;
#                            steps: dragon compare growth skull peers pictures page
#   bench/run.sh complexes   several regions in one mesh, against TetGen and Gmsh       -> docs/measured/complexes.md
#   bench/run.sh improve     improvement against its targets, never worse, start meshes of others -> docs/measured/improve-bench.md
#   bench/run.sh adapt       the Working Group's cases of metrics, a loop with FEniCSx -> docs/measured/adapt.md
#   bench/run.sh adapt_loops  meshes adapted to small and large sizes in turn, ten times -> docs/measured/adapt-isotropic.md
#   bench/run.sh carry       fields on 30 pairs of meshes: integrals, bounds, order of convergence, a million elements -> docs/measured/carry.md
#   bench/run.sh move        a ball as a level set in twenty places of a box; blocks and bars stretched, flattened, bent, twisted -> docs/measured/move.md
#   bench/run.sh motion      bodies in fifty steps: bent, twisted, pressed, growing, sloshing; MMG3D=PROGRAM beside it -> docs/measured/motion.md
#   bench/run.sh formats     how fast meshes are written, every format beside a plain write -> docs/measured/formats-bench.md
#   bench/run.sh parts       meshes in parts: what divisions are worth, time and memory beside one file -> docs/measured/parts.md
#   bench/run.sh second_order   all clean models, balls, tori, cylinders: proven? how true? at what cost? -> docs/measured/second-order.md
#   bench/run.sh repair      the defective models, repaired and meshed; --near N: held to 1 ‰, too -> docs/measured/repair-status.md
#   bench/run.sh known_answers   2,000 clean models damaged in known ways, repaired and judged -> docs/measured/repair-known.md
#   bench/run.sh damage      clean models damaged in 24 ways beside the undamaged ones -> docs/measured/damage.md
#   bench/run.sh images      volumes of labels, each label judged; --peers: beside CGAL -> docs/measured/images-status.md
#   bench/run.sh images_needed   label images at sizes coarser than voxels: elements made and needed, Dice; --beside PROGRAM: another
#                            build of octafront    -> docs/measured/images-needed.md
#   bench/run.sh four_shells  four concentric spheres as a head, of voxels and of surfaces, solved: potentials beside the series -> docs/measured/four-shells.md
#   bench/run.sh thin        plates, discs, tubes, shells 1:10 to 1:1e6, beside Gmsh and TetGen -> docs/measured/thin-bodies.md
#   bench/run.sh budget      automatic sizes: budget said, elements made, time, what was given up -> docs/measured/budget-status.md
#   bench/run.sh cad         CAD files at parts of their diagonal: volumes, areas, names, nodes on the geometry, time; --peers: beside Gmsh
#                            and Netgen; --models FOLDER: other files  -> docs/measured/cad.md
#   bench/run.sh layers      boundary layers on all clean models: coverage, validity, quality, speed -> docs/measured/layers.md
#   bench/run.sh layers_shapes   the same on bodies whose layers are known; layers_flows: around bodies, in vessels; layers_peers: beside snappyHexMesh
#                            and Gmsh (-> docs/measured/layers-flows.md); layers_solved: a laminar pipe with and without -> docs/measured/layers-solved.md
#   bench/run.sh flows       a car, a wing and a bracket in a wind tunnel, tetrahedra and polyhedra, solved by simpleFoam -> docs/measured/flows.md
#   bench/run.sh cavity      a lid-driven cavity on tetrahedra, their dual and polyDualMesh's, beside published values -> docs/measured/cavity.md
#   bench/run.sh freecad     jobs from FreeCAD to CalculiX, meshed by Gmsh as FreeCAD does it and by our workbench -> docs/use/freecad.md
#   bench/run.sh high_order [STEP...]  orders 2 to 4: how true are walls, how good elements of 30 models, beside Gmsh and Netgen; a Poisson problem
#                            solved by DOLFINx and MFEM; speed (20 minutes) -> docs/measured/high-order.md
#   bench/run.sh inside      sheets, lines and points in a block, beside Gmsh and TetGen     -> docs/measured/inside.md
#   bench/run.sh periodic    periodic cells with and without periods, beside Gmsh, solved    -> docs/measured/periodic.md
#   bench/run.sh ranks       one mesh by 1, 2, 4 and 8 processes: memory, bytes, imbalance, what all do alike -> docs/measured/ranks.md
#   bench/run.sh coarse_input   surfaces of a million triangles at coarse sizes: time by stage, by triangle; --beside PROGRAM -> docs/measured/coarse-input.md
#   bench/run.sh threads     what is serial in each stage, and what that predicts for 2, 16 and 64 threads -> docs/measured/threads.md
#   bench/run.sh dry_run     mesh --dry-run: elements, time and memory said and taken -> docs/use/command-line.md
#   bench/run.sh answers     bodies with known answers, meshed by ours, Gmsh and Netgen, solved by CalculiX: errors against unknowns and time;
#                            --constants: other constants of automatic sizes  -> docs/measured/answers.md
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/lib/apt.sh

case ${1:-} in
  status | derived | pipeline | surface | elements | gradation | volume | graded | peers | experiments | complexes | improve | adapt | adapt_loops | carry | move | motion | formats | parts | second_order | dry_run | repair | known_answers | damage | images | images_needed | four_shells | thin | budget | cad | layers | layers_shapes | layers_flows | layers_peers | layers_solved | inside | periodic | ranks | threads | coarse_input | answers | polyhedral | flows | cavity | high_order | freecad) ;;
  *) sed -n '2,/^set/s/^# \{0,1\}//p' "$0"; exit 2 ;;
esac
need_packages "${build_packages[@]}" python3
[ "$1" != surface ] || need_packages gmsh netgen libcgal-dev libgmp-dev libmpfr-dev
{ [ "$1" != volume ] && [ "$1" != graded ]; } || need_packages "${peer_packages[@]}"
[ "$1" != improve ] || need_packages "${peer_packages[@]}"
[ "$1" != thin ] || need_packages tetgen gmsh
[ "$1" != cad ] || need_packages gmsh netgen "${cad_packages[@]}"
[ "$1" != cad ] || [ -d cad-models ] || bench/models/get-cad.sh
[ "$1" != answers ] || need_packages gmsh python3-gmsh netgen calculix-ccx python3-numpy python3-meshio "${cad_packages[@]}"
[ "$1" != peers ] || need_packages "${peer_packages[@]}" libcgal-dev libgmp-dev libmpfr-dev libboost-dev
[ "$1" != experiments ] || need_packages "${peer_packages[@]}" libcgal-dev libgmp-dev libmpfr-dev libboost-dev python3-matplotlib python3-vtk9 xvfb xauth
[ "$1" != experiments ] || [ -d models/ct ] || bench/models/get-models.sh --ct
[ "$1" != ranks ] || need_packages "${mpi_packages[@]}"
[ "$1" != complexes ] || need_packages "${test_packages[@]}" tetgen gmsh python3-gmsh
[ "$1" != known_answers ] || need_packages "${test_packages[@]}"
{ [ "$1" != repair ] && [ "$1" != damage ]; } || need_packages python3-numpy python3-meshio
[[ $1 != layers_* ]] || need_packages python3-numpy python3-meshio openfoam
{ [ "$1" != flows ] && [ "$1" != cavity ]; } || need_packages python3-numpy openfoam
[ "$1" != high_order ] || need_packages python3-numpy python3-gmsh python3-netgen python3-dolfinx "${cad_packages[@]}"
[ "$1" != freecad ] || need_packages freecad gmsh calculix-ccx "${cad_packages[@]}"
{ [ "$1" != adapt ] && [ "$1" != motion ]; } || need_packages python3-numpy python3-dolfinx
[ "$1" != periodic ] || need_packages calculix-ccx
{ [ "$1" != inside ] && [ "$1" != periodic ]; } || need_packages python3-numpy python3-meshio python3-gmsh tetgen
[ "$1" != layers_peers ] || need_packages python3-gmsh
[ "$1" != images ] || need_packages libcgal-dev libgmp-dev libmpfr-dev libboost-dev
[ "$1" != images_needed ] || need_packages python3-numpy python3-nibabel
[ "$1" != four_shells ] || need_packages python3-numpy python3-scipy python3-nibabel python3-meshio
[[ $1 != images* ]] || [ -d volumes ] || bench/models/get-volumes.sh
[ "$1" = move ] || [ "$1" = motion ] || [ "$1" = formats ] || [ "$1" = ranks ] || [ "$1" = adapt ] || [ "$1" = complexes ] || [ "$1" = four_shells ] || [[ $1 = images* ]] || [ "$1" = thin ] || [ "$1" = cad ] || [ "$1" = answers ] || [ "$1" = flows ] || [ "$1" = cavity ] || [ "$1" = high_order ] || [ "$1" = freecad ] || [ -d models/clean ] || bench/models/get-models.sh --ct
tests=OFF
[ "$1" != complexes ] && [ "$1" != known_answers ] || tests=ON  # what makes complexes is theirs, and a judge
mpi=()
[ "$1" != ranks ] || mpi=(-DOCTAFRONT_MPI=ON)
cmake --preset release -DOCTAFRONT_BUILD_TESTS=$tests "${mpi[@]}" >/dev/null
cmake --build --preset release --target octafront_cli octafront_evaluate octafront_judge_surface
[ "$1" != cad ] || cmake --build --preset release --target octafront_cad_program octafront_judge_cad
{ [ "$1" != answers ] && [ "$1" != freecad ]; } || cmake --build --preset release --target octafront_cad_program
[ "$1" != derived ] || [ -d models/derived ] || bench/models/derive-models.sh build/release/cli/octafront
[ "$1" != adapt ] || cmake --build --preset release --target octafront_adapt_cases octafront_python
[ "$1" != adapt_loops ] || cmake --build --preset release --target octafront_adapt_loops
[ "$1" != improve ] || cmake --build --preset release --target octafront_never_worse
[ "$1" != formats ] || cmake --build --preset release --target octafront_write_formats
[ "$1" != parts ] || cmake --build --preset release --target octafront_write_parts
[ "$1" != threads ] || cmake --build --preset release --target octafront_threads
[ "$1" != second_order ] || cmake --build --preset release --target octafront_second_order
[ "$1" != complexes ] || cmake --build --preset release --target make_complexes
[ "$1" != known_answers ] || cmake --build --preset release --target octafront_judge_answer
[ "$1" != repair ] || cmake --build --preset release --target octafront_judge_repair
{ [ "$1" != peers ] && [ "$1" != experiments ]; } || cmake --build --preset release --target peer_cgal_mesh || echo "without CGAL's mesher" >&2
[ "$1" != images ] || cmake --build --preset release --target octafront_judge_image peer_cgal_labels
[ "$1" != images_needed ] || cmake --build --preset release --target octafront_judge_image
[[ $1 != layers_* ]] || [ -d models/flows ] || bench/models/get-flows.sh build/release/cli/octafront
python=python3
[ "$1" != repair ] && [ "$1" != known_answers ] && [ "$1" != damage ] && [[ $1 != images* ]] || python=/usr/bin/python3  # Debian's, with its NumPy
[[ $1 != layers_* ]] && [ "$1" != polyhedral ] && [ "$1" != flows ] && [ "$1" != cavity ] && [ "$1" != high_order ] && [ "$1" != inside ] && [ "$1" != periodic ] && [ "$1" != answers ] && [ "$1" != four_shells ] || python=/usr/bin/python3
exec "$python" -m "bench.run.$1" build/release "${@:2}"
