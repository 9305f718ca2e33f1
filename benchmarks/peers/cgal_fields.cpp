// CGAL's point location and natural neighbours: `cgal_fields RUNS SITES QUERIES`, files of pairs of
// doubles. Queries are sorted along CGAL's own curve first, and each starts from the face of the one
// before, as its manual recommends; the sort is timed with them.
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/natural_neighbor_coordinates_2.h>
#include <CGAL/spatial_sort.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;
using Triangulation = CGAL::Delaunay_triangulation_2<Kernel>;

static std::vector<double> read(const char* file) {
    std::ifstream input(file, std::ios::binary | std::ios::ate);
    std::vector<double> numbers(input.tellg() / sizeof(double));
    input.seekg(0);
    input.read(reinterpret_cast<char*>(numbers.data()), numbers.size() * sizeof(double));
    return numbers;
}

template <typename Work>
static void report(const char* name, int runs, Work work) {
    for (int run = 0; run < runs; ++run) {
        const auto start = std::chrono::steady_clock::now();
        const double sum = work();
        const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
        std::printf("%s\t%.9f\t%.9g\n", name, time.count(), sum);
    }
}

int main(int count, char** arguments) {
    if (count != 4) {
        std::fputs("usage: cgal_fields RUNS SITES QUERIES\n", stderr);
        return 2;
    }
    const int runs = std::atoi(arguments[1]);
    const std::vector<double> sites = read(arguments[2]), numbers = read(arguments[3]);
    std::vector<Point> points, queries;
    for (std::size_t i = 0; i + 1 < sites.size(); i += 2) {
        points.emplace_back(sites[i], sites[i + 1]);
    }
    for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
        queries.emplace_back(numbers[i], numbers[i + 1]);
    }
    Triangulation mesh(points.begin(), points.end());
    report("locate", runs, [&] {
        std::vector<Point> order = queries;
        CGAL::spatial_sort(order.begin(), order.end());
        Triangulation::Face_handle face;
        std::size_t inside = 0;
        for (const Point& query : order) {
            face = mesh.locate(query, face);
            inside += !mesh.is_infinite(face);
        }
        return double(inside);
    });
    // Coordinates alone: how values are looked up is the caller's affair.
    report("sibson", runs, [&] {
        std::vector<Point> order = queries;
        CGAL::spatial_sort(order.begin(), order.end());
        Triangulation::Face_handle face;
        std::vector<std::pair<Point, double>> weights;
        double sum = 0;
        for (const Point& query : order) {
            face = mesh.locate(query, face);
            weights.clear();
            const auto found = CGAL::natural_neighbor_coordinates_2(
                mesh, query, std::back_inserter(weights), face);
            sum += found.third ? found.second : 0;
        }
        return sum;
    });
    return 0;
}
