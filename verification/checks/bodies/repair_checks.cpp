// Checks of the second opinions on inside and outside: ray parity, winding numbers, and the
// repair by them.
#include "reference/bodies/closed_mesh.h"
#include "reference/bodies/mesh_inspection.h"
#include "reference/bodies/ray_parity.h"
#include "reference/bodies/repair.h"
#include "reference/level_set/winding.h"
#include "reference/level_set/mesh_grid.h"
#include "reference/mesh/shapes.h"
#include "verification/specimens/check.h"
#include "verification/specimens/random.h"
#include "verification/specimens/specimens.h"
#include "verification/specimens/ugly_solids.h"

namespace foldproof {

namespace {

const GridMethod method{30, 3, 2.2, MarchingOrder::second};

TriangleSoup statue() { return soup_of(small_statue()); }

std::shared_ptr<const Grid> grid_of(const TriangleSoup& soup) {
  return make_grid(make_mesh_distance(soup.rest, soup.triangles), method);
}

Finding parity_agrees() {
  Table measured{{"case", ""}, {"nodes that are counted otherwise", "1"}};
  std::vector<std::pair<std::string, TriangleSoup>> soups{{"statue", statue()}};
  const TriangleMesh sphere = make_icosphere(1, 3);  // rays of the lattice run through its vertices
  soups.push_back({"sphere on the lattice", soup_of(sphere)});
  for (const UglySolid& solid : ugly_solids()) soups.emplace_back(solid.name, solid.soup);
  for (const auto& [name, soup] : soups) {
    const auto grid = grid_of(soup);
    const Disagreement found = disagreement(
        *grid, ray_parity(soup.rest, soup.triangles, grid->lattice), 1e-9 * grid->lattice.spacing);
    measured.row(name, double(found.with_sign.size() + found.among_rays.size()));
  }
  return judge_worst(
      measured, 0,
      "on closed surfaces all three rays and the pseudonormal answer the same question");
}

/// Reports on meshes with known defects.
Finding inspection_tells() {
  const TriangleMesh ball = make_icosphere(0.7, 3);
  TriangleSoup whole{ball.rest, ball.triangles, {}}, open = whole, flipped = whole;
  open.triangles.erase(open.triangles.begin());
  std::swap(flipped.triangles[7][0], flipped.triangles[7][1]);
  const TriangleSoup sheet{ball.rest, {ball.triangles[0]}, {}};
  const MeshInspection a = inspect_mesh(whole, 20), b = inspect_mesh(open, 20),
                       c = inspect_mesh(flipped, 20), d = inspect_mesh(sheet, 20);
  Table measured{{"case", ""}, {"what is said wrongly", "1"}};
  measured.row("a ball is a solid", !a.rejection.empty() || a.pieces != 1 || a.triangles != 1280);
  measured.row("its volume, over 1 percent",
               std::abs(a.volume / (4 * EIGEN_PI / 3 * 0.343) - 1) > 0.01);
  measured.row("no opinion differs", double(a.against_sign + a.among_rays));
  measured.row("a hole", count_missing(b.rejection, {"a hole"}) || !b.repair_failure.empty());
  measured.row("rays differ behind it", b.among_rays > b.against_sign ? 0 : 1);
  measured.row("a flipped triangle", count_missing(c.rejection, {"opposite orientation"}));
  measured.row("a triangle alone has no inside",
               count_missing(d.repair_failure, {"no inside"}) || d.nodes != 0);
  return judge_worst(measured, 0, "each defect must be reported, and no others");
}

Finding parity_shows_holes() {
  const TriangleSoup whole = statue();
  const auto grid = grid_of(whole);
  int unseen = 0;
  Worst streaks, denied, outvoting;
  for (int t = 11; t < 1280; t += 97) {
    TriangleSoup open = whole;
    open.triangles.erase(open.triangles.begin() + t, open.triangles.begin() + t + 6);
    const Disagreement found = disagreement(
        *grid, ray_parity(open.rest, open.triangles, grid->lattice), 1e-9 * grid->lattice.spacing);
    const double in_streaks = double(found.among_rays.size()),
                 with_sign = double(found.with_sign.size());
    streaks.observe(in_streaks);
    denied.observe(with_sign);
    if (found.among_rays.empty()) ++unseen;
    outvoting.observe(with_sign / std::max(in_streaks, 1.0));
  }
  Table measured{{"case", ""},
                 {"holes of six triangles that no ray reveals, and the largest share of wrong rows "
                  "that win the vote",
                  "1"}};
  measured.row("unseen", unseen);
  measured.row("share", outvoting.value());
  return judge_worst(measured, 0.25,
                     "every hole lies across at least one row of nodes, and wrong rows along two "
                     "axes share few nodes",
                     "nodes in streaks, and denied signs, of the worst hole: " +
                         std::to_string(int(streaks.value())) + ", " +
                         std::to_string(int(denied.value())));
}

Vector3 about(Random& random, const Bounds& bounds) {
  Vector3 p;
  for (int axis = 0; axis < 3; ++axis) p[axis] = random.uniform(-0.3, 1.3);
  return bounds.min() + p.cwiseProduct(bounds.sizes());
}

Finding winding_is_whole() {
  Table measured{{"case", ""}, {"deviation from 1 inside and 0 outside", "1"}};
  for (const UglySolid& solid : ugly_solids()) {
    Random random(101);
    Worst worst;
    for (int i = 0; i < 2000; ++i) {
      const Vector3 p =
          (about(random, bounds_of(solid.soup.rest)) * double(units)).array().round() /
          double(units);
      const int inside = inside_exactly(solid, p);
      if (inside == 0) continue;
      worst.observe(std::abs(winding_number(solid.soup.rest, solid.soup.triangles, p) -
                             (inside > 0 ? 1 : 0)));
    }
    measured.row(solid.name, worst.value());
  }
  return judge_worst(
      measured, 1e-8,
      "solid angles add up to full turns; seen from close to a face's plane, one of them has lost "
      "its digits to cancellation, epsilon times the squared ratio of sizes");
}

Finding tree_is_near() {
  const TriangleMesh& mesh = small_statue();
  const MeshDistance distance = make_mesh_distance(mesh.rest, mesh.triangles);
  const std::vector<Dipole> dipoles = make_dipoles(distance);
  Table measured{{"case", ""},
                 {"deviation from the sum over all triangles, times far squared", "1"}};
  std::vector<Triangle> part(mesh.triangles.begin(), mesh.triangles.end() - 200);
  const MeshDistance open = make_mesh_distance(mesh.rest, part);
  const std::vector<Dipole> open_dipoles = make_dipoles(open);
  for (const double far : {1.5, 2.0, 4.0}) {
    Random random(103);
    Worst worst;
    for (int i = 0; i < 400; ++i) {
      const Vector3 p = about(random, bounds_of(mesh.rest));
      worst.observe(std::abs(winding_number(distance, dipoles, p, far) -
                             winding_number(mesh.rest, mesh.triangles, p)));
      worst.observe(std::abs(winding_number(open, open_dipoles, p, far) -
                             winding_number(mesh.rest, part, p)));
    }
    measured.row("far = " + std::to_string(far), far * far * worst.value());
  }
  return judge_worst(measured, 0.5,
                     "the approximation omits a patch's second moment, at most its own angle times "
                     "(radius/distance)^2; the sizes of all patches' angles add up to about half "
                     "of the full turn that cancels");
}

/// Nodes on the wrong side in the repaired grid, and the mean error of the others, against the
/// whole surface.
struct Mended {
  double wrong_sides, mean_error;  // 1; cells
};

Mended compare(const Grid& truth, const Grid& mended) {
  Mended result{0, 0};
  for (size_t i = 0; i < truth.phi.size(); ++i) {
    const bool near = std::abs(truth.phi[i]) < truth.lattice.spacing;
    if (!near && (truth.phi[i] < 0) != (mended.phi[i] < 0)) ++result.wrong_sides;
    result.mean_error +=
        std::abs(truth.phi[i] - mended.phi[i]) / truth.lattice.spacing / double(truth.phi.size());
  }
  return result;
}

TriangleSoup overlapping_balls() {
  const TriangleSoup ball = soup_of(make_icosphere(0.7, 3));
  const Vector3 c(0.35, 0.02, 0.01);
  return join(join({PerParticle3(3, 0), {}, {}}, ball, -c), ball, c);
}

/// The union of the two balls' own grids on the given lattice: the minimum, exact outside.
Mended against_union(const Grid& mended) {
  Mended result{0, 0};
  long outside = 0;
  for (long i = 0; i < mended.lattice.size(); ++i) {
    const Vector3 p = mended.lattice.position(mended.lattice.node(i)), c(0.35, 0.02, 0.01);
    const double phi = std::min((p - c).norm(), (p + c).norm()) - 0.7;
    if (std::abs(phi) > mended.lattice.spacing && (phi < 0) != (mended.phi[i] < 0))
      ++result.wrong_sides;
    if (phi < 0) continue;
    ++outside;
    result.mean_error += std::abs(phi - mended.phi[i]) / mended.lattice.spacing;
  }
  result.mean_error /= double(outside);
  return result;
}

Finding repair_mends() {
  const TriangleSoup whole = statue();
  const auto truth = grid_of(whole);
  TriangleSoup open = whole, flipped = whole, inward = whole;
  for (int t = 1200; t > 0; t -= 97)
    open.triangles.erase(open.triangles.begin() + t, open.triangles.begin() + t + 2);
  for (int t = 5; t < 1280; t += 7) std::swap(flipped.triangles[t][0], flipped.triangles[t][1]);
  Table measured{{"case", ""},
                 {"twice the nodes on the wrong side more than a cell from the surface, and mean "
                  "error in tenths of a cell",
                  "1"}};
  const auto observe = [&](const std::string& name, const Mended& mended) {
    measured.row(name + ", wrong sides", 2 * mended.wrong_sides);
    measured.row(name + ", mean error", 10 * mended.mean_error);
  };
  observe("nothing to mend", compare(*truth, *make_repaired_grid(whole, method)));
  observe("thirteen holes of two triangles", compare(*truth, *make_repaired_grid(open, method)));
  observe("a seventh of the triangles flipped",
          compare(*truth, *make_repaired_grid(flipped, method)));
  observe("two balls that overlap",
          against_union(*make_repaired_grid(overlapping_balls(), method)));
  return judge_worst(measured, 1,
                     "a start from inside/outside alone leaves a mean error of 0.13 cells; exact "
                     "distances where a triangle separates the two must do better, though marching "
                     "begins in first order from a single layer of nodes");
}

}  // namespace

std::vector<Check> repair_checks() {
  return {
      {"level-set.ray-parity-agrees-with-the-sign",
       "Rays along three axes agree with the sign at every node, even through edges and vertices.",
       "ours", parity_agrees},
      {"level-set.inspection-classifies-meshes",
       "Inspecting a mesh says whether it is a solid, and if not, why; rays give a second opinion.",
       "ours", inspection_tells},
      {"level-set.ray-parity-reveals-holes",
       "Rays reveal missing triangles, and seldom outvote the right sign there.", "ours",
       parity_shows_holes},
      {"level-set.winding-number-is-an-integer",
       "The winding number of a closed surface is 1 inside and 0 outside, nested shells counted.",
       "Jacobson et al. 2013", winding_is_whole},
      {"level-set.winding-tree-error-is-bounded",
       "Approximating far patches changes the winding number by at most half over `far` squared.",
       "Barill et al. 2018", tree_is_near},
      {"level-set.repair-restores-the-distance",
       "Repair by winding number gives the solid's distance despite holes, flipped triangles and "
       "overlaps.",
       "Jacobson et al. 2013", repair_mends}};
}

}  // namespace foldproof
