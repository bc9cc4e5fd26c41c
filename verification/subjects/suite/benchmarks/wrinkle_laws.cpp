// Wrinkles of a sheet that is stretched one way and compressed across.
#include <numbers>

#include "verification/subjects/suite/laws.h"
#include "verification/subjects/suite/strips.h"

namespace foldproof {

namespace {

using namespace suite;

// All of its border is held. A wave w = a(t) sin(kx x) sin(ky y) bends it and meets its stresses:
//   density a'' = -(B k^4 + Tx kx^2 + Ty ky^2) a,   k^2 = kx^2 + ky^2.
// Under the compression -Tx the waves grow for which that is negative: first, in a long sheet,
// those of the wavelength 2 pi^(1/2) (B/Ty)^(1/4) L^(1/2). A border of triangles without neighbours
// beyond it does not resist turning.
constexpr StripShape sheet{24, 28, 0.025};
constexpr double given = 2.25e-5;                       // B of the scene [N m]
constexpr double strain_x = -0.0063, strain_y = 0.011;  // 1
constexpr double steepest = 0.01;                       // slope of all waves together, at most [1]
constexpr int waves = 4;             // asked: this many halves along x, and fewer
constexpr double dt = 1e-3;          // s
constexpr long steps_of_stress = 3;  // in 3 ms waves come 0.015 m far

PortableScene flat_sheet() {
  return free_strip(sheet, {.young = 5, .bending_rigidity = given}, dt);
}

/// Evenly strained.
PortableScene strained_sheet() {
  PortableScene scene = flat_sheet();
  scene.name = "stretched sheet, let go";
  scene.x.row(0) *= 1 + strain_x;
  scene.x.row(1) *= 1 + strain_y;
  return scene;
}

/// Over its rest shape: a half wave from border to border along y, some along x.
struct Wave {
  int halves;  // along x

  double kx() const { return halves * std::numbers::pi / sheet.width(); }  // 1/m
  double ky() const { return std::numbers::pi / sheet.length(); }
  double k2() const { return kx() * kx() + ky() * ky(); }

  double at(const Vector3& rest) const {
    return std::sin(kx() * rest.x()) * std::sin(ky() * (rest.y() + sheet.length() / 2));
  }
  double height() const { return steepest / waves / std::sqrt(k2()); }  // m, at the start
};

/// Momentum of the half beyond the middle of a free, evenly strained sheet, by which the stress
/// across is known, over the stretch along it: what straightens a wave [N/m].
double tension(const PortableScene& scene, const PerParticle3& v, int axis, double strain) {
  const double middle = scene.mesh.rest.row(axis).maxCoeff() / 2 +
                        scene.mesh.rest.row(axis).minCoeff() / 2,
               across = axis == 0 ? sheet.length() : sheet.width();
  double momentum = 0;
  for (Eigen::Index i = 0; i < v.cols(); ++i)
    if (scene.mesh.rest(axis, i) > middle) momentum += scene.mass[i] * v(axis, i);
  return -momentum / (double(steps_of_stress) * scene.dt * across) / (1 + strain);
}

PortableScene wrinkled_sheet() {
  PortableScene scene = strained_sheet();
  scene.name = "stretched sheet with wrinkles";
  const double right = sheet.width(), top = sheet.length() / 2, near = sheet.edge / 4;
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const Vector3 rest = scene.mesh.rest.col(i);
    if (rest.x() < near || rest.x() > right - near || std::abs(rest.y()) > top - near)
      scene.held.push_back(int(i));
    for (int n = 1; n <= waves; ++n) scene.x(2, i) += Wave{n}.height() * Wave{n}.at(rest);
  }
  return scene;
}

double height_of(const PortableScene& scene, const Wave& wave, const PerParticle3& x) {
  double sum = 0, whole = 0;
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const double at = wave.at(scene.mesh.rest.col(i));
    sum += scene.mass[i] * at * x(2, i), whole += scene.mass[i] * at * at;
  }
  return sum / whole;
}

