#include <bit>
#include <filesystem>
#include <map>
#include <utility>

#include "reference/mesh/mesh_file.h"
#include "reference/mesh/shapes.h"
#include "verification/seeds.h"
#include "verification/specimens/check.h"
#include "verification/specimens/random.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

constexpr double width = 0.47, height = 0.29;  // of all sheets [m]

/// A mesh and the values that geometry predicts for it.
struct Known {
  std::string name;
  TriangleMesh mesh;
  int euler;    // V - E + F
  double area;  // m^2; NaN if not predicted
};

Sheet sheet_of(SheetPattern pattern) {
  return {pattern, width, height, 7, 5, 0.31, shifted_seed(83)};
}

std::vector<Known> known_shapes() {
  const std::vector<std::pair<std::string, SheetPattern>> patterns = {
      {"one_diagonal", SheetPattern::one_diagonal},      {"alternating", SheetPattern::alternating},
      {"union_jack", SheetPattern::union_jack},          {"criss_cross", SheetPattern::criss_cross},
      {"equilateral", SheetPattern::equilateral},        {"jittered", SheetPattern::jittered},
      {"random_delaunay", SheetPattern::random_delaunay}};
  std::vector<Known> shapes;
  for (const auto& [name, pattern] : patterns)
    shapes.push_back({name, make_sheet(sheet_of(pattern)), 1, width * height});
  // a regular polygon of 6 * 4 corners
  const double disc = 0.5 * 24 * 0.31 * 0.31 * std::sin(2 * pi / 24);
  const double cylinder = 11 * 2 * 0.13 * std::sin(pi / 11) * 0.37;  // 11 flat strips
  const double side = 0.23 / std::sin(2 * pi / 5);  // of an icosahedron in a sphere of .23 m
  shapes.push_back({"disc", make_disc(0.31, 4), 1, disc});
  shapes.push_back({"cylinder", make_cylinder(0.13, 0.37, 11, 6), 0, cylinder});
  shapes.push_back({"icosahedron", make_icosphere(0.23, 0), 2, 5 * std::sqrt(3.0) * side * side});
  shapes.push_back({"icosphere", make_icosphere(0.23, 3), 2, nan});
  shapes.push_back({"geodesic sphere", make_geodesic_sphere(0.23, 5), 2, nan});
  const TriangleMesh coarse = make_sheet(sheet_of(SheetPattern::random_delaunay));
  shapes.push_back({"divided sheet", divide_edges(coarse, 4), 1, width * height});
  shapes.push_back({"statue", small_statue(), 2, nan});
  shapes.push_back({"hinge", make_hinge(0.17, 2.1), 1, 0.5 * (0.9 + 0.6) * 0.17 * 0.17});
  return shapes;
}

Finding euler_characteristic_is_known() {
  Table measured{{"case", ""}, {"difference from the surface's", "1"}};
  for (const Known& shape : known_shapes()) {
    std::map<std::pair<int, int>, int> edges;
    for (const Triangle& t : shape.mesh.triangles) {
      for (int k = 0; k < 3; ++k) ++edges[std::minmax({t[k], t[(k + 1) % 3]})];
    }
    const int counted =
        shape.mesh.particles() - int(edges.size()) + int(shape.mesh.triangles.size());
    measured.row(shape.name, std::abs(euler_characteristic(shape.mesh) - shape.euler) +
                                 std::abs(counted - shape.euler));
  }
  return judge_worst(measured, 0,
                     "whole numbers: 1 for a sheet or a disc, 0 for an open cylinder, 2 for a "
                     "closed surface without handles");
}

/// True if the triangle is (a, b, c) or a cyclic permutation.
bool runs(const Triangle& triangle, int a, int b, int c) {
  return triangle == Triangle{a, b, c} || triangle == Triangle{b, c, a} ||
         triangle == Triangle{c, a, b};
}

