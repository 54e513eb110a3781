"""Times TetGen on points given as little-endian doubles: tetgen_delaunay.py POINTS.

PyPI's wheel if it is there, else the program that Debian's package installs. Prints what `time_delaunay` prints, but for the
memory before the call. The seconds of the processor are those that TetGen itself prints for the tetrahedralisation.
`tetgen_delaunay.py --version` prints which TetGen it is.
"""
import array
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

try:
    import numpy
    from tetgen import _tetgen as wheel
except ImportError:
    wheel = None


def by_wheel(path):
    """What TetGen prints, and how many tetrahedra there are."""
    points = numpy.fromfile(path, dtype="<f8").reshape(-1, 3)
    tetgen = wheel.PyTetgen()
    tetgen.load_mesh(points, numpy.zeros((0, 3), dtype=numpy.int32))
    with tempfile.TemporaryFile() as file:
        shown = os.dup(1)
        os.dup2(file.fileno(), 1)  # TetGen prints from C
        start = time.perf_counter()
        tetgen.tetrahedralize(plc=0, quality=0, quiet=0, facesout=0)
        wall = time.perf_counter() - start
        os.dup2(shown, 1)
        file.seek(0)
        return file.read().decode(), tetgen.n_cells, wall


def by_program(path):
    """The same, by a file of text."""
    points = array.array("d")
    with open(path, "rb") as file:
        points.frombytes(file.read())
    count = len(points) // 3
    with tempfile.TemporaryDirectory() as folder:
        nodes = os.path.join(folder, "points.node")
        with open(nodes, "w") as file:
            file.write(f"{count} 3 0 0\n")
            file.writelines(
                f"{i} {points[3 * i]!r} {points[3 * i + 1]!r} {points[3 * i + 2]!r}\n" for i in range(count)
            )
        start = time.perf_counter()
        run = subprocess.run(["tetgen", "-NEF", nodes], capture_output=True, text=True, check=True)
        wall = time.perf_counter() - start
    found = re.search(r"Mesh tetrahedra: (\d+)", run.stdout)
    return run.stdout, int(found.group(1)), wall


if wheel is None and shutil.which("tetgen") is None:
    sys.exit("no TetGen: neither PyPI's wheel nor Debian's program")
if sys.argv[1] == "--version":
    if wheel is None:
        print(subprocess.run(["dpkg-query", "-W", "-f", "${Version}", "tetgen"], capture_output=True, text=True).stdout)
    else:
        import importlib.metadata

        print("wheel", importlib.metadata.version("tetgen"))
    sys.exit()
text, tetrahedra, wall = (by_program if wheel is None else by_wheel)(sys.argv[1])
cpu = re.search(r"Delaunay seconds:\s*([-+.e\d]+)", text).group(1)
size = os.path.getsize(sys.argv[1]) // 24
print(f"cpu={cpu} wall={wall:.4f} points={size} tetrahedra={tetrahedra}")
