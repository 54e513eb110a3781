"""Union of components by Manifold: manifold_union.py MESH RESULT, both OFF.

It takes no mesh that crosses itself apart: the connected components are united, and what crosses itself within one stays.
Prints the seconds of CPU and of wall time of it alone, and the KiB that the process held before.
"""
import sys

import manifold3d
import numpy
from common import Clock, read_off, write_off


def main():
    positions, triangles = read_off(sys.argv[1])
    mesh = manifold3d.Mesh64(positions, triangles.astype(numpy.uint64))
    clock = Clock()
    parts = manifold3d.Manifold(mesh).decompose()
    result = manifold3d.Manifold.batch_boolean(parts, manifold3d.OpType.Add)
    status = result.status()
    made = result.to_mesh64()
    clock.stop()
    if status != manifold3d.Error.NoError:
        sys.exit(f"{status}")
    # Vertices that differ by properties alone are named as one.
    name = numpy.arange(len(made.vert_properties))
    name[numpy.asarray(made.merge_from_vert, dtype=numpy.int64)] = made.merge_to_vert
    write_off(sys.argv[2], made.vert_properties[:, :3], name[numpy.asarray(made.tri_verts, dtype=numpy.int64)])
    clock.show()


if __name__ == "__main__":
    main()