Finding hinges_are_oriented() {
  Table measured{{"case", ""}, {"hinges otherwise", "1"}};
  for (const Known& shape : known_shapes()) {
    int fallback = 0;
    for (const Hinge& hinge : shape.mesh.hinges) {
      const auto [x1, x2, x3, x4] = hinge.particles;
      const Edge& edge = shape.mesh.edges[hinge.edge];
      int first = 0, second = 0;
      for (const int t : edge.triangles) {
        first += runs(shape.mesh.triangles[t], x1, x3, x4);
        second += runs(shape.mesh.triangles[t], x2, x4, x3);
      }
      fallback +=
          !(first == 1 && second == 1 && std::min(x3, x4) == edge.a && std::max(x3, x4) == edge.b);
    }
    measured.row(shape.name, fallback);
  }
  return judge_worst(measured, 0,
                     "every hinge must be (x1, x3, x4) and (x2, x4, x3) of its two triangles, as "
                     "drawn in the paper");
}

Finding every_inner_edge_is_one_hinge() {
  Table measured{{"case", ""}, {"edges wrong", "1"}};
  for (const Known& shape : known_shapes()) {
    std::map<std::pair<int, int>, int> triangles, hinges;
    for (const Triangle& t : shape.mesh.triangles) {
      for (int k = 0; k < 3; ++k) ++triangles[std::minmax({t[k], t[(k + 1) % 3]})];
    }
    for (const Hinge& hinge : shape.mesh.hinges)
      ++hinges[std::minmax({hinge.particles[2], hinge.particles[3]})];
    int wrong = std::abs(int(triangles.size()) - int(shape.mesh.edges.size()));
    for (const Edge& edge : shape.mesh.edges) {
      const int count = triangles[{edge.a, edge.b}], hinge_count = hinges[{edge.a, edge.b}];
      wrong += (count == 1) != (edge.triangles[1] < 0) || count > 2 || count < 1 ||
               hinge_count != count - 1;
    }
    measured.row(shape.name, wrong);
  }
  return judge_worst(measured, 0,
                     "edges and hinges are counted: one edge for each pair of neighbours, one "
                     "hinge for each edge of two triangles");
}

Finding areas_and_masses_sum() {
  Table measured = roundings_of("of the exact value");
  const double density = 0.37;
  for (const Known& shape : known_shapes()) {
    const double sum = triangle_areas(shape.mesh.triangles, shape.mesh.rest).sum();
    const double exact = std::isnan(shape.area) ? sum : shape.area;
    Worst worst;
    worst.observe(std::abs(sum - exact) / (epsilon * exact));
    worst.observe(std::abs(lumped_masses(shape.mesh, density).sum() - density * exact) /
                  (epsilon * density * exact));
    worst.observe(std::abs(edge_areas(shape.mesh).sum() - 3 * exact) / (epsilon * 3 * exact));
    measured.row(shape.name, worst.value());
  }
  return judge_worst(
      measured, 64, "about ten roundings an area, with errors of either sign, added one by one",
      "The exact value is the area, the mass, or three times the area for the edges' areas. Areas "
      "are those of plane geometry; for the round sphere and the statue the mesh's own area stands "
      "in, and only masses and edge areas are compared with it.");
}

Finding obj_round_trip_is_exact() {
  const ScratchFolder folder;
  Table measured{{"case", ""}, {"numbers that came back otherwise", "1"}};
  Random random(311);
  for (Known& shape : known_shapes()) {
    PerParticle3 x = shape.mesh.rest + random.vectors(shape.mesh.rest.cols(), 1e-3);
    x *= random.log_uniform(1e-9, 1e7);
    const std::string path = folder.file(shape.name + ".obj");
    write_obj(path, x, shape.mesh.triangles);
    const TriangleMesh back = read_mesh(path);
    int fallback =
        int(back.triangles != shape.mesh.triangles) + 1000 * int(back.rest.cols() != x.cols());
    for (Eigen::Index k = 0; k < std::min(x.size(), back.rest.size()); ++k) {
      fallback += std::bit_cast<uint64_t>(x.reshaped()[k]) !=
                  std::bit_cast<uint64_t>(back.rest.reshaped()[k]);
    }
    measured.row(shape.name, fallback);
  }
  return judge_worst(measured, 0,
                     "17 significant digits hold a double, so every bit must come back");
}

