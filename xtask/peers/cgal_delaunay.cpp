// Times CGAL's Delaunay_triangulation_3 on points given as little-endian doubles, or dumps the set of
// tetrahedra: cgal_delaunay POINTS [DUMP]. With weights, one double each, Regular_triangulation_3:
// cgal_delaunay --weights WEIGHTS POINTS [DUMP]. For comparison only: CGAL's triangulations are GPL, and
// nothing here is linked into Pellicle.
//
// Prints what `time_delaunay` prints: seconds of the processor and of the wall, which count sorting and
// insertion, points, finite cells, bytes held before and at the peak. With DUMP, vertices carry their index,
// which costs some time, so nothing is measured. `cgal_delaunay --version` prints CGAL's.
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <CGAL/version.h>
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Plain = CGAL::Delaunay_triangulation_3<Kernel>;
using IndexedVertex = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
using IndexedData = CGAL::Triangulation_data_structure_3<
    IndexedVertex, CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
using Indexed = CGAL::Delaunay_triangulation_3<Kernel, IndexedData>;

using WeightedPoint = Kernel::Weighted_point_3;
using Regular = CGAL::Regular_triangulation_3<Kernel>;
using IndexedRegularVertex = CGAL::Triangulation_vertex_base_with_info_3<
    std::uint32_t, Kernel, CGAL::Regular_triangulation_vertex_base_3<Kernel>>;
using IndexedRegularData = CGAL::Triangulation_data_structure_3<
    IndexedRegularVertex, CGAL::Regular_triangulation_cell_base_3<Kernel>>;
using IndexedRegular = CGAL::Regular_triangulation_3<Kernel, IndexedRegularData>;

template <class Indexed, class Point>
static void dump(const std::vector<Point>& points, const char* file) {
    std::vector<std::pair<Point, std::uint32_t>> indexed;
    for (std::uint32_t i = 0; i < points.size(); ++i) indexed.emplace_back(points[i], i);
    Indexed triangulation(indexed.begin(), indexed.end());
    std::ofstream out(file, std::ios::binary);
    for (auto cell : triangulation.finite_cell_handles()) {
        std::array<std::uint32_t, 4> corners;
        for (int i = 0; i < 4; ++i) corners[i] = cell->vertex(i)->info();
        out.write(reinterpret_cast<const char*>(corners.data()), sizeof corners);
    }
}

// A line of Linux's account of the process, in bytes.
static long long memory(const std::string& name) {
    std::ifstream status("/proc/self/status");
    std::string line;
    while (std::getline(status, line))
        if (line.rfind(name + ":", 0) == 0) return std::stoll(line.substr(name.size() + 1)) * 1024;
    return 0;
}

static double processor() {
    timespec spent;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &spent);
    return spent.tv_sec + 1e-9 * spent.tv_nsec;
}

template <class Plain, class Indexed, class Point>
static int run(const std::vector<Point>& points, const char* file) {
    if (file) {
        dump<Indexed>(points, file);
        return 0;
    }
    const long long held = memory("VmRSS");
    const auto wall = std::chrono::steady_clock::now();
    const double cpu = processor();
    Plain triangulation(points.begin(), points.end());
    const double cpu_seconds = processor() - cpu;
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - wall;
    std::printf("cpu=%.4f wall=%.4f points=%zu tetrahedra=%zu held=%lld peak=%lld\n", cpu_seconds,
                seconds.count(), points.size(),
                static_cast<std::size_t>(triangulation.number_of_finite_cells()), held, memory("VmHWM"));
    return 0;
}

// A file's points, each from so many doubles.
static std::size_t count(std::ifstream& in, std::size_t doubles) {
    const auto bytes = static_cast<std::size_t>(in.tellg());
    in.seekg(0);
    return bytes / (doubles * sizeof(double));
}

int main(int argc, char** argv) {
    if (argc < 2) return 2;
    if (std::strcmp(argv[1], "--version") == 0) {
        std::puts(CGAL_VERSION_STR);
        return 0;
    }
    const char* weights = nullptr;
    if (std::strcmp(argv[1], "--weights") == 0) {
        if (argc < 4) return 2;
        weights = argv[2];
        argc -= 2;
        argv += 2;
    }
    std::ifstream in(argv[1], std::ios::binary | std::ios::ate);
    const std::size_t points = count(in, 3);
    const char* file = argc > 2 ? argv[2] : nullptr;
    double p[3];
    if (!weights) {
        std::vector<Point> plain;
        plain.reserve(points);
        while (in.read(reinterpret_cast<char*>(p), sizeof p)) plain.emplace_back(p[0], p[1], p[2]);
        return run<Plain, Indexed>(plain, file);
    }
    std::ifstream of_points(weights, std::ios::binary | std::ios::ate);
    if (count(of_points, 1) != points) return 2;
    std::vector<WeightedPoint> weighted;
    weighted.reserve(points);
    double w;
    while (in.read(reinterpret_cast<char*>(p), sizeof p) && of_points.read(reinterpret_cast<char*>(&w), sizeof w))
        weighted.emplace_back(Point(p[0], p[1], p[2]), w);
    return run<Regular, IndexedRegular>(weighted, file);
}
