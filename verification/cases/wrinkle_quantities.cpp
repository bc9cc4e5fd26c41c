// Quantities of wrinkles at the end of a run. A crease is a line of hinges, each turned to the same
// side and joined to the next by a particle; a wrinkle has one to either side.
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "verification/cases/quantities.h"

namespace foldproof {

namespace {

constexpr double least_turn = 20 * pi / 180;  // away from the rest angle, of a hinge in a crease
constexpr int least_hinges = 3;               // in a crease

/// Sets of particles that edges join.
class Joined {
 public:
  explicit Joined(int particles) : parent_(size_t(particles)) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  int set_of(int i) {
    while (parent_[size_t(i)] != i) i = parent_[size_t(i)] = parent_[size_t(parent_[size_t(i)])];
    return i;
  }
  void join(int a, int b) { parent_[size_t(set_of(a))] = set_of(b); }

 private:
  std::vector<int> parent_;
};

/// The creases to one side.
struct Creases {
  int count = 0;
  std::vector<Vector3> places;  // of their hinges' middles at rest [m]
};

/// side: 1 or -1, the sign of their turns.
Creases creases_of(const Scene& scene, const PerParticle3& x, int side) {
  const std::vector<double> angles = hinge_angles(scene.mesh, x);
  const std::vector<Hinge>& hinges = scene.mesh.hinges;
  Joined joined(scene.mesh.particles());
  std::vector<size_t> turned;
  for (size_t h = 0; h < hinges.size(); ++h) {
    if (!(side * std::remainder(angles[h] - scene.rest_angles[h], 2 * pi) > least_turn)) continue;
    turned.push_back(h);
    joined.join(hinges[h].particles[2], hinges[h].particles[3]);
  }
  std::vector<int> hinges_of(size_t(scene.mesh.particles()), 0);
  for (const size_t h : turned) ++hinges_of[size_t(joined.set_of(hinges[h].particles[2]))];
  Creases creases;
  for (const int count : hinges_of) creases.count += count >= least_hinges;
  for (const size_t h : turned) {
    const int a = hinges[h].particles[2], b = hinges[h].particles[3];
    if (hinges_of[size_t(joined.set_of(a))] >= least_hinges)
      creases.places.push_back((scene.mesh.rest.col(a) + scene.mesh.rest.col(b)) / 2);
  }
  return creases;
}

double creases_at_end(const RunView& run) {
  const PerParticle3& x = run.result.last.x;
  if (!x.allFinite()) return std::numeric_limits<double>::quiet_NaN();
  return creases_of(run.scene, x, 1).count + creases_of(run.scene, x, -1).count;
}

/// Twice the mean straight distance, in the rest shape, from a hinge in a crease to the nearest
/// hinge in a crease to the other side [m]; NaN if there are none to one of them.
double wavelength_at_end(const RunView& run) {
  const Creases ridges = creases_of(run.scene, run.result.last.x, 1),
                valleys = creases_of(run.scene, run.result.last.x, -1);
  if (ridges.count == 0 || valleys.count == 0) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0;
  const auto add_ways = [&](const std::vector<Vector3>& from, const std::vector<Vector3>& to) {
    for (const Vector3& place : from) {
      double least = std::numeric_limits<double>::infinity();
      for (const Vector3& other : to) least = std::min(least, (other - place).norm());
      sum += least;
    }
  };
  add_ways(ridges.places, valleys.places);
  add_ways(valleys.places, ridges.places);
  return 2 * sum / double(ridges.places.size() + valleys.places.size());
}

}  // namespace

std::vector<Quantity> wrinkle_quantities() {
  return {
      {"forms_creases", "1",
       "At the end there are this many creases: lines of at least three hinges, each folded by "
       "over 20 degrees to the same side.",
       Sense::at_least, Scope::this_shape, nullptr, creases_at_end, without_bending},
      {"wrinkles_stay_short", "m",
       "At the end wrinkles are at most this long: twice the mean straight distance, in the rest "
       "shape, from a hinge in a crease to the nearest hinge in a crease of the opposite side.",
       Sense::at_most, Scope::this_shape, nullptr, wavelength_at_end, without_bending},
  };
}

}  // namespace foldproof
