// CGAL's triangulations that change: `cgal_live PLANE|SPACE FILE N M`, where the file has N points to
// start from and M more. Prints the name of each edit, processor seconds, and how many points it edits. Points
// are removed and moved in the order of the file, and also along a Hilbert curve.
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/spatial_sort.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Plane = CGAL::Delaunay_triangulation_2<Kernel>;
using Space = CGAL::Delaunay_triangulation_3<Kernel>;

template <class Work>
void timed(const char* name, std::size_t count, Work work) {
    const auto start = std::clock();
    work();
    std::printf("%s\t%.9f\t%zu\n", name, double(std::clock() - start) / CLOCKS_PER_SEC, count);
    std::fflush(stdout);
}

Kernel::Point_2 at(const double* x, Plane*) { return {x[0], x[1]}; }
Kernel::Point_3 at(const double* x, Space*) { return {x[0], x[1], x[2]}; }

template <class Triangulation>
std::vector<typename Triangulation::Point> read(const char* file, int ndim) {
    std::ifstream input(file, std::ios::binary | std::ios::ate);
    std::vector<double> numbers(std::size_t(input.tellg()) / sizeof(double));
    input.seekg(0);
    input.read(reinterpret_cast<char*>(numbers.data()), std::streamsize(numbers.size() * sizeof(double)));
    std::vector<typename Triangulation::Point> points;
    for (std::size_t i = 0; i + ndim <= numbers.size(); i += ndim) {
        points.push_back(at(&numbers[i], static_cast<Triangulation*>(nullptr)));
    }
    return points;
}

Kernel::Vector_2 step(std::size_t i, double by, Plane*) { return {by * std::cos(double(i)), by * std::sin(double(i))}; }
Kernel::Vector_3 step(std::size_t i, double by, Space*) {
    return {by * std::cos(double(i)), by * std::sin(double(i)) * 0.6, by * std::sin(double(i)) * 0.8};
}

template <class Triangulation>
void run(const char* file, std::size_t n, std::size_t m, int ndim) {
    using Vertex = typename Triangulation::Vertex_handle;
    using Point = typename Triangulation::Point;
    const std::vector<Point> all = read<Triangulation>(file, ndim);
    const std::vector<Point> first(all.begin(), all.begin() + n), more(all.begin() + n, all.begin() + n + m);
    Triangulation mesh;
    timed("build", n, [&] { mesh.insert(first.begin(), first.end()); });
    timed("insert a batch", m, [&] { mesh.insert(more.begin(), more.end()); });
    // Vertices in an order as good as random, and the same ones along a curve.
    const auto vertices = [&](std::size_t from, bool sorted) {
        std::vector<Point> wanted;
        const std::size_t stride = n / m;
        for (std::size_t i = 0; i < m; ++i) {
            wanted.push_back(all[i * stride + from]);
        }
        if (sorted) {
            CGAL::spatial_sort(wanted.begin(), wanted.end());
        }
        std::vector<Vertex> found;
        for (const Point& p : wanted) {
            found.push_back(mesh.nearest_vertex(p));
        }
        return found;
    };
    const double spacing = std::pow(double(n), -1.0 / ndim);
    {
        auto some = vertices(0, false);
        some.resize(m / 2);
        timed("remove a batch, unsorted", some.size(), [&] {
            for (Vertex v : some) mesh.remove(v);
        });
    }
    {
        auto some = vertices(1, true);
        timed("remove a batch", some.size(), [&] {
            for (Vertex v : some) mesh.remove(v);
        });
    }
    {
        const auto some = vertices(2, true);
        timed("move a batch by a tenth", some.size(), [&] {
            for (std::size_t i = 0; i < some.size(); ++i) {
                mesh.move(some[i], some[i]->point() + step(i, 0.1 * spacing, static_cast<Triangulation*>(nullptr)));
            }
        });
    }
    timed("insert one by one, anywhere", m / 100, [&] {
        for (std::size_t i = 0; i < m / 100; ++i) {
            mesh.insert(more[i] + step(i, 0.3 * spacing, static_cast<Triangulation*>(nullptr)));
        }
    });
}

int main(int count, char** arguments) {
    if (count != 5) {
        std::fputs("usage: cgal_live PLANE|SPACE FILE N M\n", stderr);
        return 2;
    }
    const std::size_t n = std::strtoul(arguments[3], nullptr, 10), m = std::strtoul(arguments[4], nullptr, 10);
    if (std::strcmp(arguments[1], "SPACE") == 0) {
        run<Space>(arguments[2], n, m, 3);
    } else {
        run<Plane>(arguments[2], n, m, 2);
    }
    return 0;
}
