// Wraps points by CGAL's alpha_wrap_3: cgal_alpha_wrap POINTS MESH ALPHA OFFSET, with POINTS as text, three
// numbers a line, MESH as OFF, and ALPHA and OFFSET as parts of the diagonal: 100 is a hundredth. For
// comparison only: alpha_wrap_3 is GPL, and nothing here is linked into Pellicle.
//
// Prints the seconds of wrapping alone.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/OFF.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>
#include <CGAL/bounding_box.h>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;

int main(int argc, char** argv) {
    if (argc < 5) return 2;
    std::ifstream in(argv[1]);
    std::vector<Point> points;
    double x, y, z;
    while (in >> x >> y >> z) points.emplace_back(x, y, z);
    if (points.empty()) return 3;
    const auto box = CGAL::bounding_box(points.begin(), points.end());
    const double diagonal = std::sqrt(CGAL::squared_distance((box.min)(), (box.max)()));
    const double alpha = diagonal / std::atof(argv[3]), offset = diagonal / std::atof(argv[4]);
    Mesh mesh;
    const auto start = std::chrono::steady_clock::now();
    CGAL::alpha_wrap_3(points, alpha, offset, mesh);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    if (!CGAL::IO::write_OFF(argv[2], mesh, CGAL::parameters::stream_precision(17))) return 4;
    std::printf("%.3f\n", seconds.count());
}
