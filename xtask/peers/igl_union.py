"""Self-union by libigl: igl_union.py MESH RESULT, both OFF.

`mesh_boolean` of the mesh and of nothing keeps what has winding number 1 or more, by CGAL's exact arithmetic. Prints the
seconds of CPU and of wall time of it alone, and the KiB that the process held before.
"""
import sys

import igl.copyleft.cgal
import numpy
from common import Clock, read_off, write_off


def main():
    positions, triangles = read_off(sys.argv[1])
    nothing = numpy.zeros((0, 3)), numpy.zeros((0, 3), dtype=numpy.int64)
    clock = Clock()
    positions, triangles, _ = igl.copyleft.cgal.mesh_boolean(positions, triangles, *nothing, "union")
    clock.stop()
    write_off(sys.argv[2], positions, triangles)
    clock.show()


if __name__ == "__main__":
    main()
