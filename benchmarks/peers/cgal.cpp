// CGAL's Delaunay triangulation on one file of points: `cgal RUNS FILE`, with the input, the timing
// and the output of the Rust program beside it. Range insertion with exact predicates and inexact
// constructions, the kernel that its manual recommends; built where Debian's libcgal-dev is.
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangulation = CGAL::Delaunay_triangulation_2<Kernel>;

int main(int count, char** arguments) {
    if (count != 3) {
        std::fputs("usage: cgal RUNS FILE\n", stderr);
        return 2;
    }
    const std::string file = arguments[2];
    std::ifstream input(file, std::ios::binary | std::ios::ate);
    std::vector<double> numbers(input.tellg() / sizeof(double));
    input.seekg(0);
    input.read(reinterpret_cast<char*>(numbers.data()), numbers.size() * sizeof(double));
    std::vector<Kernel::Point_2> points;
    for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
        points.emplace_back(numbers[i], numbers[i + 1]);
    }
    for (int run = 0; run < std::atoi(arguments[1]); ++run) {
        const auto start = std::chrono::steady_clock::now();
        Triangulation answer;
        answer.insert(points.begin(), points.end());
        const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
        std::printf("CGAL\t%.9f\t%zu\n", time.count(), answer.number_of_faces());
        if (run == 0) {
            std::ofstream output(file + ".CGAL", std::ios::binary);
            for (auto f = answer.finite_faces_begin(); f != answer.finite_faces_end(); ++f) {
                for (int k = 0; k < 3; ++k) {
                    const double xy[2] = {f->vertex(k)->point().x(), f->vertex(k)->point().y()};
                    output.write(reinterpret_cast<const char*>(xy), sizeof xy);
                }
            }
        }
    }
    return 0;
}
