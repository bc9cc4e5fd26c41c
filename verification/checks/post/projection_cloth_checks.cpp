// The projection of whole cloths: pinched and subdivided.
#include "reference/mesh/shapes.h"
#include "reference/mesh/subdivision.h"
#include "verification/oracles/exact_geometry.h"
#include "verification/seeds.h"
#include "verification/specimens/check.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/projection_specimens.h"
#include "verification/specimens/random.h"

namespace foldproof {

namespace {

constexpr double radius = 0.3;  // of balls [m]

Object ball_at(const Vector3& centre) {
  return {"ball", RigidObject{Sphere{radius}, {Eigen::Quaterniond::Identity(), centre}, Motion{}},
          0};
}

/// A square sheet, jittered, in the plane z = 0 about the origin.
TriangleMesh small_sheet(double side, int cells) {
  TriangleMesh mesh =
      make_sheet({SheetPattern::jittered, side, side, cells, cells, 0.2, shifted_seed(29)});
  mesh.rest.colwise() -= Vector3(side / 2, side / 2, 0);
  return mesh;
}

/// Largest length of an edge over its length before.
double largest_stretch(const TriangleMesh& mesh, const PerParticle3& before,
                       const PerParticle3& after) {
  Worst worst;
  for (const Edge& edge : mesh.edges)
    worst.observe((after.col(edge.a) - after.col(edge.b)).norm() /
                  (before.col(edge.a) - before.col(edge.b)).norm());
  return worst.value();
}

/// Cloth held between two balls that overlap by .2 m, rippled by a few millimetres
/// about their middle.
ProjectionCase pinched_cloth(const TriangleMesh& mesh, double ripple) {
  ProjectionCase specimen{"pinched", {ball_at({0, 0, 0.2}), ball_at({0, 0, -0.2})}, 0, mesh.rest};
  for (int i = 0; i < mesh.particles(); ++i)
    specimen.x(2, i) += ripple * std::sin(47 * specimen.x(0, i)) * std::cos(41 * specimen.x(1, i));
  return specimen;
}

Finding pinched_points_would_tear() {
  const TriangleMesh mesh = small_sheet(0.25, 20);
  const std::string finding = "stretch when left alone over stretch when projected";
  Table measured{{"case", ""},
                 {finding, "1"},
                 {"stretch when left alone", "1"},
                 {"stretch when projected", "1"}};
  for (const double ripple : {0.001, 0.004}) {
    for (const DepthMap& map : depth_maps()) {
      const ProjectionCase specimen = pinched_cloth(mesh, ripple);
      FoldProjection projection = projection_by(std::string(map.name));
      const double alone =
          largest_stretch(mesh, specimen.x, project_specimen(specimen, projection).x);
      projection.pinched = PinchedPoints::projected;
      const double moved =
          largest_stretch(mesh, specimen.x, project_specimen(specimen, projection).x);
      measured.row(std::string(map.name) + ", ripple " + std::to_string(ripple) + " m",
                   alone / moved, alone, moved);
    }
  }
  return judge_worst(measured, finding, 0.2,
                     "neighbours on different sides of the middle leave by different balls, each a "
                     "tenth of a metre away, where edges are an eightieth: a fifth allows for "
                     "edges that stay short because of a few particles");
}

/// A wavy sheet that cuts through the ball about the origin, 5 cm below its top.
PerParticle3 sunk(const TriangleMesh& mesh) {
  PerParticle3 x = mesh.rest;
  for (int i = 0; i < mesh.particles(); ++i)
    x(2, i) += radius - 0.05 + 0.02 * std::sin(27 * x(0, i) + 0.4 * x(1, i));
  return x;
}

/// Cloth moved out of the ball about the origin, and the eps used [m].
struct BroughtOut {
  PerParticle3 x;
  double eps;
};

/// With an eps that suits the edge lengths after the projection.
BroughtOut out_of_the_ball(const std::vector<Triangle>& triangles, const PerParticle3& x) {
  const auto enough = [&](const PerParticle3& at) {
    return std::pow(longest_edge(triangles, at), 2) / (6 * radius);
  };
  BroughtOut out{x, 0};
  for (int k = 0; k < 20 && out.eps < enough(out.x); ++k) {
    out.eps = 1.05 * enough(out.x);
    FoldProjection projection = projection_by("blend");
    projection.band = {out.eps, out.eps + 0.03, 0.05};
    out.x = project_specimen({"ball", {ball_at(Vector3::Zero())}, 0, x}, projection).x;
  }
  return out;
}

std::size_t left_inside(const std::vector<Triangle>& triangles, const PerParticle3& x) {
  return oracles::triangles_in_ball({x, triangles}, Vector3::Zero(), radius).size();
}

Finding serves_the_subdivided_cloth() {
  const TriangleMesh mesh = small_sheet(0.4, 12);
  const PerParticle3 x = sunk(mesh);
  Table measured("case; triangles left inside [1]; triangles inside before [1]; eps [m]");
  for (const auto& [name, rule] :
       {std::pair{"midpoint", SubdivisionRule::midpoint}, {"loop", SubdivisionRule::loop}}) {
    for (const int levels : {1, 2, 3}) {
      const Subdivision finer = subdivision(mesh, rule, levels);
      const PerParticle3 fine = finer.of(x);
      const BroughtOut out = out_of_the_ball(finer.triangles, fine);
      measured.row(std::string(name) + ", " + std::to_string(levels) + " levels",
                   left_inside(finer.triangles, out.x), left_inside(finer.triangles, fine),
                   out.eps);
    }
  }
  return judge_worst(measured, "triangles left inside", 0,
                     "vertices at L^2/(6 R) or farther from a ball of radius R keep triangles with "
                     "edges of L clear of it; decided in whole numbers");
}

Finding subdividing_afterwards_spoils_it() {
  const TriangleMesh mesh = small_sheet(0.4, 12);
  const PerParticle3 x = sunk(mesh);
  Table measured("case; cloths without a triangle inside [1]; triangles left inside [1]");
  for (const int levels : {1, 2, 3}) {
    const Subdivision finer = subdivision(mesh, SubdivisionRule::loop, levels);
    FoldProjection projection = projection_by("blend");
    const double eps = out_of_the_ball(finer.triangles, finer.of(x)).eps;
    projection.band = {eps, eps + 0.03, 0.05};
    const ProjectedCloth coarse =
        project_specimen({"ball", {ball_at(Vector3::Zero())}, 0, x}, projection);
    const std::size_t inside = left_inside(finer.triangles, finer.of(coarse.x));
    measured.row(std::to_string(levels) + " levels after the projection", inside == 0, inside);
  }
  return judge_worst(measured, "cloths without a triangle inside", 0,
                     "the same eps, but the coarse cloth is projected: smoothing pulls its points "
                     "towards the ball, and new ones lie on edges that cut into it");
}

/// |x fine - x| at the old particles and on the line between the ends of each edge, over epsilon
/// and the extent.
Finding midpoints_keep_the_surface() {
  Table measured = roundings_of("extent");
  for (const int levels : {1, 3}) {
    const TriangleMesh mesh = small_sheet(0.4, 7);
    const PerParticle3 x = sunk(mesh);
    const Subdivision finer = subdivision(mesh, SubdivisionRule::midpoint, levels);
    const PerParticle3 fine = finer.of(x);
    Worst worst;
    worst.observe(largest_difference(fine.leftCols(x.cols()), x) / (epsilon * extent(x)));
    const double area = triangle_areas(mesh.triangles, x).sum(),
                 same = triangle_areas(finer.triangles, fine).sum();
    worst.observe(std::abs(same - area) / (epsilon * area * 4));
    measured.row(std::to_string(levels) + " levels", worst.value());
  }
  return judge_worst(measured, 16,
                     "halves of sums are rounded once a level; the area adds some thousands of "
                     "terms whose roundings mostly cancel");
}

Finding loop_is_affine() {
  Table measured = roundings_of("extent");
  const TriangleMesh mesh = make_icosphere(0.23, 1);
  Random random(83);
  Eigen::Matrix3d A = Eigen::Matrix3d::Identity() + random.vectors(3, 0.7);
  const Vector3 b(0.3, -0.2, 0.5);
  const Subdivision finer = subdivision(mesh, SubdivisionRule::loop, 2);
  const PerParticle3 after = (A * finer.of(mesh.rest)).colwise() + b;
  const PerParticle3 before = finer.of((A * mesh.rest).colwise() + b);
  measured.row("turned, sheared and moved",
               largest_difference(after, before) / (epsilon * extent(before)));
  // Loop (1987): an inner point of degree 6 keeps 10/16; of degree 5, the icosahedron's corners,
  // 1 - 5 * .084093
  const Subdivision once = subdivision(mesh, SubdivisionRule::loop, 1);
  const double expected5 = 1 - (5.0 / 8 - std::pow(3.0 / 8 + std::cos(2 * pi / 5) / 4, 2));
  measured.row("weight of a point of degree 5",
               std::abs(once.weights.coeff(0, 0) - expected5) / epsilon);
  measured.row("weight of a point of degree 6",
               std::abs(once.weights.coeff(20, 20) - 10.0 / 16) / epsilon);
  return judge_worst(measured, 32,
                     "weights of a row sum to 1, so that subdividing and moving commute to the "
                     "roundings of some twenty terms");
}

}  // namespace

std::vector<Check> projection_cloth_checks() {
  const std::string source = "BMF03 section 5.3";
  return {
      {"projection.projecting-pinched-points-would-tear-the-cloth",
       "Cloth pinched between two balls would be torn apart if its points were projected, and is "
       "not if they are left alone.",
       source, pinched_points_would_tear},
      {"projection.subdividing-first-leaves-no-triangle-inside",
       "Cloth that is subdivided first and then projected has no triangle inside.", source,
       serves_the_subdivided_cloth},
      {"projection.subdividing-afterwards-leaves-triangles-inside",
       "Cloth that is projected first and then subdivided, by Loop's rule, has triangles inside.",
       source, subdividing_afterwards_spoils_it},
      {"subdivision.midpoint-subdivision-preserves-the-surface",
       "Subdivision at midpoints keeps points and area.", "geometry", midpoints_keep_the_surface},
      {"subdivision.loop-subdivision-is-affine-invariant",
       "Loop's subdivision commutes with affine maps and has Loop's weights.", "Loop (1987)",
       loop_is_affine}};
}

}  // namespace foldproof
