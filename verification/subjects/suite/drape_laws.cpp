// A ring of cloth around a plate, as in the laboratory's drape test (Cusick 1968).

#include "verification/oracles/sheets/drape_outline.h"
#include "verification/oracles/sheets/growing_ring.h"
#include "verification/oracles/sheets/sagging_plate.h"
#include "verification/subjects/suite/laws.h"
#include "verification/subjects/suite/relaxation.h"
#include "verification/subjects/suite/strips.h"

namespace foldproof {

namespace {

using namespace suite;

/// Level.
PortableScene ring_of_cloth(const std::string& name, const oracles::GrowingRing& ring,
                            const PortableMaterial& material) {
  PortableScene scene = resting(name, make_triangle_mesh(ring.rest(), ring.triangles()), material);
  for (int i = 0; i < ring.held(); ++i) scene.held.push_back(i);
  return scene;
}

// --- a stiff ring ---

// Both meshes have the same two radii: 4.5/36 = 8.5/68.
constexpr oracles::GrowingRing coarse{36, 4, 0.26}, fine{68, 8, 0.26};
constexpr double coarse_spacing = 1 / 4.5, fine_spacing = 1 / 8.5;  // of rows, over the width
constexpr double gravity = 5.1;                                     // m/s^2
const double inner = fine.plate / fine.edge(), width = fine.edge() - fine.plate;

PortableMaterial stiff_cloth() { return {.density = 0.23, .young = 400, .bending_rigidity = 0.9}; }

/// A number and how far off it may be.
struct Measured {
  double value, error;
};

/// A solver's own plate [N m]: its rigidity to bending, and to twisting over the width,
///   T = 2 B (1 - nu).
struct Plate {
  Measured bending, twisting;