/// Of a'' = -rate a, from rest, by a at a time over a at the start [1/s^2].
double rate_of(double over_start, double time) {
  const double phase =
      over_start <= 1 ? std::acos(std::max(-1.0, over_start)) : std::acosh(over_start);
  return (over_start <= 1 ? 1 : -1) * std::pow(phase / time, 2);
}

/// What resists waves, per area and height, of a solver's own numbers.
struct Plate {
  double rigidity, along, across;  // B [N m], tensions along y and x [N/m]

  double bending(const Wave& wave) const { return rigidity * wave.k2() * wave.k2(); }  // N/m^3
  double pull(const Wave& wave) const { return along * wave.ky() * wave.ky(); }
  double push(const Wave& wave) const { return across * wave.kx() * wave.kx(); }
  double stiffness(const Wave& wave) const { return bending(wave) + pull(wave) + push(wave); }
  double parts(const Wave& wave) const {
    return bending(wave) + std::abs(pull(wave)) + std::abs(push(wave));
  }
};

Plate plate_of(Trial& trial) {
  const double rigidity = measured_rigidity(trial, flat_sheet(), sheet);
  require_resistance("bending", rigidity, given);
  const auto measured = [&](int axis, double strain) {
    return beyond_rounding(trial, "a sheet's tension [N/m]", 0.02, [&](const Vector3& away) {
      PortableScene strained = strained_sheet();
      strained.x.colwise() += away;
      const PerParticle3 v = trial.after(strained, steps_of_stress).v;
      return tension(strained, momentum_velocities(strained, v, trial.declaration()), axis, strain);
    });
  };
  return {rigidity, measured(1, strain_y), measured(0, strain_x)};
}

/// In which the fastest wave swings by so many radians, or grows as much.
long steps_of(const Plate& plate, double density) {
  constexpr double radians = 1.2;
  double fastest = 0;  // 1/s^2
  for (int n = 1; n <= waves; ++n)
    fastest = std::max(fastest, std::abs(plate.stiffness({n})) / density);
  return std::lround(radians / std::sqrt(fastest) / dt);
}

Finding wrinkles_as_its_tension_says(Trial& trial) {
  const Plate plate = plate_of(trial);
  const PortableScene scene = wrinkled_sheet();
  const long steps = steps_of(plate, scene.material.density);
  const PerParticle3 end = trial.after(scene, steps).x;
  Table measured = table_of(
      "half waves [1] | measured rigidity [N m] | tension along [N/m] | and across [N/m] | "
      "height, over the start's [1] | stiffness to it [N/m^3] | of a plate [N/m^3] | "
      "difference, over the sum of its parts [1] | allowed [1] | "
      "of the difference, over what is allowed [1]");
  for (int n = 1; n <= waves; ++n) {
    const Wave wave{n};
    const double over_start = height_of(scene, wave, end) / height_of(scene, wave, scene.x),
                 stiffness = scene.material.density * rate_of(over_start, double(steps) * dt),
                 difference = std::abs(stiffness - plate.stiffness(wave)) / plate.parts(wave),
                 bound = 0.03 + wave.k2() * sheet.edge * sheet.edge / 6;
    measured.row(n, plate.rigidity, plate.along, plate.across, over_start, stiffness,
                 plate.stiffness(wave), difference, bound, difference / bound);
  }
  return judge_worst(measured, 1,
                     "allowed: (k edge)^2/6, by which a lattice bends less than a plate; rigidity "
                     "and stresses are measured to 2 %; a first order method errs by half a step "
                     "of the motion, 0.5 %; the waves' own stretch, 0.5 %");
}

}  // namespace

std::vector<Law> wrinkle_laws() {
  return {
      {"wrinkles.grow-as-tension-and-rigidity-say",
       "In a sheet that is stretched one way and compressed across, each wave grows or swings as "
       "in a plate of the solver's own rigidity under its own stresses.",
       "plate under tension; Cerda and Mahadevan 2003", wrinkles_as_its_tension_says,
       "L1 held bending", "half waves | stiffness to it | of a plate"},
  };
}

}  // namespace foldproof
