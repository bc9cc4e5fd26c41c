// Checks of fast marching and of its crude initial values.
#include <stdexcept>

#include "reference/level_set/fast_marching.h"
#include "verification/specimens/check.h"

namespace foldproof {

namespace {

const Lattice lattice_of_planes{{-0.6, -0.5, -0.7}, 0.05, {25, 21, 29}};
const Vector3 oblique = Vector3(2, -3, 6) / 7;

std::string name_of(MarchingOrder order) {
  return order == MarchingOrder::first ? "first order" : "second order";
}

bool is_border(const Lattice& lattice, const Node& node) {
  for (int axis = 0; axis < 3; ++axis)
    if (node[axis] == 0 || node[axis] == lattice.nodes[axis] - 1) return true;
  return false;
}

Seeds seeds_where(const Lattice& lattice, const std::function<double(const Vector3&)>& phi,
                  const std::function<bool(const Node&, double)>& known) {
  Seeds seeds;
  for (long i = 0; i < lattice.size(); ++i) {
    const Node node = lattice.node(i);
    const double value = phi(lattice.position(node));
    if (!known(node, value)) continue;
    seeds.nodes.push_back(i);
    seeds.phi.push_back(value);
  }
  return seeds;
}

/// Seeds within two cells of a surface.
Seeds band(const Lattice& lattice, const std::function<double(const Vector3&)>& phi) {
  return seeds_where(lattice, phi, [&](const Node&, double value) {
    return std::abs(value) < 2.2 * lattice.spacing;
  });
}

Lattice about_unit_ball() {
  return lattice_about(Bounds(Vector3::Constant(-1), Vector3::Constant(1)), 30, 4);
}

/// Upwind differences of either order are exact on a plane if no characteristic enters through the
/// border: the border's nodes are seeds, which prevents this.
Finding planes_are_exact() {
  const Lattice& lattice = lattice_of_planes;
  Table measured = roundings_of("times the lattice's size");
  for (const MarchingOrder order : {MarchingOrder::first, MarchingOrder::second}) {
    for (const Vector3& normal : {oblique, Vector3(0, 1, 0)}) {
      const auto plane = [&](const Vector3& p) { return normal.dot(p) - 0.031; };
      const Grid grid = march(lattice,
                              seeds_where(lattice, plane,
                                          [&](const Node& node, double value) {
                                            return std::abs(value) < 2.2 * lattice.spacing ||
                                                   is_border(lattice, node);
                                          }),
                              order);
      Worst worst;
      for (long i = 0; i < lattice.size(); ++i)
        worst.observe(std::abs(grid.phi[i] - plane(lattice.position(lattice.node(i)))) / epsilon);
      measured.row(name_of(order) + (normal.x() > 0 ? ", oblique" : ", along an axis"),
                   worst.value());
    }
  }
  return judge_worst(measured, 200,
                     "distances up to 0.9 are reached over at most thirty nodes, each with a "
                     "square root whose few roundings add to those of the nodes before it");
}

/// |grad phi|^2 - 1 by first-order upwind differences of the finished grid.
double residual(const Grid& grid, long index) {
  const Node node = grid.lattice.node(index);
  const double distance = std::abs(grid.phi[index]);
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const long stride = grid.lattice.strides()[axis];
    double nearest = distance;
    if (node[axis] > 0) nearest = std::min(nearest, std::abs(grid.phi[index - stride]));
    if (node[axis] + 1 < grid.lattice.nodes[axis])
      nearest = std::min(nearest, std::abs(grid.phi[index + stride]));
    sum += std::pow((distance - nearest) / grid.lattice.spacing, 2);
  }
  return sum - 1;
}

double torus_phi(const Vector3& p) { return Torus{0.61, 0.23}.at(p).phi; }

Finding equation_is_solved() {
  const Lattice lattice = about_unit_ball();
  Table measured = roundings_of("phi/h");
  for (const double radius : {0.71, 0.93}) {
    const auto sphere = [&](const Vector3& p) { return p.norm() - radius; };
    const Seeds seeds = band(lattice, sphere);
    const Grid grid = march(lattice, seeds, MarchingOrder::first);
    std::vector<char> is_seed(lattice.size(), 0);
    for (const long seed : seeds.nodes) is_seed[seed] = 1;
    Worst worst;
    for (long i = 0; i < lattice.size(); ++i)
      if (!is_seed[i])
        worst.observe(std::abs(residual(grid, i)) /
                      (epsilon * (1 + std::abs(grid.phi[i])) / lattice.spacing));
    measured.row("sphere of radius " + std::to_string(radius), worst.value());
  }
  return judge_worst(measured, 64,
                     "the root of a quadratic in T with a few roundings; differences of "
                     "neighbouring distances are divided by h");
}

/// Nodes on the wrong side of a plane through nodes that count as inside; these and the layer above
/// are the seeds.
int wrong_below_the_plane() {
  const Lattice& lattice = lattice_of_planes;
  constexpr int level = 14;
  Seeds seeds;
  for (long i = 0; i < lattice.size(); ++i) {
    const int above = lattice.node(i)[2] - level;
    if (above != 0 && above != 1) continue;
    seeds.nodes.push_back(i);
    seeds.phi.push_back(above == 0 ? -0.0 : lattice.spacing);
  }
  const Grid grid = march(lattice, seeds, MarchingOrder::first);
  int wrong = 0;
  for (long i = 0; i < lattice.size(); ++i) {
    const int above = lattice.node(i)[2] - level;
    if (above < 0 ? !(grid.phi[i] < 0) : above > 0 && !(grid.phi[i] > 0)) ++wrong;
  }
  return wrong;
}

Finding sides_are_kept() {
  const Lattice lattice = about_unit_ball();
  Table measured{{"case", ""},
                 {"nodes of the wrong sign, not finite, or seeds with another value", "1"}};
  for (const MarchingOrder order : {MarchingOrder::first, MarchingOrder::second}) {
    for (const bool torus : {false, true}) {
      const auto phi = [&](const Vector3& p) { return torus ? torus_phi(p) : p.norm() - 0.77; };
      const Seeds seeds = band(lattice, phi);
      const Grid grid = march(lattice, seeds, order);
      int wrong = 0;
      for (long i = 0; i < lattice.size(); ++i) {
        const double exact = phi(lattice.position(lattice.node(i)));
        if (!(exact < 0 ? grid.phi[i] < 0 : grid.phi[i] >= 0) || !std::isfinite(grid.phi[i]))
          ++wrong;
      }
      for (size_t k = 0; k < seeds.nodes.size(); ++k)
        if (grid.phi[seeds.nodes[k]] != seeds.phi[k]) ++wrong;
      measured.row(name_of(order) + (torus ? ", torus" : ", sphere"), wrong);
    }
  }
  measured.row("plane through nodes that count as inside", wrong_below_the_plane());
  return judge_worst(measured, 0,
                     "signs spread from the seeds only, and seeds are never recomputed");
}

/// Sides from a plane's own values: crossings along the axes define the plane, and the distance to
/// it is exact.
Finding crossings_are_exact() {
  const Lattice& lattice = lattice_of_planes;
  const auto plane = [&](const Vector3& p) { return oblique.dot(p) - 0.031; };
  std::vector<float> side, crude;
  for (long i = 0; i < lattice.size(); ++i) {
    side.push_back(float(plane(lattice.position(lattice.node(i)))));
    crude.push_back(side.back() < 0 ? -1.f : 1.f);
  }
  Worst fine, half;
  const Seeds seeds = seeds_from_sides(lattice, side), coarse = seeds_from_sides(lattice, crude);
  int inner = 0;
  for (size_t k = 0; k < seeds.nodes.size(); ++k) {
    const Node node = lattice.node(seeds.nodes[k]);
    const double exact = plane(lattice.position(node));
    // crossings along all three axes, none beyond the border
    const bool all = std::abs(exact) < lattice.spacing * oblique.cwiseAbs().minCoeff();
    if (is_border(lattice, node) || !all) continue;
    ++inner;
    fine.observe(std::abs(seeds.phi[k] - exact) / lattice.spacing);
    half.observe(std::abs(std::abs(coarse.phi[k]) / lattice.spacing - 0.5 / std::sqrt(3.0)));
  }
  Table measured{{"case", ""}, {"error", "cells"}};
  measured.row("plane from its own values", fine.value());
  measured.row("plus and minus one: half a cell along each axis", half.value());
  measured.row("no node was looked at", inner > 100 ? 0 : 1);
  return judge_worst(measured, 2e-4,
                     "values are kept as float, 6e-8 of 1.1, which near a crossing is divided by "
                     "the cell's share of phi, and again where crossings lie near the node");
}

/// Number of misuses, out of three, that are not refused.
Finding misuse_is_rejected() {
  const Lattice lattice = about_unit_ball();
  Table measured{{"case", ""}, {"not refused", "1"}};
  const auto rejected = [](const std::function<void()>& act) {
    try {
      act();
    } catch (const std::exception&) {
      return 0;
    }
    return 1;
  };
  measured.row("no seeds", rejected([&] { march(lattice, {}, MarchingOrder::first); }));
  measured.row(
      "seeds that let inside meet outside", rejected([&] {
        const auto sphere = [](const Vector3& p) { return p.norm() - 0.77; };
        const Seeds gappy = seeds_where(lattice, sphere, [&](const Node& node, double value) {
          return std::abs(value) < 2.2 * lattice.spacing && (node[2] > 12 || node[1] > 12);
        });
        march(lattice, gappy, MarchingOrder::first);
      }));
  measured.row("a lattice of three cells", rejected([&] {
                 lattice_about(Bounds(Vector3::Constant(-1), Vector3::Constant(1)), 3, 2);
               }));
  return judge_worst(measured, 0, "each would give a field that is no distance");
}

}  // namespace

std::vector<Check> marching_checks() {
  return {{"level-set.marching-is-exact-on-planes",
           "Fast marching of both orders gives the distance to a plane, to rounding.",
           "Sethian 1999", planes_are_exact},
          {"level-set.marching-solves-the-eikonal-equation",
           "After first-order marching the upwind differences of every node give |grad phi| = 1, "
           "to rounding.",
           "BMF03 section 5.1", equation_is_solved},
          {"level-set.marching-preserves-signs",
           "Marching does not change its seeds and gives every node the right sign.",
           "BMF03 section 5.1", sides_are_kept},
          {"level-set.seeds-from-crossings-recover-the-plane",
           "Seeds from inside/outside lie at the distance of the plane through the crossings along "
           "the axes.",
           "ours", crossings_are_exact},
          {"level-set.misuse-of-marching-is-rejected",
           "A start without seeds, seeds that let inside meet outside, and too coarse a lattice "
           "are refused.",
           "ours", misuse_is_rejected}};
}

}  // namespace foldproof
