"""What the drivers share: OFF files of triangles, and the time and memory of the work alone."""
import resource
import time

import numpy


def read_off(path):
    with open(path) as file:
        words = file.read().split()
    vertices, triangles = int(words[1]), int(words[2])
    end = 4 + 3 * vertices
    positions = numpy.array(words[4:end], dtype=float).reshape(vertices, 3)
    corners = numpy.array(words[end : end + 4 * triangles], dtype=numpy.int64).reshape(triangles, 4)
    return positions, numpy.ascontiguousarray(corners[:, 1:])


def write_off(path, positions, triangles):
    with open(path, "w") as file:
        file.write(f"OFF\n{len(positions)} {len(triangles)} 0\n")
        file.writelines(f"{x!r} {y!r} {z!r}\n" for x, y, z in positions.tolist())
        file.writelines(f"3 {a} {b} {c}\n" for a, b, c in triangles.tolist())


class Clock:
    def __init__(self):
        self.held = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        self.wall, self.cpu = time.perf_counter(), time.process_time()

    def stop(self):
        self.wall, self.cpu = time.perf_counter() - self.wall, time.process_time() - self.cpu

    def show(self):
        print(f"{self.cpu:.4f} {self.wall:.4f} {self.held}")
