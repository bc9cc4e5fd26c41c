// lateral-buckling: a ribbon on edge, clamped at one end, tips sideways under its own weight.
#include <Eigen/SparseCholesky>

#include <numbers>
#include <numeric>
#include <stdexcept>

#include "convergence/study.h"
#include "convergence/validation/comparison.h"
#include "reference/mesh/shapes.h"
#include "verification/oracles/chains_and_ribbons.h"
#include "verification/oracles/homogenised_bending.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

struct Tipping {
  double load;        // of the scene's gravity [1]
  PerParticle mode;   // displacements along z at that load, N; the largest is 1
  double unfinished;  // relative change of the load in the last turn [1]
};

using Sparse = Eigen::SparseMatrix<double>;
using Factors = Eigen::SimplicialLDLT<Sparse>;

/// Particles in the order of x, those that are free numbered, and in colours: two of a colour are
/// so far apart that none feels both.
struct FlatParticles {
  const PerParticle3& rest;
  double reach;
  std::vector<int> by_x;
  std::vector<int> number;  // -1: held
  int free = 0;
  std::vector<std::vector<int>> colours;

  FlatParticles(const Scene& scene, double reach_of_forces)
      : rest(scene.mesh.rest), reach(reach_of_forces), number(size_t(scene.mesh.particles()), 0) {
    for (const PrescribedParticle& held : scene.prescribed) number[size_t(held.particle)] = -1;
    by_x.resize(number.size());
    std::iota(by_x.begin(), by_x.end(), 0);
    std::ranges::stable_sort(by_x, {}, [&](int i) { return rest(0, i); });
    for (const int i : by_x) {
      if (number[size_t(i)] < 0) continue;
      number[size_t(i)] = free++;
      const auto fits = std::ranges::find_if(colours, [&](const std::vector<int>& colour) {
        return rest(0, i) - rest(0, colour.back()) > 2.01 * reach;
      });
      if (fits == colours.end())
        colours.push_back({i});
      else
        fits->push_back(i);
    }
  }

  /// Calls visit(i) for all free particles that may feel j.
  template <class Visit>
  void near(int j, const Visit& visit) const {
    const auto at = [&](int i) { return rest(0, i); };
    auto i = std::ranges::lower_bound(by_x, rest(0, j) - 1.005 * reach, {}, at);
    for (; i != by_x.end() && at(*i) < rest(0, j) + 1.005 * reach; ++i)
      if (number[size_t(*i)] >= 0) visit(*i);
  }
};

/// Minus the derivative of forces along the axes by places along them; degrees of freedom particle
/// by particle. Each place moves by `shift` [m] to either side.
Sparse stiffness(const Probe& probe, const FlatParticles& particles, const PerParticle3& x,
                 const std::vector<int>& axes, double shift) {
  std::vector<Eigen::Triplet<double>> entries;
  const int n = int(axes.size());
  const auto forces = [&](const std::vector<int>& colour, int axis, double by) {
    PerParticle3 moved = x;
    for (const int j : colour) moved(axis, j) += by;
    return probe.elastic(resting_state(std::move(moved)));
  };
  for (const std::vector<int>& colour : particles.colours)
    for (int a = 0; a < n; ++a) {
      const int axis = axes[size_t(a)];
      // 12 shift f' = 8 (f(shift) - f(-shift)) - (f(2 shift) - f(-2 shift)), to fourth order
      const PerParticle3 change =
          8 * (forces(colour, axis, shift) - forces(colour, axis, -shift)) -
          (forces(colour, axis, 2 * shift) - forces(colour, axis, -2 * shift));
      for (const int j : colour)
        particles.near(j, [&](int i) {
          for (int b = 0; b < n; ++b)
            entries.emplace_back(n * particles.number[size_t(i)] + b,
                                 n * particles.number[size_t(j)] + a,
                                 -change(axes[size_t(b)], i) / (12 * shift));
        });
    }
  Sparse K(n * particles.free, n * particles.free);
  K.setFromTriplets(entries.begin(), entries.end());
  return (K + Sparse(K.transpose())) / 2;
}

void require_factors(const Factors& factors) {
  if (factors.info() != Eigen::Success)
    throw std::runtime_error("tipping_of: the unloaded sheet is not held");
}

