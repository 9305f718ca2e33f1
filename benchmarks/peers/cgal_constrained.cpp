// CGAL's constrained Delaunay triangulation on points and segments: `cgal_constrained RUNS FILE
// [split]`, with the input, the timing and the output of the Rust program `constrained` beside it.
//
// Two ways, both with exact predicates and inexact constructions: insert_constraints, as its manual
// says; and faster, a Delaunay triangulation whose points go in along a space-filling curve, each
// beside the one before, and whose structure a constrained one then takes over for the segments.
// Segments may cross only with `split`, in which case the tag asks for crossings as exact as
// coordinates of this kernel can be.
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Points = std::vector<Kernel::Point_2>;
using Segments = std::vector<std::pair<std::size_t, std::size_t>>;
using Vertex = CGAL::Triangulation_vertex_base_2<Kernel>;
using Face = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<Vertex, Face>;
template <class Tag>
using Constrained = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, Tag>;
using Plain = Constrained<CGAL::No_constraint_intersection_requiring_constructions_tag>;
using Delaunay = CGAL::Delaunay_triangulation_2<Kernel, Structure>;
using Splitting = Constrained<CGAL::Exact_predicates_tag>;

template <class Number>
std::vector<Number> read(const std::string& file) {
    std::ifstream input(file, std::ios::binary | std::ios::ate);
    std::vector<Number> numbers(input.tellg() / sizeof(Number));
    input.seekg(0);
    input.read(reinterpret_cast<char*>(numbers.data()), numbers.size() * sizeof(Number));
    return numbers;
}

template <class Triangulation>
void write(const Triangulation& answer, const std::string& file) {
    std::ofstream output(file, std::ios::binary);
    for (auto f = answer.finite_faces_begin(); f != answer.finite_faces_end(); ++f) {
        for (int k = 0; k < 3; ++k) {
            const double xy[2] = {f->vertex(k)->point().x(), f->vertex(k)->point().y()};
            output.write(reinterpret_cast<const char*>(xy), sizeof xy);
        }
    }
}

template <class Triangulation>
void insert_constraints(Triangulation& answer, const Points& points, const Segments& segments) {
    answer.insert_constraints(points.begin(), points.end(), segments.begin(), segments.end());
}

void delaunay_first(Plain& answer, const Points& points, const Segments& segments) {
    using Row = std::pair<Kernel::Point_2, std::size_t>;
    using Order = CGAL::Spatial_sort_traits_adapter_2<Kernel, CGAL::First_of_pair_property_map<Row>>;
    std::vector<Row> rows;
    rows.reserve(points.size());
    for (const auto& point : points) rows.emplace_back(point, rows.size());
    CGAL::spatial_sort(rows.begin(), rows.end(), Order());
    Delaunay built;
    std::vector<Structure::Vertex_handle> vertex(points.size());
    Structure::Face_handle hint;
    for (const auto& [point, row] : rows) {
        vertex[row] = built.insert(point, hint);
        hint = vertex[row]->face();
    }
    answer.tds().swap(built.tds());
    answer.set_infinite_vertex(built.infinite_vertex());
    for (auto f = answer.all_faces_begin(); f != answer.all_faces_end(); ++f) {
        for (int k = 0; k < 3; ++k) f->set_constraint(k, false);
    }
    for (const auto& [a, b] : segments) {
        if (vertex[a] != vertex[b]) answer.insert_constraint(vertex[a], vertex[b]);
    }
}

template <class Triangulation, class Call>
void time_run(const char* name, Call call, const Points& points, const Segments& segments,
              const std::string& file) {
    try {
        const auto start = std::chrono::steady_clock::now();
        Triangulation answer;
        call(answer, points, segments);
        const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
        std::printf("%s\t%.9f\t%zu\n", name, time.count(), answer.number_of_faces());
        if (!file.empty()) write(answer, file + "." + name);
    } catch (const std::exception& error) {
        std::printf("%s\tfailed\t%s\n", name, error.what());
    }
}

int main(int count, char** arguments) {
    const bool split = count == 5 && std::string(arguments[4]) == "split";
    if (count != 4 && !split) {
        std::fputs("usage: cgal_constrained RUNS FILE PEER [split]\n", stderr);
        return 2;
    }
    const std::string peer = arguments[3];
    const std::string file = arguments[2];
    const auto numbers = read<double>(file);
    const auto rows = read<std::uint32_t>(file + ".segments");
    Points points;
    for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
        points.emplace_back(numbers[i], numbers[i + 1]);
    }
    Segments segments;
    for (std::size_t i = 0; i + 1 < rows.size(); i += 2) {
        segments.emplace_back(rows[i], rows[i + 1]);
    }
    for (int run = 0; run < std::atoi(arguments[1]); ++run) {
        const std::string answer = run == 0 ? file : "";
        if (split) {
            time_run<Splitting>("CGAL", insert_constraints<Splitting>, points, segments, answer);
        } else if (peer == "CGAL") {
            time_run<Plain>("CGAL", insert_constraints<Plain>, points, segments, answer);
        } else {
            time_run<Plain>("CGAL, Delaunay first", delaunay_first, points, segments, answer);
        }
    }
    return 0;
}
