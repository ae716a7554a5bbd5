#!/usr/bin/python3
"""The bar of solve.py with other programs: others.py OCTAFRONT WORK [freefem] [getfem] [sfepy] [dealii] [fenicsx] [openfoam]

Two blocks, 30 and 20 mm, of different stiffness, pulled with 100 MPa, in one mesh with two regions. Each program reads the mesh
as octafront wrote it, materials and sides by the numbers of its groups, which the names in the MSH file stand for (sfepy and deal.II,
which refuse faces between regions: sides by where they lie). Its answer is piecewise linear, so elements of any order find it but for rounding. Run by /usr/bin/python3; Debian packages
freefem++, python3-getfem, python3-sfepy, libdeal.ii-dev, python3-dolfinx, openfoam; what is not there is skipped. OpenFOAM, which has
volumes instead of nodes, finds the temperature between the ends instead: 0 and 100 degrees, one material, in the middles of elements.
"""
import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import sys

import bodies

HERE = pathlib.Path(__file__).resolve().parent / "others"
ELONGATION, BOUND, BOUND_OF_VOLUMES = 0.055, 1e-9, 0.02  # sides that let nothing through have the value of the element beside them
YOUNG, POISSON = {"steel": 200000.0, "alloy": 50000.0}, {"steel": 0.3, "alloy": 0.075}
SIDES = {"fixed": "steel/fixed", "pulled": "alloy/pulled", "y1": "steel/plane_y", "y2": "alloy/plane_y", "z1": "steel/plane_z", "z2": "alloy/plane_z"}


def exact(x, y, z):
    return 5e-4 * min(x, 30.0) + 2e-3 * max(x - 30.0, 0.0), -1.5e-4 * y, -1.5e-4 * z


class Bar:
    def __init__(self, octafront, work):
        self.octafront, self.work = octafront, work
        sides = ["plane_y", "free", "plane_z", "free"]
        bodies.box((0, 0, 0), (30, 10, 10), ["fixed", "joint", *sides], (6, 3, 3)).write(work / "steel.obj")
        bodies.box((30, 0, 0), (50, 10, 10), ["joint", "pulled", *sides], (4, 4, 4)).write(work / "alloy.obj")

    def mesh(self, name, *options):
        target = self.work / name
        subprocess.run([self.octafront, "mesh", self.work / "steel.obj", self.work / "alloy.obj", "-o", target, "--size", "3", "-q", *options], check=True)
        return target

    def numbers(self):
        """Of the regions and sides, by name: as the MSH file says, whose numbers are those of all formats."""
        text = self.mesh("names.msh", "--ascii").read_text()
        named = {(int(d), name): int(n) for d, n, name in re.findall(r'^(\d) (\d+) "(.*)"$', text, re.M)}
        return {"steel": named[3, "steel"], "alloy": named[3, "alloy"], **{key: named[2, name] for key, name in SIDES.items()}}


def found_in(output):
    """Elements, elongation, worst error, of what a program prints."""
    cells, elongation, worst = re.findall(r"^found (\S+) (\S+) (\S+)$", output, re.M)[-1]
    return int(cells), float(elongation), float(worst)