/// Displacements in the plane under the scene's gravity, 3 x N [m].
PerParticle3 displacements_in_plane(const Probe& probe, const FlatParticles& particles,
                                    double shift) {
  const PerParticle3& rest = particles.rest;
  const Factors factors(stiffness(probe, particles, rest, {0, 1}, shift));
  require_factors(factors);
  const PerParticle3 load = probe.elastic(resting_state(rest));
  Eigen::VectorXd right(2 * particles.free);
  PerParticle3 u = PerParticle3::Zero(3, rest.cols());
  const auto number = [&](Eigen::Index i) { return particles.number[size_t(i)]; };
  for (Eigen::Index i = 0; i < rest.cols(); ++i)
    if (number(i) >= 0) right.segment<2>(2 * number(i)) = load.col(i).head<2>();
  const Eigen::VectorXd solved = factors.solve(right);
  for (Eigen::Index i = 0; i < rest.cols(); ++i)
    if (number(i) >= 0) u.col(i).head<2>() = solved.segment<2>(2 * number(i));
  return u;
}

/// The largest change of length of an edge, over its length.
double largest_strain(const TriangleMesh& mesh, const PerParticle3& u) {
  double largest = 0;
  for (const Edge& edge : mesh.edges) {
    const Vector3 d = mesh.rest.col(edge.b) - mesh.rest.col(edge.a);
    const Vector3 change = u.col(edge.b) - u.col(edge.a);
    largest = std::max(largest, std::abs(change.dot(d)) / d.squaredNorm());
  }
  return largest;
}

/// The smallest load > 0 with K v = -load G v, where -load is one, too, and v.
struct SmallestLoad {
  double load, change;
  Eigen::VectorXd mode;
};

SmallestLoad smallest_load(const Sparse& K, const Sparse& G) {
  const Factors factors(K);
  require_factors(factors);
  const auto once = [&](const Eigen::VectorXd& v) -> Eigen::VectorXd {
    return factors.solve(-(G * v));
  };
  // power iteration with the square of K^-1 G: its largest is 1/load^2, and the signs merge
  Eigen::VectorXd v = Eigen::VectorXd::LinSpaced(K.rows(), 0, 1).array().square();
  for (Eigen::Index i = 0; i < v.size(); ++i) v[i] += 1e-3 * std::sin(37.0 * double(i));
  SmallestLoad found{0, 1, {}};
  for (int turn = 0; turn < 60 && found.change > 1e-10; ++turn) {
    v /= std::sqrt(v.dot(K * v));
    const Eigen::VectorXd next = once(once(v));
    const double load = 1 / std::sqrt(v.dot(K * next));
    found.change = std::abs(load / found.load - 1);
    found.load = load;
    v = next;
  }
  v += found.load * once(v);  // leaves the mode of the positive load
  found.mode = v / v.cwiseAbs().maxCoeff();
  return found;
}

/// A long flat sheet at rest in the plane z = 0, with gravity in that plane, held where the scene
/// prescribes particles. With K the stiffness along z, u the displacements in the plane under the
/// load 1, and small t, the sheet leaves its plane at the load where
///   K(rest) + load (K(rest + t u) - K(rest - t u))/(2 t)
/// first becomes singular. Stiffnesses are central differences of forces; many particles move at
/// once. reach [m]: along x, no particle feels one farther away. A load and its opposite must tip
/// the sheet alike, as they do if it is its own mirror image across its width.
Tipping tipping_of(const Subject& subject, const Scene& scene, double reach) {
  const Probe probe(subject, scene);
  const FlatParticles particles(scene, reach);
  const PerParticle3& rest = scene.mesh.rest;
  // long ribbons bend in their plane a hundred million times as easily as they stretch: the shift
  // is the one that loses least, of a rounding over it and its fourth power
  const PerParticle3 u = displacements_in_plane(probe, particles, 5e-4 * reach);
  const double t = 1e-5 / largest_strain(scene.mesh, u), shift = 1e-7 * reach;
  const auto across = [&](const PerParticle3& x) {
    return stiffness(probe, particles, x, {2}, shift);
  };
  const Sparse G = (across(rest + t * u) - across(rest - t * u)) / (2 * t);
  const SmallestLoad found = smallest_load(across(rest), G);
  Tipping tipping{found.load, PerParticle::Zero(rest.cols()), found.change};
  for (Eigen::Index i = 0; i < rest.cols(); ++i)
    if (particles.number[size_t(i)] >= 0) tipping.mode[i] = found.mode[particles.number[size_t(i)]];
  return tipping;
}