Finding pleats_are_isometric() {
  Table measured = roundings_of("of the size");
  for (const double angle : {0.7, -1.9, 2.9}) {
    for (const SheetPattern pattern : {SheetPattern::one_diagonal, SheetPattern::union_jack}) {
      Sheet sheet = sheet_of(pattern);
      sheet.columns = 9;
      const TriangleMesh flat = make_sheet(sheet),
                         folded =
                             make_triangle_mesh(pleated_positions(flat, 3, angle), flat.triangles);
      Worst length, fold;
      length.observe(
          (rest_lengths(folded) - rest_lengths(flat)).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() /
          (epsilon * width));
      int fold_lines = 0;
      for (const Hinge& hinge : flat.hinges) {
        const Corners x = corners_of(hinge, folded.rest);
        const double found = std::abs(hinge_angle(x[0], x[1], x[2], x[3]));
        const bool is_fold = found > 0.5 * std::abs(angle);
        fold_lines += is_fold;
        fold.observe(std::abs(found - (is_fold ? std::abs(angle) : 0)) / (epsilon * pi));
      }
      fold.observe(fold_lines == 2 * sheet.rows ? 0 : nan);
      const std::string name =
          (pattern == SheetPattern::union_jack ? "union_jack" : "one_diagonal");
      measured.row(name + " by " + std::to_string(angle) + " rad, lengths", length.value());
      measured.row(name + " by " + std::to_string(angle) + " rad, angles", fold.value());
    }
  }
  return judge_worst(measured, 64,
                     "a vertex is placed by adding up to nine columns; angles divide such errors "
                     "by a cell, a ninth of the width",
                     "the size is the sheet's width for lengths, pi for angles");
}

Finding hinge_folds_by_its_angle() {
  Table measured = roundings_of("pi");
  for (const double angle : {-3.1, -1.7, -0.2, 0.0, 0.4, 1.5, 2.9}) {
    const TriangleMesh mesh = make_hinge(0.23, angle);
    const double found = hinge_angles(mesh, mesh.rest).at(0);
    measured.row(std::to_string(angle) + " rad", std::abs(found - angle) / (epsilon * pi));
  }
  return judge_worst(measured, 16,
                     "sine and cosine, placed and recovered, carry a few roundings of 1");
}

}  // namespace

std::vector<Check> mesh_checks() {
  const char* const source = "plane geometry and topology";
  return {{"mesh.euler-characteristic-is-correct",
           "The reference's meshes have the Euler characteristic of their surfaces.", source,
           euler_characteristic_is_known},
          {"mesh.hinges-are-oriented-as-drawn",
           "Every hinge of the reference's meshes is (x1, x3, x4) and (x2, x4, x3).",
           "BMF03 figure 1", hinges_are_oriented},
          {"mesh.every-interior-edge-has-one-hinge",
           "The reference finds each edge once, and one hinge for each inner edge.", source,
           every_inner_edge_is_one_hinge},
          {"mesh.areas-and-masses-add-up",
           "The reference's areas, masses and edge areas sum to those of the surface.", source,
           areas_and_masses_sum},
          {"mesh.obj-round-trip-is-exact",
           "A mesh that the reference writes and reads back is the same, bit for bit.",
           "the OBJ format", obj_round_trip_is_exact},
          {"mesh.pleats-are-isometric",
           "The reference's pleats keep every length and fold by the requested angle.", source,
           pleats_are_isometric},
          {"mesh.hinge-folds-by-the-given-angle",
           "The reference's hinge is folded by the requested angle, sign included.",
           "BMF03 section 4", hinge_folds_by_its_angle}};
}

}  // namespace foldproof
