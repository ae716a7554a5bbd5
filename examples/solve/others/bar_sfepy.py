"""The bar with sfepy: bar_sfepy.py MESH ORDER STEEL ALLOY, numbers of regions. Sides by where they lie: sfepy takes cells alone."""
import sys

import numpy as np
from sfepy.base.base import output
from sfepy.discrete import Equation, Equations, FieldVariable, Integral, Material, Problem
from sfepy.discrete.conditions import Conditions, EssentialBC
from sfepy.discrete.fem import FEDomain, Field, Mesh
from sfepy.mechanics.matcoefs import stiffness_from_youngpoisson
from sfepy.solvers.ls import ScipyDirect
from sfepy.solvers.nls import Newton
from sfepy.terms import Term

output.set_output(quiet=True)
order, steel, alloy = (int(text) for text in sys.argv[2:5])
mesh = Mesh.from_file(sys.argv[1])
domain = FEDomain("bar", mesh)
everything = domain.create_region("all", "all")
blocks = {"steel": domain.create_region("steel", f"cells of group {steel}"), "alloy": domain.create_region("alloy", f"cells of group {alloy}")}
sides = {axis: domain.create_region("side" + axis, f"vertices in ({axis} < 1e-9)", "facet") for axis in "xyz"}
pulled = domain.create_region("pulled", "vertices in (x > 49.999999999)", "facet")
field = Field.from_args("displacement", np.float64, "vector", everything, approx_order=order)
u, v = FieldVariable("u", "unknown", field), FieldVariable("v", "test", field, primary_var_name="u")
integral = Integral("i", order=2 * order)
stiffness = {"steel": stiffness_from_youngpoisson(3, 200000.0, 0.3), "alloy": stiffness_from_youngpoisson(3, 50000.0, 0.075)}
terms = [Term.new("dw_lin_elastic(m.D, v, u)", integral, region, m=Material("m", D=stiffness[name]), v=v, u=u) for name, region in blocks.items()]
load = Term.new("dw_surface_ltr(load.pull, v)", integral, pulled, load=Material("load", pull=np.array([[100.0], [0], [0], [0], [0], [0]])), v=v)
problem = Problem("bar", equations=Equations([Equation("balance", terms[0] + terms[1] - load)]))
problem.set_bcs(ebcs=Conditions([EssentialBC(axis, sides[axis], {f"u.{i}": 0.0}) for i, axis in enumerate("xyz")]))
problem.set_solver(Newton({}, lin_solver=ScipyDirect({})))
moved = problem.solve(save_results=False)()
moved = moved.reshape(-1, 3)
places = field.get_coor()
x = places[:, 0]
wanted = np.column_stack([5e-4 * np.minimum(x, 30) + 2e-3 * np.maximum(x - 30, 0), -1.5e-4 * places[:, 1], -1.5e-4 * places[:, 2]])
print("found", mesh.n_el, repr(float(moved[x > 50 - 1e-9, 0].mean())), repr(float(abs(moved - wanted).max())))
