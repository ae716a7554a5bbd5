import subprocess
import numpy as np

# It keeps the input's triangles: a size of its own comes only inside, by volume.
volume = 2**3 / (6 * np.sqrt(2))
subprocess.run(["tetgen", f"-pqYa{volume}", "gear.off"], check=True, stdout=subprocess.DEVNULL)
points = np.loadtxt("gear.1.node", skiprows=1, comments="#")[:, 1:4]
tets = np.loadtxt("gear.1.ele", skiprows=1, comments="#", dtype=int)[:, 1:5]
print(len(points), len(tets))
