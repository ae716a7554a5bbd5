import subprocess
import numpy as np
from model import points, triangles

def write(name, header, rows):
    with open(name, "w") as file:
        print(*header, file=file)
        for i, row in enumerate(rows):
            print(*row(i), file=file)

# Sizes stand at the nodes of a background mesh; here at those of the surface, filled coarsely first.
write("sphere.node", (len(points), 3, 0, 0), [lambda i: (i, *points[i])] * len(points))
with open("sphere.poly", "w") as file:
    print("0 3 0 0\n", len(triangles), 0, file=file)
    for t in triangles:
        print("1\n3", *t, file=file)
    print("0\n0", file=file)
subprocess.run(["tetgen", "-p", "sphere.poly"], check=True, stdout=subprocess.DEVNULL)
background = np.loadtxt("sphere.1.node", skiprows=1, comments="#")[:, 1:4]
size = 0.05 + 0.2 * np.linalg.norm(background - [1, 0, 0], axis=1)
np.savetxt("sphere.1.mtr", size, header=f"{len(size)} 1", comments="")
subprocess.run(["tetgen", "-rqm", "sphere.1"], check=True, stdout=subprocess.DEVNULL)
nodes = np.loadtxt("sphere.2.node", skiprows=1, comments="#")[:, 1:4]
tets = np.loadtxt("sphere.2.ele", skiprows=1, comments="#", dtype=int)[:, 1:5]
print(nodes.shape, tets.shape)
