import octafront
from model import points, triangles

octafront.mesh(points, triangles[3:], size=0.2, repair="none")  # three triangles are missing
