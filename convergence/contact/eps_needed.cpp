// required-eps: how far out must the deepest points go, for no triangle between them to cut
// into the object?

#include "convergence/study.h"
#include "reference/mesh/shapes.h"
#include "reference/post/fold_projection.h"
#include "verification/oracles/exact_geometry.h"

namespace foldproof {

namespace {

constexpr double root3 = 1.7320508075688772;
const Vector3 half_extents(0.3125, 0.40625, 0.28125);  // of the box [m]

/// A body, the plane of a sheet that cuts into it, and who says which triangles are
/// not clear of it.
struct Body {
  std::string name, words;
  Solid solid;
  double size;                                  // edges are fractions of it [m]
  Vector3 normal;                               // of the sheet's plane
  std::function<Vector3(double edge)> through;  // a point of it [m]
  std::function<bool(const oracles::TriangleSoup& cloth)> is_clear;
  std::function<double(double edge)> bound;  // eps that is always enough [m]
  double order;                              // of eps in the edge, expected
};

Body ball(const std::string& name, double radius) {
  const Vector3 direction = Vector3(0.28, -0.31, 0.9).normalized();
  return {name,
          "ball of radius " + std::to_string(radius).substr(0, 4) + " m",
          Sphere{radius},
          radius,
          direction,
          [=](double) { return Vector3(0.97 * radius * direction); },
          [radius](const auto& cloth) {
            return oracles::triangles_in_ball(cloth, Vector3::Zero(), radius).empty();
          },
          [radius](double edge) { return edge * edge / (6 * radius); },
          2};
}

Body box_edge() {
  return {"box",
          "edge of a box",
          Box{half_extents},
          half_extents.z(),
          Vector3(1, 0.03, 1.04).normalized(),
          [](double edge) {
            return Vector3(half_extents.x() - 0.7 * edge, 0.007, half_extents.z() - 0.7 * edge);
          },
          [](const auto& cloth) {
            return oracles::triangles_in_body(cloth,
                                              oracles::box_between(-half_extents, half_extents))
                .empty();
          },
          [](double edge) { return edge / root3; },
          1};
}

/// A sheet of equilateral triangles in the body's plane, about its point.
struct Cloth {
  TriangleMesh mesh;
  PerParticle3 x;  // m
};

Cloth sheet_in(const Body& body, double edge) {
  constexpr int columns = 9, rows = 10;
  Cloth cloth{make_sheet({SheetPattern::equilateral, columns * edge, 0, columns, rows}), {}};
  const Vector3 u = body.normal.unitOrthogonal(), v = body.normal.cross(u),
                centre(4.3 * edge, 4.1 * edge, 0);
  cloth.x.resize(3, cloth.mesh.particles());
  for (int i = 0; i < cloth.mesh.particles(); ++i) {
    const Vector3 flat = cloth.mesh.rest.col(i) - centre;
    cloth.x.col(i) = body.through(edge) + flat.x() * u + flat.y() * v;
  }
  return cloth;
}

PerParticle3 project(const Body& body, const Cloth& cloth, double eps) {
  const std::vector<Object> objects = {{body.name, RigidObject{body.solid, {}, Motion{}}, 0}};
  const FoldProjection projection{
      "plain", {eps, eps + 1e-3, 1}, PinchedPoints::left_alone, 1e-13, 50};
  return project_folds(objects, cloth.x, 0, projection).x;
}

/// The least eps [m] with which no triangle meets the body, to a thousandth, and the longest edge
/// [m] that it has then.
struct NeededEps {
  double eps, longest_edge;
};

NeededEps find_needed_eps(const Body& body, double edge) {
  const Cloth cloth = sheet_in(body, edge);
  double too_little = 0, enough = 4 * edge;
  for (int k = 0; k < 60 && enough - too_little > 5e-4 * enough; ++k) {
    const double middle = (too_little + enough) / 2;
    const bool is_clear = body.is_clear({project(body, cloth, middle), cloth.mesh.triangles});
    (is_clear ? enough : too_little) = middle;
  }
  const PerParticle3 x = project(body, cloth, enough);
  double longest = 0;
  for (const Edge& e : cloth.mesh.edges)
    longest = std::max(longest, (x.col(e.a) - x.col(e.b)).norm());
  return {enough, longest};
}

/// eps against the longest edge, over edges that are halved level by level.
Table range_of(const Body& body, int levels) {
  return refine(
      {{"longest edge", "m"}, {"eps needed", "m"}, {"eps over what is always enough", "1"}},
      halving_range(body.size / 6, levels), [&](double edge) {
        const NeededEps found = find_needed_eps(body, edge);
        return std::tuple{found.longest_edge, found.eps,
                          found.eps / body.bound(found.longest_edge)};
      });
}

NamedFinding order_finding(const Body& body, const Table& range) {
  const std::string power = body.order == 2 ? "as the square of the cloth's edge length"
                                            : "in proportion to the cloth's edge length";
  return {
      "required-eps.order-is-as-derived." + body.name,
      "On the " + body.words + " the eps that is needed grows " + power + ".",
      {order_verdict(
           convergence_of(range, "eps needed"), body.order, 2, 0.01,
           "eps is found to 5e-4 of itself, which is 0.0015 of an order; the next term of "
           "sqrt(R^2 + L^2/3) - R is L^2/(12 R^2) of the first, below 0.003 in the last pairs; "
           "along an edge every scale looks alike"),
       range, "measured is |order - " + std::to_string(int(body.order)) + "| over the last pairs"}};
}

NamedFinding bound_finding(const Body& body, const Table& range) {
  const std::string bound = body.order == 2 ? "L^2/(6 R)" : "L/sqrt(3)";
  return {"required-eps.derived-eps-suffices." + body.name,
          "On the " + body.words + " an eps of " + bound + " suffices, L the longest edge.",
          judge_worst(range, 1.001,
                      "the farthest point of a triangle from its corners is L/sqrt(3) from them at "
                      "most; on a ball its depth below them is at most (L/sqrt(3))^2/(2 R). The "
                      "search may err by a thousandth")};
}

/// On a ball the bound is met in the limit of short edges, so that it holds the radius, too.
NamedFinding needed_finding(const std::vector<std::pair<std::string, Table>>& balls) {
  Table finest("body [1]; eps over L^2/(6 R) [1]; off 1 [1]");
  for (const auto& [name, range] : balls) {
    const double share = range.numbers("eps over what is always enough").back();
    finest.row(name, share, std::abs(share - 1));
  }
  return {"required-eps.balls-need-the-derived-eps",
          "On balls the eps that is needed at the shortest edges is L^2/(6 R).",
          judge_worst(std::move(finest), 0.004,
                      "eps is found to 5e-4 of itself, and the next term is below 0.003; another "
                      "power of R would be off by a factor on one of the two balls")};
}

StudyResult run_eps_needed(const Subject&, Tier tier, const Progress& progress) {
  StudyResult result;
  Figure figure{"eps",
                "The least eps that leaves no triangle inside",
                {"longest edge of the projected cloth", "m", Scale::log},
                {"eps needed", "m", Scale::log},
                "Decided exactly, triangle by triangle. Smooth bodies need L^2/(6 R); along an "
                "edge of the body eps has to grow with the cloth's edges."};
  const std::vector<Body> bodies = {ball("ball", 0.13), ball("large-ball", 0.41), box_edge()};
  std::vector<std::pair<std::string, Table>> balls;
  for (const Body& body : bodies) {
    const Table range = range_of(body, tier == Tier::quick ? 4 : 7);
    result.add({order_finding(body, range), bound_finding(body, range)});
    if (body.order == 2) balls.emplace_back(body.name, range);
    Curve curve = curve_of(body.words, convergence_of(range, "eps needed"));
    curve.slope = body.order;
    figure.curves.push_back(std::move(curve));
    progress(double(figure.curves.size()) / double(bodies.size()));
  }
  result.findings.push_back(needed_finding(balls));
  result.figures.push_back(std::move(figure));
  return result;
}

}  // namespace

Study eps_needed_study() {
  return {"required-eps",
          "The eps that keeps triangles out of a ball grows as the square of their edge length "
          "over its radius, and along an edge of a box in proportion to their edge length.",
          {"order-is-as-derived", "derived-eps-suffices", "balls-need-the-derived-eps"},
          "BMF03 section 5.3",
          "Sheets of equilateral triangles are sunk into a body and projected plainly, their "
          "particles to eps outside. The least eps is sought with which no triangle has a point in "
          "common with the body; that is decided in whole numbers, without a distance field.",
          run_eps_needed};
}

}  // namespace foldproof
