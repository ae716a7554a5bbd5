#!/usr/bin/python3
"""What DOLFINx makes of a mesh file, as JSON (the keys of mfem_judge.cpp): elements and facets by tag, volumes and areas by its own
quadrature, the least determinant of the Jacobian at the points of a degree.

    dolfinx_judge.py NAME.xdmf      # with NAME_patches.xdmf beside
    dolfinx_judge.py NAME.msh       # by gmshio, from Gmsh's model
"""
import contextlib
import json
import logging
import os
import sys

import numpy as np
import ufl
from dolfinx import fem
from dolfinx.io import XDMFFile, gmshio
from mpi4py import MPI


def read(file):
    if file.endswith(".msh"):
        import gmsh
        gmsh.initialize()
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(file)
        return gmshio.model_to_mesh(gmsh.model, MPI.COMM_SELF, 0, 3)
    with XDMFFile(MPI.COMM_SELF, file, "r") as source:
        mesh = source.read_mesh(name="mesh")
        cells = source.read_meshtags(mesh, name="mesh")
    mesh.topology.create_connectivity(2, 3)
    with XDMFFile(MPI.COMM_SELF, file.replace(".xdmf", "_patches.xdmf"), "r") as source:
        return mesh, cells, source.read_meshtags(mesh, name="patches")


def by_tag(tags, measure):
    return {str(tag): {"size": int((tags.values == tag).sum()), "measure": measure(int(tag))} for tag in np.unique(tags.values)}


def judged(file):
    mesh, cells, facets = read(file)
    mesh.topology.create_connectivity(2, 3)
    one = fem.Constant(mesh, np.float64(1))
    integral = lambda form: fem.assemble_scalar(fem.form(form))
    dx = ufl.Measure("dx", domain=mesh, subdomain_data=cells, metadata={"quadrature_degree": 12})
    ds, inside = (ufl.Measure(kind, domain=mesh, subdomain_data=facets, metadata={"quadrature_degree": 20}) for kind in ("ds", "dS"))
    space = fem.FunctionSpace(mesh, ("DG", 4))
    jacobian = fem.Function(space)
    jacobian.interpolate(fem.Expression(ufl.JacobianDeterminant(mesh), space.element.interpolation_points()))
    return {"order": int(mesh.ufl_domain().ufl_coordinate_element().degree()), "nodes": int(mesh.geometry.index_map().size_global),
            "elements": int(mesh.topology.index_map(3).size_global), "boundary": len(facets.values), "volume": integral(one * dx),
            "least_jacobian": float(jacobian.x.array.min()),
            "regions": by_tag(cells, lambda tag: integral(one * dx(tag))),
            "patches": by_tag(facets, lambda tag: integral(one * ds(tag)) + integral(one("+") * inside(tag)))}


if __name__ == "__main__":
    logging.disable(logging.WARNING)
    with contextlib.redirect_stdout(open(os.devnull, "w")):
        found = judged(sys.argv[1])
    print(json.dumps(found))