constexpr double resolution = 0.02;  // of the load [1]
constexpr double edge = 0.013;       // m
constexpr double ke = 0.0017;        // J
constexpr double density = 0.23;     // kg/m^2

// an isotropic sheet's Poisson ratio in the benchmark of Romero et al. 2021
constexpr double isotropic_poisson = 0.3;

double width_of(int rows) { return rows * edge * std::numbers::sqrt3 / 2; }

/// Equilateral triangles with rows of edges along x, on edge: gravity along its width.
struct Ribbon {
  Scene scene;
  double length;  // from the clamp [m]
};

Ribbon ribbon_of(int rows, int slenderness) {
  const int columns = int(std::lround(slenderness * width_of(rows) / edge)) + 1;
  Ribbon ribbon{
      scene_at_rest(make_sheet({SheetPattern::equilateral, columns * edge, 0, columns, rows}),
                    density),
      0};
  Scene& scene = ribbon.scene;
  add_flat_hinges(scene, ke, 0);
  scene.stretch = StretchMaterial{1e6 * ke / (edge * edge), 0, 1};
  scene.gravity = Vector3(0, -1, 0);
  // even rows are held at 0 and 1 edge, odd ones at 0, 1/2 and 3/2: clamped halfway between the
  // last two on average, three quarters of an edge from the end
  for (int i = 0; i < scene.mesh.particles(); ++i)
    if (scene.mesh.rest(0, i) < 1.6 * edge)
      scene.prescribed.push_back({i, scene.mesh.rest.col(i), Motion{}});
  ribbon.length = (columns - 0.75) * edge;
  return ribbon;
}

/// A ribbon that tips, with its load as rho_A g L^3/(ke/4).
struct TippedRibbon {
  double gamma, unfinished;
  Curve mode;  // twist over the distance from the clamp
};

TippedRibbon tipped(const Subject& subject, int rows, int slenderness) {
  const Ribbon ribbon = ribbon_of(rows, slenderness);
  const Tipping tipping = tipping_of(subject, ribbon.scene, 2 * edge);
  TippedRibbon result{density * tipping.load * std::pow(ribbon.length, 3) / (ke / 4),
                      tipping.unfinished,
                      {fmt::format("simulated, {} rows", rows)}};
  // twist: the difference of the upper and the lower border, which are alike where rows is even
  const PerParticle3& rest = ribbon.scene.mesh.rest;
  const double top = width_of(rows), clamp = 0.75 * edge;
  std::vector<std::array<double, 2>> upper, lower;
  for (Eigen::Index i = 0; i < rest.cols(); ++i) {
    const double across = rest(1, i);
    if (across < 0.1 * edge) lower.push_back({rest(0, i), tipping.mode[i]});
    if (across > top - 0.1 * edge) upper.push_back({rest(0, i), tipping.mode[i]});
  }
  const std::size_t stride = std::max<std::size_t>(upper.size() / 40, 1);
  const double tip = upper.back()[1] - lower.back()[1];
  for (std::size_t k = 0; k < upper.size(); k += stride)
    result.mode.point((upper[k][0] - clamp) / ribbon.length, (upper[k][1] - lower[k][1]) / tip);
  return result;
}

/// rho_A g L^3/(ke/4) at which a ribbon of these rigidities (over ke [m]) tips.
oracles::Estimate load_of(const oracles::RibbonRigidity& rigidity, double width) {
  const oracles::Estimate q = oracles::tipping_load_by_series();
  const double factor = 4 * std::sqrt(rigidity.bending * rigidity.twisting) / width;
  return {factor * q.value, factor * (q.uncertainty + 1e-12 * q.value)};
}

/// Of an isotropic sheet whose rigidity D is ke/4.
double isotropic_load(double poisson) {
  return load_of({(1 - poisson * poisson) / 4, (1 - poisson) / 2}, 1).value;
}