  double poisson(double B, double T) const { return 1 - T / (2 * B); }
};

constexpr StripShape narrow{6, 14, 0.03}, wide{13, 14, 0.03};

/// What a wide strip has more than a narrow one, over its width: the cloth without its edges, which
/// bear no hinges.
double of_the_middle(const std::function<double(const StripShape&)>& over_width) {
  return (over_width(wide) * wide.width() - over_width(narrow) * narrow.width()) /
         (wide.width() - narrow.width());
}

/// In half of the time, in which waves and steps change half as much at most.
Measured in_less_time(const std::function<double(double dt)>& measured) {
  constexpr double dt = 2e-5;  // s
  const double half = measured(dt / 2);
  return {half, std::abs(measured(dt) - half)};
}

Plate plate_of(Trial& trial) {
  constexpr double twist = 0.05;  // rad/m
  const PortableMaterial cloth = stiff_cloth();
  const Measured bending = in_less_time([&](double dt) {
    return of_the_middle(
        [&](const StripShape& s) { return measured_rigidity(trial, free_strip(s, cloth, dt), s); });
  });
  require_resistance("bending", bending.value, cloth.bending_rigidity);
  return {bending, in_less_time([&](double dt) {
            return of_the_middle([&](const StripShape& s) {
              return measured_twisting(trial, free_strip(s, cloth, dt), s, twist);
            });
          })};
}

/// Of the free edge of the plate [m].
double sag_of_plate(const Plate& plate, double B, double T) {
  return stiff_cloth().density * gravity * std::pow(fine.edge(), 4) / B *
         oracles::sag_of_ring_by_formula({inner, plate.poisson(B, T)}).value;
}

/// Where the width is off by a part in proportion to the rows' spacing, the sag's fourth root is,
/// too, since the sag of a narrow ring grows as the width's fourth power.
double extrapolated(double coarse_sag, double fine_sag) {
  const double a = std::pow(coarse_sag, 0.25), b = std::pow(fine_sag, 0.25);
  return std::pow(b + (b - a) * fine_spacing / (coarse_spacing - fine_spacing), 4);
}

/// How far sags may still be from the plate's after the extrapolation, as a part [1]: three times
/// as far as the worse of two discretisations that bend differently, the safety factor of Roache
/// (1994) for errors that two meshes show. Hinges bend from the rim on; the other is a plate that
/// is clamped at the second circle.
double left_by_extrapolation(double poisson) {
  const auto sag = [](double clamp, double nu) {
    return oracles::sag_of_ring_by_formula({clamp / fine.edge(), nu}).value;
  };
  const double hinges = extrapolated(sag_of_hinges(coarse), sag_of_hinges(fine)) /
                        sag(fine.plate, oracles::poisson_of_hinges),
               second = extrapolated(sag(coarse.radius(1), poisson), sag(fine.radius(1), poisson)) /
                        sag(fine.plate, poisson);
  return 3 * std::max(std::abs(hinges - 1), std::abs(second - 1));
}

/// What stretch adds to the resistance, at most [1]: U = k s^2/2 + m s^4 is least where s is
/// below its value without m by the part 4 m s^2/k. With nothing moving sideways the strain is
/// w'^2/2, w' below 1.6 s/width, and springs have 9/8 of Y; the weight's work is over a third of
/// that at the edge.
double resistance_of_stretch(double sag) {
  const double strain = std::pow(1.6 * sag / width, 2) / 2,
               stretch = 9.0 / 8 * stiff_cloth().young * strain * strain / 2,  // J/m^2
      bending = stiff_cloth().density * gravity * sag / 3 / 2;
  return 2 * stretch / bending;
}

struct Sag {
  double value, last_move;  // of the edge's mean [m]
};

Sag sag_of_ring(Trial& trial, const oracles::GrowingRing& ring) {
  PortableScene scene = ring_of_cloth(
      fmt::format("stiff ring of {} rows around a plate", ring.rows), ring, stiff_cloth());
  scene.gravity = Vector3(0, 0, -gravity);
  scene.dt = 5e-5;
  const Relaxed end = relaxed(trial, scene, {scene.x, width, 1e-8, 2.5e-4});
  return {-end.x.row(2).tail(ring.around).mean(), end.last_move};
}

Finding sags_as_a_plate(Trial& trial) {
  const Plate plate = plate_of(trial);
  const Sag on_coarse = sag_of_ring(trial, coarse), on_fine = sag_of_ring(trial, fine);
  const double sag = extrapolated(on_coarse.value, on_fine.value),
               moved = std::max(on_coarse.last_move, on_fine.last_move) / on_fine.value;
  const double B = plate.bending.value, T = plate.twisting.value, nu = plate.poisson(B, T);
  double least = sag_of_plate(plate, B, T), most = least;
  for (const double b : {B - plate.bending.error, B + plate.bending.error})
    for (const double t : {T - plate.twisting.error, T + plate.twisting.error}) {
      least = std::min(least, sag_of_plate(plate, b, t));
      most = std::max(most, sag_of_plate(plate, b, t));
    }
  const double left = left_by_extrapolation(nu);
  least *= (1 - left) * (1 - resistance_of_stretch(most)), most *= 1 + left;
  Table measured = table_of(
      "rigidity to bending [N m] | and to twisting [N m] | Poisson's ratio [1] | "
      "sag on 4 rows [m] | sag on 8 rows [m] | last move over the sag [1] | extrapolated [m] | "
      "of the plate, at least [m] | at most [m] | "
      "distance from their middle and moves, over half the range [1]");
  measured.row(B, T, nu, on_coarse.value, on_fine.value, moved, sag, least, most,
               (std::abs(sag - (least + most) / 2) + 3.3 * moved * sag) / ((most - least) / 2));
  return judge_worst(
      measured, 1,
      "half the range: both rigidities as far off as halving the time of their measurement changes "
      "them; three times (Roache's factor for two meshes) what the same extrapolation leaves of "
      "hinges, or of a plate clamped at the second circle; stretch if nothing moves sideways. What "
      "it still moves is added 3.3 times over, the most that extrapolation makes of it");
}

// --- a soft ring, under one weight and another ---

// Let x be at rest under the weight g, and y under a larger one, g'. Their elastic energies are U
// and V, their masses' mean depths below the plate a and b. If neither has more energy than the
// other under its own weight,
//   U - g M a <= V - g M b   and   V - g' M b <= U - g' M a,
// the sum is (g' - g) M (b - a) >= 0, and b = a only if U = V. The second holds since y comes to
// rest from x, and a motion that is stopped again and again only loses energy. The first fails only
// if the larger weight leads to a shape in which the cloth would have hung under the smaller one,
// too, with less energy.
constexpr oracles::GrowingRing soft_ring{36, 4, 0.19}, disc{16, 6, 0.025};
constexpr double weights[] = {6.1, 12.7, 26.3};  // m/s^2

/// A cloth for this, and how closely it comes to rest.
struct SoftCloth {
  const char* name;
  oracles::GrowingRing ring;
  double young;     // N/m
  double rigidity;  // B [N m]
  double dt;        // s
  double enough;    // as in Relaxation
};

// Under the three weights the first folds more and more; the second hangs down at once and
// stretches. The third is held at its centre, by two circles of particles.
constexpr SoftCloth folding{"soft ring around a plate", soft_ring, 300, 6.4e-4, 4e-4, 1e-2},
    limp{"limp ring around a plate", soft_ring, 12, 0, 1e-3, 2e-3},
    hung{"disc held at its centre", disc, 60, 3e-4, 2e-4, 1e-2};

/// Level, but for low waves around it.
PortableScene waved(const SoftCloth& cloth) {
  PortableScene scene =
      ring_of_cloth(cloth.name, cloth.ring,
                    {.density = 0.23, .young = cloth.young, .bending_rigidity = cloth.rigidity});
  scene.dt = cloth.dt;
  for (Eigen::Index i = cloth.ring.held(); i < scene.x.cols(); ++i) {
    const Vector3 at = scene.mesh.rest.col(i);
    scene.x(2, i) =
        0.03 * (at.norm() - cloth.ring.plate) * std::cos(7 * (std::atan2(at.y(), at.x()) - 0.1));
  }
  return scene;
}

/// Of what is free, below the plate [m].
double mean_depth(const PortableScene& scene, const PerParticle3& x) {
  const Eigen::Index free = x.cols() - Eigen::Index(scene.held.size());
  return -x.row(2).tail(free).dot(scene.mass.tail(free)) / scene.mass.tail(free).sum();
}

/// How far the mass is not below the lighter one's [m]. The last moves of shapes at rest count
/// against it where it is not lower. Where it is lower by less than they are, or where shapes still
/// move and that decides, nothing follows.
oracles::Estimate not_below(double before, double depth, double moves, bool at_rest) {
  const double most = std::max(0.0, before + moves - depth);
  if (most == 0) return {0, 0};
  if (at_rest && !(depth > before)) return {most, 0};
  return {std::max(0.0, before - depth), moves};
}

Finding heavier_hangs_lower(Trial& trial, const SoftCloth& cloth) {
  PortableScene scene = waved(cloth);
  if (const double given = cloth.rigidity; given > 0) {
    const PortableScene strip = free_strip(wide, scene.material, scene.dt);
    require_resistance("bending", measured_rigidity(trial, strip, wide, 0.5), given);
  }
  const oracles::DrapeRadii radii{cloth.ring.edge(), cloth.ring.plate};
  const double hangs = radii.specimen - radii.plate, still = cloth.enough * hangs;  // m
  Table measured = table_of(
      "gravity [m/s^2] | drape coefficient [1] | mean depth [m] | last move [m] | "
      "not below the lighter one [m]");
  double before = 0, moved_before = 0;  // level
  for (const double gravity : weights) {
    scene.gravity = Vector3(0, 0, -gravity);
    const Relaxed end = relaxed(trial, scene, {scene.mesh.rest, hangs, cloth.enough, 4e-3});
    scene.x = end.x, scene.dt = end.dt;
    const double depth = mean_depth(scene, end.x);
    const oracles::Outline outline =
        oracles::outline_of(end.x, scene.mesh.triangles, radii.plate, 720);
    measured.row(gravity, oracles::drape_coefficient(outline, radii), depth, end.last_move,
                 not_below(before, depth, moved_before + end.last_move,
                           std::max(moved_before, end.last_move) <= still));
    before = depth, moved_before = end.last_move;
  }
  return judge_worst(measured, 0,
                     "of two shapes, each of less energy than the other under its own weight, the "
                     "heavier one's mass lies lower; inconclusive where the difference is less "
                     "than the last moves, or where a shape still moves after 24 rounds");
}

}  // namespace

std::vector<Law> drape_laws() {
  return {
      {"drape.stiff-ring-sags-as-a-plate",
       "A stiff ring of cloth around a plate sags at its edge as a plate of the solver's own "
       "rigidities to bending and twisting does.",
       "Kirchhoff's plate, clamped at the rim and free at the edge", sags_as_a_plate,
       "L1 held bending", "extrapolated | of the plate, at least | at most"},
      {"drape.heavier-ring-hangs-lower",
       "The heavier a ring of cloth around a plate is, the lower its mass hangs.",
       "least energy under two weights",
       [](Trial& trial) { return heavier_hangs_lower(trial, folding); }, "L1 held bending"},
      {"drape.heavier-limp-ring-hangs-lower",
       "The heavier a ring of cloth without bending rigidity is, the lower its mass hangs around a "
       "plate.",
       "least energy under two weights",
       [](Trial& trial) { return heavier_hangs_lower(trial, limp); }, "L1 held"},
      {"drape.heavier-disc-hangs-lower",
       "The heavier a disc of cloth that is held at its centre is, the lower its mass hangs.",
       "least energy under two weights",
       [](Trial& trial) { return heavier_hangs_lower(trial, hung); }, "L1 held bending"},
  };
}

}  // namespace foldproof
