// CGAL's Delaunay triangulation in space on one file of points: `cgal_space RUNS FILE`, timed to the
// handles of its triangulation; arrays would come on top. Range insertion, which sorts along a Hilbert
// curve, with exact predicates and inexact constructions, the kernel that its manual recommends.
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangulation = CGAL::Delaunay_triangulation_3<Kernel>;

int main(int count, char** arguments) {
    if (count != 3) {
        std::fputs("usage: cgal_space RUNS FILE\n", stderr);
        return 2;
    }
    const std::string file = arguments[2];
    std::ifstream input(file, std::ios::binary | std::ios::ate);
    std::vector<double> numbers(input.tellg() / sizeof(double));
    input.seekg(0);
    input.read(reinterpret_cast<char*>(numbers.data()), numbers.size() * sizeof(double));
    std::vector<Kernel::Point_3> points;
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
        points.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
    }
    for (int run = 0; run < std::atoi(arguments[1]); ++run) {
        const auto start = std::chrono::steady_clock::now();
        const auto start_of_process = std::clock();
        Triangulation answer;
        answer.insert(points.begin(), points.end());
        const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
        const double process = double(std::clock() - start_of_process) / CLOCKS_PER_SEC;
        std::printf("CGAL\t%.9f\t%.9f\t%zu\n", time.count(), process, answer.number_of_finite_cells());
        std::fflush(stdout);
    }
    return 0;
}
