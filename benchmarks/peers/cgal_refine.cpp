// CGAL's Delaunay mesher: `cgal_refine FILE ANGLE AREA OUTPUT`, with the input of the Rust program
// `constrained`. Points and constraints are inserted and the domain inside is meshed until no angle
// is below ANGLE degrees and no edge longer than makes triangles about as large as a cap of AREA does;
// prints the seconds of both, writes corners.
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_size_criteria_2.h>
#include <CGAL/Delaunay_mesh_vertex_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertex = CGAL::Delaunay_mesh_vertex_base_2<Kernel>;
using Face = CGAL::Delaunay_mesh_face_base_2<Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<Vertex, Face>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure>;
using Criteria = CGAL::Delaunay_mesh_size_criteria_2<Triangulation>;
using Mesher = CGAL::Delaunay_mesher_2<Triangulation, Criteria>;

template <class Number>
std::vector<Number> read(const std::string& file) {
    std::ifstream input(file, std::ios::binary | std::ios::ate);
    std::vector<Number> numbers(input.tellg() / sizeof(Number));
    input.seekg(0);
    input.read(reinterpret_cast<char*>(numbers.data()), numbers.size() * sizeof(Number));
    return numbers;
}

int main(int count, char** arguments) {
    if (count != 5) {
        std::fputs("usage: cgal_refine FILE ANGLE AREA OUTPUT\n", stderr);
        return 2;
    }
    const std::string file = arguments[1];
    const auto numbers = read<double>(file);
    const auto rows = read<std::uint32_t>(file + ".segments");
    std::vector<Kernel::Point_2> points;
    for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
        points.emplace_back(numbers[i], numbers[i + 1]);
    }
    std::vector<std::pair<std::size_t, std::size_t>> segments;
    for (std::size_t i = 0; i + 1 < rows.size(); i += 2) segments.emplace_back(rows[i], rows[i + 1]);
    // Found by trial: with this edge a square gets as many triangles as Triangle makes with the cap.
    const double edge = 1.72 * std::sqrt(std::atof(arguments[3]));
    const double sine = std::sin(std::atof(arguments[2]) * M_PI / 180);
    const auto start = std::chrono::steady_clock::now();
    Triangulation answer;
    answer.insert_constraints(points.begin(), points.end(), segments.begin(), segments.end());
    Mesher mesher(answer);
    mesher.set_criteria(Criteria(sine * sine, edge));
    mesher.refine_mesh();
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    std::printf("%.9f\n", time.count());
    std::ofstream output(arguments[4], std::ios::binary);
    for (auto f = answer.finite_faces_begin(); f != answer.finite_faces_end(); ++f) {
        if (!f->is_in_domain()) continue;
        for (int k = 0; k < 3; ++k) {
            const double xy[2] = {f->vertex(k)->point().x(), f->vertex(k)->point().y()};
            output.write(reinterpret_cast<const char*>(xy), sizeof xy);
        }
    }
    return 0;
}
