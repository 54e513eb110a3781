"""Times HXT, as gmsh calls it, on points given as little-endian doubles: hxt_delaunay.py POINTS THREADS.

Prints what `time_delaunay` prints, but for the memory: most of the process's is gmsh's own objects. The seconds are those
of gmsh's log: the tetrahedralisation, and the making of one gmsh object a tetrahedron, which gmsh cannot leave out.
`hxt_delaunay.py --version` prints gmsh's.
"""
import re
import sys

import gmsh
import numpy

if sys.argv[1] == "--version":
    print(gmsh.__version__)
    sys.exit()
points = numpy.fromfile(sys.argv[1], dtype="<f8")
gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
gmsh.option.setNumber("General.NumThreads", int(sys.argv[2]))
gmsh.option.setNumber("Mesh.Algorithm3D", 10)  # HXT
gmsh.logger.start()
tetrahedra, _ = gmsh.algorithm.tetrahedralize(points)
log = "\n".join(gmsh.logger.get())
wall, cpu = re.search(r"Done tetrahedrizing.*\(Wall ([-+.e\d]+)s, CPU ([-+.e\d]+)s\)", log).groups()
if len(tetrahedra) == 0:
    sys.exit(f"no tetrahedra: {log}")
print(f"cpu={cpu} wall={wall} points={len(points) // 3} tetrahedra={len(tetrahedra) // 4}")
