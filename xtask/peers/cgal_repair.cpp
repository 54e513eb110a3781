// Self-intersections by CGAL: cgal_repair detect MESH, or cgal_repair autorefine MESH RESULT, with OFF files. For
// comparison only: Polygon_mesh_processing is GPL, and nothing here is linked into Pellicle.
//
// `detect` finds the pairs of triangles that intersect; `autorefine` is experimental::autorefine_and_remove_self_intersections.
// Prints the seconds of CPU and of wall time of that alone, the KiB that the process held before, and the pairs, or
// whether all were removed.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/IO/OFF.h>
#include <sys/resource.h>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <iterator>
#include <utility>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
namespace PMP = CGAL::Polygon_mesh_processing;

int main(int argc, char** argv) {
    if (argc < 3) return 2;
    const bool detect = !std::strcmp(argv[1], "detect");
    Mesh mesh;
    if (!CGAL::IO::read_OFF(argv[2], mesh)) return 3;
    rusage held;
    getrusage(RUSAGE_SELF, &held);
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t cpu_start = std::clock();
    long outcome;
    if (detect) {
        std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> pairs;
        PMP::self_intersections<CGAL::Sequential_tag>(mesh, std::back_inserter(pairs));
        outcome = pairs.size();
    } else {
        outcome = PMP::experimental::autorefine_and_remove_self_intersections(mesh);
    }
    const double cpu = double(std::clock() - cpu_start) / CLOCKS_PER_SEC;
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    if (!detect) {
        mesh.collect_garbage();
        if (!CGAL::IO::write_OFF(argv[3], mesh, CGAL::parameters::stream_precision(17))) return 4;
    }
    std::printf("%.4f %.4f %ld %ld\n", cpu, wall.count(), held.ru_maxrss, outcome);
}
