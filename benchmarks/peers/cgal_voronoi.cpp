// CGAL's Voronoi adaptor on one file of points: `cgal_voronoi RUNS FILE [PEER]`, with the input and the
// timing of the programs beside it. From points to arrays: the coordinates of vertices, for each
// ridge its two sites and two ends, for each cell its vertices in order. Exact predicates and inexact
// constructions, and the policy that leaves out ridges without length, as the manual recommends. Beside
// it the same arrays straight from the triangulation, without the adaptor; where sites are cocircular
// these hold a vertex for each triangle, and ridges without length.
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_adaptation_policies_2.h>
#include <CGAL/Delaunay_triangulation_adaptation_traits_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/Voronoi_diagram_2.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertices = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using Faces = CGAL::Triangulation_face_base_with_info_2<int, Kernel>;
using Triangulation = CGAL::Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<Vertices, Faces>>;
using Traits = CGAL::Delaunay_triangulation_adaptation_traits_2<Triangulation>;
using Policy = CGAL::Delaunay_triangulation_caching_degeneracy_removal_policy_2<Triangulation>;
using Diagram = CGAL::Voronoi_diagram_2<Triangulation, Traits, Policy>;

struct Arrays {
    std::vector<double> vertices;
    std::vector<int> sites, ends, starts, cells;
};

static Arrays arrays_of(const Diagram& diagram) {
    Arrays out;
    int count = 0;
    for (auto v = diagram.vertices_begin(); v != diagram.vertices_end(); ++v) {
        v->dual()->info() = count++;
        const auto at = v->point();
        out.vertices.push_back(at.x());
        out.vertices.push_back(at.y());
    }
    for (auto e = diagram.edges_begin(); e != diagram.edges_end(); ++e) {
        out.sites.push_back(e->up()->info());
        out.sites.push_back(e->down()->info());
        out.ends.push_back(e->has_source() ? e->source()->dual()->info() : -1);
        out.ends.push_back(e->has_target() ? e->target()->dual()->info() : -1);
    }
    out.starts.push_back(0);
    for (auto f = diagram.faces_begin(); f != diagram.faces_end(); ++f) {
        auto around = f->ccb();
        const auto first = around;
        do {
            out.cells.push_back(around->has_source() ? around->source()->dual()->info() : -1);
        } while (++around != first);
        out.starts.push_back(static_cast<int>(out.cells.size()));
    }
    return out;
}

static Arrays arrays_of(Triangulation& triangulation) {
    Arrays out;
    int count = 0;
    for (auto f : triangulation.finite_face_handles()) {
        f->info() = count++;
        const auto at = triangulation.dual(f);
        out.vertices.push_back(at.x());
        out.vertices.push_back(at.y());
    }
    const auto number = [&](Triangulation::Face_handle f) {
        return triangulation.is_infinite(f) ? -1 : f->info();
    };
    for (auto e = triangulation.finite_edges_begin(); e != triangulation.finite_edges_end(); ++e) {
        const auto [f, k] = *e;
        out.sites.push_back(f->vertex(Triangulation::ccw(k))->info());
        out.sites.push_back(f->vertex(Triangulation::cw(k))->info());
        out.ends.push_back(number(f));
        out.ends.push_back(number(f->neighbor(k)));
    }
    out.starts.push_back(0);
    for (auto v : triangulation.finite_vertex_handles()) {
        auto around = triangulation.incident_faces(v);
        const auto first = around;
        do {
            out.cells.push_back(number(around));
        } while (++around != first);
        out.starts.push_back(static_cast<int>(out.cells.size()));
    }
    return out;
}

int main(int count, char** arguments) {
    if (count != 3 && count != 4) {
        std::fputs("usage: cgal_voronoi RUNS FILE [PEER]\n", stderr);
        return 2;
    }
    std::ifstream input(arguments[2], std::ios::binary | std::ios::ate);
    std::vector<double> numbers(input.tellg() / sizeof(double));
    input.seekg(0);
    input.read(reinterpret_cast<char*>(numbers.data()), numbers.size() * sizeof(double));
    std::vector<std::pair<Kernel::Point_2, int>> points;
    for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
        points.emplace_back(Kernel::Point_2(numbers[i], numbers[i + 1]), static_cast<int>(i / 2));
    }
    const std::string which = count == 4 ? arguments[3] : "";
    for (int run = 0; run < 2 * std::atoi(arguments[1]); ++run) {
        const char* name = run % 2 == 0 ? "CGAL Voronoi adaptor" : "CGAL, dual by hand";
        if (!which.empty() && which != name) {
            continue;
        }
        const auto start = std::chrono::steady_clock::now();
        Triangulation triangulation;
        triangulation.insert(points.begin(), points.end());
        Arrays out;
        if (run % 2 == 0) {
            out = arrays_of(Diagram(triangulation, true));
        } else {
            out = arrays_of(triangulation);
        }
        const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
        std::printf("%s\t%.9f\t%zu\n", name, time.count(), out.vertices.size() / 2);
    }
    return 0;
}
