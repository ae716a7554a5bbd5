import subprocess
from model import points, triangles

triangles = triangles[3:]  # three triangles are missing
with open("open.off", "w") as file:
    print("OFF\n", len(points), len(triangles), 0, file=file)
    for p in points:
        print(*p, file=file)
    for t in triangles:
        print(3, *t, file=file)
subprocess.run(["tetgen", "-pqa0.001", "open.off"], check=True)