def run(*command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{command[0]} failed:\n{done.stdout[-3000:]}{done.stderr[-3000:]}")
    return done.stdout


def freefem(bar, order):
    if not shutil.which("FreeFem++"):
        return None
    mesh = bar.mesh("freefem.mesh")
    given = [text for key, n in bar.numbers().items() if key != "alloy" for text in (f"-{key}", n)]
    return "MEDIT", found_in(run("FreeFem++", "-nw", "-v", "0", HERE / "bar.edp", "-mesh", mesh, "-order", order, *given))


def dealii(bar, order):
    build = bar.work / "dealii"
    if not any(pathlib.Path("/usr").glob("share/cmake/deal.II")) and not any(pathlib.Path("/usr/lib").glob("*/cmake/deal.II")):
        return None
    run("cmake", "-S", HERE, "-B", build, "-DCMAKE_BUILD_TYPE=Release")
    run("cmake", "--build", build)
    mesh = bar.mesh("dealii.msh", "--ascii", "--cells-only")
    return "MSH 4.1 as text, tetrahedra alone", found_in(run(build / "bar", mesh, order, bar.numbers()["steel"]))


def field_of_one(mesh, order):
    import getfem as gf

    field = gf.MeshFem(mesh, 1)
    field.set_classical_fem(order)
    return field


def getfem(bar, order):
    """Order 2: also the elements of the file are of second order."""
    if importlib.util.find_spec("getfem") is None:
        return None
    import getfem as gf
    import numpy as np

    gf.util_trace_level(0)
    gf.util_warning_level(0)
    mesh = gf.Mesh("import", "gmsh", str(bar.mesh("getfem.msh", "--ascii", "--order", str(order))))
    number = bar.numbers()
    # GetFEM adds to numbers that volumes and faces share, and keeps their order.
    volumes, faces = [], []
    for region in sorted(mesh.regions()):
        of = mesh.region(region)[1]
        (volumes if of.size and of.max() > 3 else faces).append(region)
    number = bar.numbers()
    regions = {key: (volumes if key in YOUNG else faces)[n - 1] for key, n in number.items()}
    field = gf.MeshFem(mesh, 3)
    field.set_classical_fem(order)
    integral = gf.MeshIm(mesh, 2 * order)
    model = gf.Model("real")
    model.add_fem_variable("u", field)
    for key in YOUNG:
        young, poisson = YOUNG[key], POISSON[key]
        model.add_initialized_data("lambda_" + key, young * poisson / ((1 + poisson) * (1 - 2 * poisson)))
        model.add_initialized_data("mu_" + key, young / (2 * (1 + poisson)))
        model.add_isotropic_linearized_elasticity_brick(integral, "u", "lambda_" + key, "mu_" + key, regions[key])
    model.add_initialized_data("pull", [100.0, 0.0, 0.0])
    model.add_source_term_brick(integral, "u", "pull", regions["pulled"])
    # Sides of one plane as one region: a node that both hold would be held twice.
    for keys in ("fixed",), ("y1", "y2"), ("z1", "z2"):
        plane = 1000 + ord(keys[0][0])
        mesh.set_region(plane, np.hstack([mesh.region(regions[key]) for key in keys]))
        model.add_normal_Dirichlet_condition_with_multipliers(integral, "u", field_of_one(mesh, order), plane)
    model.solve()
    moved = model.variable("u")
    places = field.basic_dof_nodes()
    wanted = np.array([exact(*places[:, i])[i % 3] for i in range(places.shape[1])])
    area = gf.asm_generic(integral, 0, "1", regions["pulled"])
    sum_of = gf.asm_generic(integral, 0, "u(1)", regions["pulled"], "u", False, field, moved)
    return "MSH 4.1 as text" + (", second order" if order == 2 else ""), (mesh.nbcvs(), float(sum_of / area), float(abs(moved - wanted).max()))


def sfepy(bar, order):
    if importlib.util.find_spec("sfepy") is None:
        return None
    mesh = bar.mesh("sfepy.mesh", "--cells-only")
    number = bar.numbers()
    return "MEDIT, tetrahedra alone", found_in(run(sys.executable, HERE / "bar_sfepy.py", mesh, order, number["steel"], number["alloy"]))


def fenicsx(bar, order):
    if importlib.util.find_spec("dolfinx") is None:
        return None
    mesh = bar.mesh("fenicsx.xdmf", "--order", str(order))
    return "XDMF" + (", second order" if order == 2 else ""), found_in(run(sys.executable, HERE / "bar_dolfinx.py", mesh, order))


FOAM = "FoamFile {{ version 2.0; format ascii; class {}; object {}; }}\n"
SCHEMES = ("ddtSchemes { default steadyState; } gradSchemes { default Gauss linear; } divSchemes { default none; } "
           "laplacianSchemes { default Gauss linear corrected; } interpolationSchemes { default linear; } snGradSchemes { default corrected; }")
SOLUTION = ("solvers { T { solver PCG; preconditioner DIC; tolerance 1e-14; relTol 0; } } SIMPLE { nNonOrthogonalCorrectors 60; }")
CONTROL = ("application laplacianFoam; startFrom startTime; startTime 0; stopAt endTime; endTime 1; deltaT 1; writeControl timeStep; writeInterval 1; "
           "writeFormat ascii; writePrecision 16;")


def foam_values(file):
    """Of a field in all elements: numbers, or rows of them."""
    inner = re.search(r"internalField.*?\n\d+\s*\(\n(.*?)\n\)", file.read_text(), re.S)[1]
    return [[float(x) for x in line.strip("()").split()] for line in inner.splitlines()]


def openfoam(bar, order):
    if order == 2 or not shutil.which("laplacianFoam"):
        return None
    if pathlib.Path("/usr/share/openfoam/etc/controlDict").exists():
        os.environ.setdefault("WM_PROJECT_DIR", "/usr/share/openfoam")
    case = bar.work / "foam"
    shutil.rmtree(case, ignore_errors=True)
    for folder in ("0", "constant", "system"):
        (case / folder).mkdir(parents=True)
    bar.mesh("foam/constant/polyMesh", "--format", "openfoam")
    for name, text in (("controlDict", CONTROL), ("fvSchemes", SCHEMES), ("fvSolution", SOLUTION)):
        (case / "system" / name).write_text(FOAM.format("dictionary", name) + text)
    (case / "constant/transportProperties").write_text(FOAM.format("dictionary", "transportProperties") + "DT [0 2 -1 0 0 0 0] 1;")
    ends = "".join(f'{SIDES[key].replace("/", "_")} {{ type fixedValue; value uniform {value}; }} ' for key, value in (("fixed", 0), ("pulled", 100)))
    (case / "0/T").write_text(FOAM.format("volScalarField", "T") + "dimensions [0 0 0 1 0 0 0]; internalField uniform 50; boundaryField { "
                              f'".*" {{ type zeroGradient; }} {ends} }}')
    run("laplacianFoam", "-case", case)
    run("postProcess", "-case", case, "-func", "writeCellCentres", "-time", "1")
    temperature, middle = foam_values(case / "1/T"), foam_values(case / "1/C")
    worst = max(abs(t - 2 * x) for (t,), (x, _, _) in zip(temperature, middle))
    return "polyMesh", (len(temperature), None, worst / 100)


def main():
    octafront, work = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve() / "others"
    work.mkdir(parents=True, exist_ok=True)
    bar, good, any_ran = Bar(octafront, work), True, False
    for program in (freefem, getfem, sfepy, dealii, fenicsx, openfoam):
        if len(sys.argv) > 3 and program.__name__ not in sys.argv[3:]:
            continue
        for order in (1, 2):
            answer = program(bar, order)
            if answer is None and any_ran and order == 2:
                break
            if answer is None:
                print(f"{program.__name__}: not here, skipped")
                break
            file, (cells, elongation, worst) = answer
            if elongation is None:
                good, any_ran = good and worst <= BOUND_OF_VOLUMES, True
                print(f"{program.__name__}: {file}; {cells:,} elements; worst element's temperature wrong by {worst:.2%} of the whole" + ("" if worst <= BOUND_OF_VOLUMES else f": BEYOND {BOUND_OF_VOLUMES:g}"))
                continue
            fits = abs(elongation / ELONGATION - 1) <= BOUND and worst / ELONGATION <= BOUND
            good, any_ran = good and fits, True
            print(f"{program.__name__}, order {order}: {file}; {cells:,} elements; elongation {elongation:.9f} mm; worst node {worst / ELONGATION:.1e}" + ("" if fits else f": BEYOND {BOUND:g}"))
    sys.exit(0 if good and any_ran else 77 if not any_ran else 1)


if __name__ == "__main__":
    main()