/// Ribbons of so many rows, longer and longer.
Comparison compare_ribbons(const Subject& subject, int rows, Tier tier, StudyResult& result) {
  std::vector<int> slenderness{40, 80, 160};
  if (tier == Tier::full) slenderness.push_back(320);
  Ladder loads;
  loads.formal_order = 1;  // at the clamp the ribbon cannot warp, over a length like its width
  Table levels{{"length over width", "1"}, {"rho_A g L^3/D", "1"}};
  for (const int ratio : slenderness) {
    const TippedRibbon ribbon = tipped(subject, rows, ratio);
    loads.values.push_back(ribbon.gamma);
    update_worst(loads.floor, ribbon.unfinished * ribbon.gamma);
    levels.row(ratio, ribbon.gamma);
    if (ratio == slenderness.back()) result.figures[0].curves.push_back(ribbon.mode);
  }
  const oracles::Estimate should = load_of(oracles::equilateral_ribbon(edge, rows), width_of(rows));
  result.tables.push_back(
      {fmt::format("{}-rows", rows), fmt::format("Ribbons of {} rows of triangles", rows), levels});
  return compare_ladder("rho_A g L^3/D", loads, should);
}

NamedFinding load_agrees(const Comparison& ribbons, int rows) {
  const double scale = resolution * ribbons.should.value;
  return {
      fmt::format("lateral-buckling.load-agrees.{}-rows", rows),
      fmt::format(
          "A ribbon of {} rows of equilateral triangles, on edge, tips under the weight that the "
          "theory of narrow ribbons gives for the mesh's own rigidities, within two percent.",
          rows),
      judge_comparison(ribbons, scale, "two percent of the load",
                       "S at the longest ribbon; D = ke/4")};
}

NamedFinding isotropic_differs(const Comparison& widest) {
  const double isotropic = isotropic_load(isotropic_poisson);
  // a load that is not positive is no load to divide by
  const double simulated = widest.simulated > 0 ? widest.simulated : nan;
  Table table = no_comparisons("1");
  add_comparison(
      table, {"rho_A g L^3/D", widest.simulated, widest.numerical, {isotropic, 1e-11 * isotropic}},
      resolution * isotropic);
  return {"lateral-buckling.isotropic-sheet-differs",
          "A ribbon of equilateral hinges tips later than one of an isotropic sheet with the same "
          "rigidity D and Poisson's ratio 0.3, by more than two percent.",
          {{isotropic / simulated, 1 / (1 + resolution),
            isotropic / simulated * combined_uncertainty(widest) / simulated, "1",
            "the isotropic sheet's load over the simulated one: beyond the resolution, since the "
            "hinges' own Poisson ratio is -1/3, which stiffens twist"},
           std::move(table),
           "a larger D cannot make up for it: bending and twist need different factors"}};
}

Figure mode_figure() {
  Figure figure{"modes",
                "How a ribbon on edge tips over",
                {"distance from the clamp over L", "1"},
                {"twist over the free end's", "1"},
                "The mode of the longest ribbons beside the theory's, a power series."};
  figure.curves = {curve_over("narrow ribbon", linear_range(0, 1, 101),
                              [](double place) { return oracles::tipping_twist(1 - place); })};
  return figure;
}

StudyResult run_lateral_buckling(const Subject& subject, Tier tier, const Progress& progress) {
  StudyResult result;
  result.figures.push_back(mode_figure());
  for (const int rows : {2, 4}) {
    const Comparison ribbons = compare_ribbons(subject, rows, tier, result);
    result.findings.push_back(load_agrees(ribbons, rows));
    if (rows == 4) result.findings.push_back(isotropic_differs(ribbons));
    progress(rows / 4.0);
  }
  return result;
}

}  // namespace

Study lateral_buckling_study() {
  return {"lateral-buckling",
          "A ribbon on edge tips under its weight when the theory of narrow ribbons says so, with "
          "the bending and twisting rigidities of its mesh; an isotropic sheet tips earlier.",
          {"load-agrees", "isotropic-sheet-differs"},
          "Romero et al. 2021 for the test; Timoshenko for the load",
          "A ribbon is clamped with its width upright. Forces along its normal give its stiffness "
          "against leaving the plane, at rest and under the tensions that its weight makes in the "
          "plane; the load is sought at which that stiffness vanishes. S is that of the longest of "
          "three ribbons (four in the full tier), 40, 80, 160 times as long as wide; near the "
          "clamp a ribbon cannot warp, which counts in inverse proportion to its length. D is the "
          "theory of narrow ribbons, by a power series that a check holds against GSL, with "
          "bending and twisting rigidity of just this ribbon of triangles from the definition of a "
          "hinge: with two rows they are already those of an endless sheet.",
          run_lateral_buckling,
          "validation"};
}

}  // namespace foldproof
