// Triangles of the projected cloth against the objects, decided without rounding and without a
// distance field.
#include "reference/mesh/shapes.h"
#include "verification/oracles/exact_geometry.h"
#include "verification/seeds.h"
#include "verification/specimens/check.h"
#include "verification/specimens/projection_specimens.h"

namespace foldproof {

namespace {

constexpr double radius = 0.29;                      // of the ball [m]
const Vector3 half_extents(0.1875, 0.25, 0.140625);  // of the box [m]

/// A wavy, jittered sheet that cuts through the object about the origin, up to .1 m below its top.
struct Sunk {
  TriangleMesh mesh;
  PerParticle3 x;  // m
};

Sunk sunk_sheet(double height, unsigned seed) {
  Sunk sunk{make_sheet({SheetPattern::jittered, 0.9, 0.8, 22, 22, 0.3, shifted_seed(seed)}), {}};
  sunk.x = sunk.mesh.rest;
  for (Eigen::Index i = 0; i < sunk.x.cols(); ++i) {
    Eigen::Ref<Vector3> p = sunk.x.col(i);
    p += Vector3(-0.45, -0.4, height);
    p.z() += 0.02 * std::sin(31 * p.x() + 0.7 * seed) * std::cos(23 * p.y());
  }
  return sunk;
}

oracles::TriangleSoup soup_of(const TriangleMesh& mesh, const PerParticle3& x) {
  return {x, mesh.triangles};
}

Object body(const Solid& solid) { return {"body", RigidObject{solid, {}, Motion{}}, 0}; }

/// A solid, and the count of a cloth's triangles that are not clear of it.
struct Target {
  std::string name;
  Solid solid;
  double top;                                 // its height above the origin [m]
  std::function<double(double edge)> enough;  // eps for edges of this length [m]
  std::function<std::size_t(const oracles::TriangleSoup&)> inside;
};

std::vector<Target> targets() {
  return {{"ball", Sphere{radius}, radius, [](double edge) { return edge * edge / (6 * radius); },
           [](const oracles::TriangleSoup& cloth) {
             return oracles::triangles_in_ball(cloth, Vector3::Zero(), radius).size();
           }},
          {"box", Box{half_extents}, half_extents.z(),
           [](double edge) { return edge / std::sqrt(3.0); },
           [](const oracles::TriangleSoup& cloth) {
             return oracles::triangles_in_body(cloth,
                                               oracles::box_between(-half_extents, half_extents))
                 .size();
           }}};
}

/// The sheet projected with an eps large enough for its edges afterwards, or with eps = 0.
PerParticle3 project_out(const Target& target, const Sunk& sunk, const std::string& map,
                         bool has_clearance) {
  const ProjectionCase specimen{target.name, {body(target.solid)}, 0, sunk.x};
  double eps = 0;
  PerParticle3 x = sunk.x;
  for (int k = 0; k < 4; ++k) {
    FoldProjection projection = projection_by(map);
    projection.band = {eps, 2 * eps + 0.03, 0.04};  // the deepest points all map to eps
    x = project_specimen(specimen, projection).x;
    if (!has_clearance || eps >= target.enough(longest_edge(sunk.mesh.triangles, x))) break;
    eps = 1.01 * target.enough(longest_edge(sunk.mesh.triangles, x));
  }
  return x;
}

/// Counts for each sheet, over targets, maps and depths.
template <class Count>
Table over_sheets(bool has_clearance, const std::string& counted, const Count& count) {
  Table measured{{"case", ""}, {counted, "1"}};
  unsigned seed = 61;
  for (const Target& target : targets()) {
    for (const DepthMap& map : depth_maps()) {
      const Sunk sunk = sunk_sheet(target.top - 0.05, ++seed);
      const PerParticle3 x = project_out(target, sunk, std::string(map.name), has_clearance);
      measured.row(target.name + ", " + std::string(map.name), count(target, sunk, x));
    }
  }
  return measured;
}

Finding no_triangle_is_left_inside() {
  const auto inside = [](const Target& target, const Sunk& sunk, const PerParticle3& x) {
    const bool began_inside = target.inside(soup_of(sunk.mesh, sunk.x)) > 0;
    return began_inside ? double(target.inside(soup_of(sunk.mesh, x))) : NAN;
  };
  return judge_worst(
      over_sheets(true, "triangles left inside", inside), 0,
      "vertices eps from a ball of radius R keep edges of length L clear of it from eps = L^2/(6 "
      "R) on; for any body, no point of a triangle is farther than L/sqrt(3) from all its corners, "
      "and phi falls by at most the distance moved",
      "Integer arithmetic on the cloth's and the body's coordinates; no distance field is used.");
}

Finding no_eps_is_too_little() {
  const auto is_clear = [](const Target& target, const Sunk& sunk, const PerParticle3& x) {
    return target.inside(soup_of(sunk.mesh, x)) == 0 ? 1.0 : 0.0;
  };
  return judge_worst(over_sheets(false, "sheets without a triangle inside", is_clear), 0,
                     "with eps = 0 edges between points of a convex surface run below it");
}

}  // namespace

std::vector<Check> projection_exact_checks() {
  const std::string source = "BMF03 section 5.3";
  return {{"projection.no-triangle-is-left-inside",
           "With an eps that suits its edges, no triangle of the projected cloth meets the body.",
           source, no_triangle_is_left_inside},
          {"projection.zero-eps-leaves-triangles-inside",
           "With eps = 0 triangles of the projected cloth still cut into convex bodies.", source,
           no_eps_is_too_little}};
}

}  // namespace foldproof
