#include "convergence/validation/plane_stiffness.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "verification/specimens/probe.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

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

}  // namespace

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

}  // namespace foldproof
