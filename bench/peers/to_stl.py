"""OFF to binary STL, and to OFF of triangles, for programs that read nothing else: to_stl.py IN.off OUT.stl OUT.off"""
import sys

from bench.off import read_off, write_off
from bench.peers.surfaces import write_stl

points, triangles = read_off(sys.argv[1])
write_stl(sys.argv[2], points, triangles)
write_off(sys.argv[3], points, triangles)
