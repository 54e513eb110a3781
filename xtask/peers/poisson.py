"""Screened Poisson reconstruction by Open3D: poisson.py DEPTH POINTS MESH [POINTS MESH ...].

POINTS are text, three numbers a line; MESH is written as PLY. Normals are estimated from 30 neighbours and oriented
along a minimum spanning tree over 30; nothing is cropped. Prints the seconds of normals and reconstruction, a line a
cloud.
"""
import sys
import time

import numpy
import open3d

NEIGHBORS = 30


def reconstruct(points, depth):
    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
    cloud.estimate_normals(open3d.geometry.KDTreeSearchParamKNN(NEIGHBORS))
    cloud.orient_normals_consistent_tangent_plane(NEIGHBORS)
    mesh, _ = open3d.geometry.TriangleMesh.create_from_point_cloud_poisson(
        cloud, depth=depth, n_threads=1
    )
    return mesh


def main():
    depth, files = int(sys.argv[1]), sys.argv[2:]
    for points_file, mesh_file in zip(files[::2], files[1::2]):
        points = numpy.loadtxt(points_file)[:, :3]
        start = time.perf_counter()
        mesh = reconstruct(points, depth)
        print(f"{time.perf_counter() - start:.3f}", flush=True)
        open3d.io.write_triangle_mesh(mesh_file, mesh)


if __name__ == "__main__":
    main()
