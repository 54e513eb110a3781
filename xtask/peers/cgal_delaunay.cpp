// Times CGAL's Delaunay_triangulation_3 on points given as little-endian doubles, and dumps the set of
// tetrahedra: cgal_delaunay POINTS [DUMP]. For comparison only: CGAL's triangulations are GPL, and nothing
// here is linked into Pellicle.
//
// Prints seconds, points and finite cells, as `time_delaunay` does; both count sorting and insertion.
// With DUMP, vertices carry their index, which costs some time, so no time is printed.
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Plain = CGAL::Delaunay_triangulation_3<Kernel>;
using IndexedVertex = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
using IndexedData = CGAL::Triangulation_data_structure_3<
    IndexedVertex, CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
using Indexed = CGAL::Delaunay_triangulation_3<Kernel, IndexedData>;

static void dump(const std::vector<Point>& points, const char* file) {
    std::vector<std::pair<Point, std::uint32_t>> indexed;
    for (std::uint32_t i = 0; i < points.size(); ++i) indexed.emplace_back(points[i], i);
    Indexed triangulation(indexed.begin(), indexed.end());
    std::vector<std::array<std::uint32_t, 4>> cells;
    for (auto cell : triangulation.finite_cell_handles()) {
        std::array<std::uint32_t, 4> corners;
        for (int i = 0; i < 4; ++i) corners[i] = cell->vertex(i)->info();
        std::sort(corners.begin(), corners.end());
        cells.push_back(corners);
    }
    std::sort(cells.begin(), cells.end());
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(cells.data()), cells.size() * sizeof(cells[0]));
    std::printf("- %zu %zu\n", points.size(), cells.size());
}

int main(int argc, char** argv) {
    if (argc < 2) return 2;
    std::ifstream in(argv[1], std::ios::binary);
    std::vector<Point> points;
    double p[3];
    while (in.read(reinterpret_cast<char*>(p), sizeof p)) points.emplace_back(p[0], p[1], p[2]);
    if (argc > 2) {
        dump(points, argv[2]);
        return 0;
    }
    auto start = std::chrono::steady_clock::now();
    Plain triangulation(points.begin(), points.end());
    std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    std::printf("%.3f %zu %zu\n", seconds.count(), points.size(),
                static_cast<std::size_t>(triangulation.number_of_finite_cells()));
}
