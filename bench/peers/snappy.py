"""snappyHexMesh (Debian: openfoam): a box of cubes cut at a surface, layers put on some of its patches."""
import math
import pathlib
import shutil

from bench.judges.foam_mesh import new_case, write_dictionary
from bench.process import run_measured

BLOCK = """scale 1;
vertices (({0} {1} {2}) ({3} {1} {2}) ({3} {4} {2}) ({0} {4} {2}) ({0} {1} {5}) ({3} {1} {5}) ({3} {4} {5}) ({0} {4} {5}));
blocks (hex (0 1 2 3 4 5 6 7) ({6}) simpleGrading (1 1 1));
edges ();
boundary (far {{ type patch; faces ((0 3 2 1) (4 5 6 7) (0 1 5 4) (3 7 6 2) (0 4 7 3) (1 2 6 5)); }});
"""
FEATURES = """in.obj {{ extractionMethod extractFromSurface; includedAngle {included}; }}
"""
SNAPPY = """castellatedMesh true; snap true; addLayers true;
geometry {{ in.obj {{ type triSurfaceMesh; name body; regions {{ {regions} }} }} }}
castellatedMeshControls
{{
  maxLocalCells 10000000; maxGlobalCells 10000000; minRefinementCells 0; nCellsBetweenLevels 3; maxLoadUnbalance 0.1;
  features ({{ file "in.eMesh"; level {level}; }});
  refinementSurfaces {{ body {{ level ({level} {level}); }} }}
  resolveFeatureAngle 30; refinementRegions {{}}
  locationInMesh ({place}); allowFreeStandingZoneFaces true;
}}
snapControls
{{
  nSmoothPatch 3; tolerance 2; nSolveIter 100; nRelaxIter 5;
  nFeatureSnapIter 10; implicitFeatureSnap false; explicitFeatureSnap true; multiRegionFeatureSnap true;
}}
addLayersControls
{{
  relativeSizes false; expansionRatio {growth:.12g}; firstLayerThickness {first:.12g}; minThickness {least:.12g};
  layers {{ {walls} }}
  nGrow 0; featureAngle 130; slipFeatureAngle 30; nRelaxIter 5; nSmoothSurfaceNormals 1; nSmoothNormals 3; nSmoothThickness 10;
  maxFaceThicknessRatio 0.5; maxThicknessToMedialRatio 0.3; minMedialAxisAngle 90; nBufferCellsNoExtrude 0; nLayerIter 50;
  nRelaxedIter 20;
}}
meshQualityControls {{ #includeEtc "caseDicts/mesh/generation/meshQualityDict.cfg"
  minTetQuality -1e30; }}
mergeTolerance 1e-6;
"""


def numbers(values):
    return " ".join(f"{x:.12g}" for x in values)


def run(surface, folder, timeout, patches, walls, layers, size, far, box, place):
    """Meshes what is around `place` inside of `box` (low, high) and of the OBJ file with these patches, cubes of `far` halved until
    they are no larger than `size` at it. `layers`: number, first height, growth. An Outcome; the mesh is the case in the folder."""
    case = pathlib.Path(folder)
    count, first, growth = layers
    new_case(case)
    (case / "constant/triSurface").mkdir(parents=True)
    shutil.copy(surface, case / "constant/triSurface/in.obj")
    low, high = box
    cells = [max(1, math.ceil((b - a) / far - 1e-6)) for a, b in zip(low, high)]
    level = math.ceil(math.log2(far / size) - 1e-6)
    write_dictionary(case, "system/blockMeshDict", BLOCK.format(*low, *high, numbers(cells)))
    write_dictionary(case, "system/surfaceFeatureExtractDict", FEATURES.format(included=140))
    write_dictionary(case, "system/snappyHexMeshDict", SNAPPY.format(
        regions=" ".join(f"{p} {{ name {p}; }}" for p in patches), walls=" ".join(f"{p} {{ nSurfaceLayers {count}; }}" for p in walls),
        level=level, place=numbers(place), growth=growth, first=first, least=0.5 * first))
    outcome = run_measured(["sh", "-e", "-c", "export WM_PROJECT_DIR=/usr/share/openfoam; blockMesh; surfaceFeatureExtract; "
                            "snappyHexMesh -overwrite"], case, timeout)
    if not outcome.error and "Finished meshing" not in outcome.log:
        outcome.error = next((line for line in outcome.log.splitlines() if "FATAL" in line), "it ended without a mesh")
    if not outcome.error:
        outcome.mesh = case
    return outcome
