// Strain limits in steps, the sweeps themselves, and their keys in a case file.
#include "reference/dynamics/system.h"
#include "verification/specimens/check.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/random.h"
#include "verification/specimens/stepper.h"
#include "verification/specimens/strain_scenes.h"
#include "verification/specimens/trial_cases.h"

namespace foldproof {

namespace {

const std::string source = "BMF03 section 3, after Provot 1995";

// ---- steps

/// Of the particle that is the farthest from the first one at rest.
int farthest(const PerParticle3& rest) {
  Eigen::Index last = 0;
  (rest.colwise() - rest.col(0)).colwise().squaredNorm().maxCoeff(&last);
  return int(last);
}

/// Cloth within its limits that falls, stretches and bends. Two of its particles are prescribed,
/// far from each other, so that lengths within the limits stay possible. The step is stable for
/// explicit forces.
LimitedCloth falling(LimitedCloth cloth) {
  Scene& scene = cloth.scene;
  scene.gravity = Vector3(0.7, -9.1, 1.9);
  scene.bending = BendingMaterial{3.1e-4, 2.3e-5, Weighting::rest, DampingFactor::edge, "sine"};
  Motion swing;
  swing.velocity = Vector3(0.11, -0.07, 0.19);
  // limits that act from the first steps on: tight ones, with springs too weak to pull lengths away
  // from them
  scene.stretch->stiffness = 0.37;
  StrainLimits& limits = *scene.strain_limits;
  if (limits.compression > 0) limits.compression += 0.001 + strain_violation(scene, scene.x);
  const int far = farthest(scene.mesh.rest);
  scene.prescribed = {{0, scene.x.col(0), Motion{}}, {far, scene.x.col(far), swing}};
  const double limit = elastic_limit(build_system(scene), cloth.state);
  cloth.step = std::min({0.0031, 0.25 * limit, 0.0031 * 0.25 / relative_motion(cloth, 0.0031)});
  return cloth;
}

Finding steps_finding(const Subject& subject, const std::string& integrator) {
  Table measured{{"case", ""}, {"largest violation in 12 steps over the tolerance", "1"}};
  int tried = 0;
  for (const LimitedCloth& cloth : limited_cloths(SweepOrder::gauss_seidel)) {
    const LimitedCloth falls = falling(cloth);
    Stepper stepper(subject, falls.scene, integrator);
    State s = stepper.start();
    double worst = -1;
    for (int n = 0; n < 12; ++n) {
      s = stepper.step(s, falls.step);
      const double violation = strain_violation(falls.scene, s.x);
      if (!(violation <= worst)) worst = violation;
    }
    const double used = worst / falls.scene.strain_limits->tolerance;
    measured.row(cloth.name, used);
    tried += used > -5;
  }
  if (tried < 12) measured.row("few cloths come near their limits", NAN);
  return judge_worst(measured, 1 + 1e-9,
                     "x moves with the limited velocity, and nothing else moves it; a billionth "
                     "for rounding in a different order of summation. At least 12 of 16 cloths "
                     "must come within five tolerances of their limits, or it is NaN");
}

Finding report_finding(const Subject& subject) {
  Table measured{{"case", ""}, {"difference between what is reported and what is left", "epsilon"}};
  for (LimitedCloth& cloth : limited_cloths(SweepOrder::gauss_seidel)) {
    cloth.scene.strain_limits->sweeps = 2;
    Stepper stepper(subject, cloth.scene, "B");  // one correction a step
    const State s = stepper.step(stepper.start(), cloth.step);
    const double left = std::max(0.0, strain_violation(cloth.scene, s.x));
    measured.row(cloth.name, std::abs(stepper.work().strain_left - left) / epsilon);
    // the second one only if the first found something to correct
    const long sweeps = stepper.work().strain_sweeps;
    const bool plausible = sweeps == 2 || (sweeps == 1 && left == 0);
    measured.row(cloth.name + ", sweeps", plausible ? 0 : INFINITY);
  }
  return judge_worst(
      measured, 64,
      "positions, up to ten times as far from the origin as a spring is long, are rounded, and "
      "their difference over the rest length; what counts as at the limit may be eight beyond it");
}

// ---- sweeps

/// Particles on a line, with springs between neighbours or from the first to all others: here,
/// lengths within limits are an interval for each velocity difference.
struct Chain {
  StrainLimiter limiter;
  PerParticle3 x, v, within;  // 3 x N; `within`: velocities that keep the limits
  PerParticle mass;
  double step;
};

Chain random_chain(SweepOrder order, bool bundle, unsigned seed) {
  constexpr int count = 23;
  Random random(seed);
  const Vector3 along = random.vectors(1, 1).col(0).normalized();
  StrainLimits limits;
  limits.extension = 0.12;
  limits.compression = 0.07;
  limits.order = order;
  limits.sweeps = 1;
  Chain chain{{},
              PerParticle3::Zero(3, count),
              PerParticle3::Zero(3, count),
              PerParticle3::Zero(3, count),
              {},
              0.013};
  chain.mass = PerParticle(count);
  std::vector<Spring> springs;
  // on the line, now and after a step within limits [m]
  std::vector<double> place(count, 0.2), later(count, 0.23);
  for (int i = 0; i < count; ++i) {
    const double L = random.uniform(0.03, 0.07);
    if (i > 0) {
      const int other = bundle ? 0 : i - 1;
      springs.push_back({other, i, L, 0, 0});
      place[size_t(i)] = place[size_t(other)] + L * random.uniform(0.935, 1.115);
      later[size_t(i)] = later[size_t(other)] + L * random.uniform(0.935, 1.115);
    }
    chain.mass[i] = random.log_uniform(0.01, 1);
    chain.x.col(i) = place[size_t(i)] * along;
    chain.within.col(i) = (later[size_t(i)] - place[size_t(i)]) / chain.step * along;
    chain.v.col(i) = random.uniform(-3, 3) * along;
  }
  chain.limiter = make_strain_limiter(limits, springs, chain.mass.cwiseInverse());
  return chain;
}

/// sqrt(sum m |v|^2) [kg^1/2 m/s]
double size_of(const PerParticle& mass, const PerParticle3& v) {
  return std::sqrt(v.colwise().squaredNorm().dot(mass.transpose()));
}

Finding nearer_finding() {
  Table measured{{"case", ""}, {"growth in a sweep", "epsilon of sqrt(sum m |v|^2)"}};
  for (const NamedOrder& named : sweep_orders())
    for (unsigned seed : {3u, 19u, 57u, 58u}) {
      const bool bundle = seed == 58;
      Chain chain = random_chain(named.order, bundle, seed);
      const double size = size_of(chain.mass, chain.v) + size_of(chain.mass, chain.within);
      double grown = -INFINITY, energy = -INFINITY;
      for (int sweep = 0; sweep < 25; ++sweep) {
        const PerParticle3 before = chain.v;
        limit_strain(chain.limiter, chain.step, chain.x, chain.v);
        const auto change = [&](const PerParticle3& from) {
          return (size_of(chain.mass, chain.v - from) - size_of(chain.mass, before - from)) /
                 (epsilon * size);
        };
        grown = signed_largest({grown, change(chain.within)});
        energy = signed_largest({energy, change(PerParticle3::Zero(3, chain.v.cols()))});
      }
      const std::string name =
          named.name + (bundle ? ", bundle" : ", chain " + std::to_string(seed));
      measured.row(name + ", distance", grown);
      measured.row(name + ", energy", energy);
    }
  return judge_worst(
      measured, 16,
      "on a line each impulse is the shortest way, in the norm weighted with masses, to velocities "
      "within one spring's limits; no velocity within all limits, rest among them, gets farther. "
      "Two roundings of each velocity at each of two springs, and those of the sums");
}

Finding colours_finding() {
  Table measured{{"case", ""},
                 {"springs of a colour that share a particle, and springs lost", "springs"}};
  for (const LimitedCloth& cloth : limited_cloths(SweepOrder::coloured)) {
    const System system = build_system(cloth.scene);
    const auto& limiter = std::get<StrainLimiter>(system.filters.front());
    double wrong = std::abs(double(limiter.springs.size()) - double(cloth.scene.mesh.edges.size()));
    for (size_t c = 0; c + 1 < limiter.colours.size(); ++c) {
      std::vector<int> ends;
      for (int i = limiter.colours[c]; i < limiter.colours[c + 1]; ++i)
        for (const int end : {limiter.springs[size_t(i)].a, limiter.springs[size_t(i)].b})
          ends.push_back(end);
      std::sort(ends.begin(), ends.end());
      wrong += double(ends.end() - std::unique(ends.begin(), ends.end()));
    }
    measured.row(cloth.name + ", " + std::to_string(limiter.colours.size() - 1) + " colours",
                 wrong);
  }
  return judge_worst(measured, 0,
                     "a colour is a set of springs that could be corrected at the same time");
}

// ---- case files

const std::string springs = "[stretch]\nstiffness = 12\n";

Finding read_finding() {
  Differences differences;
  const StrainLimits usual = *trial_scene(springs + "[strain_limits]\n").strain_limits;
  differences.is_near("default extension", usual.extension - 0.1, 0.1);
  differences.is_near("default compression", usual.compression);
  differences.is("the default order is gauss_seidel", usual.order == SweepOrder::gauss_seidel);
  for (const NamedOrder& named : sweep_orders()) {
    const Scene scene =
        trial_scene(springs +
                    "[strain_limits]\nextension = 0.23\ncompression = 0.07\nsweeps = 9\n"
                    "tolerance = 3e-4\norder = \"" +
                    named.name + "\"\n");
    const StrainLimits& read = *scene.strain_limits;
    differences.is_near("extension", read.extension - 0.23, 0.23);
    differences.is_near("compression", read.compression - 0.07, 0.07);
    differences.is_near("tolerance", read.tolerance - 3e-4, 3e-4);
    differences.is("sweeps", read.sweeps == 9);
    differences.is("order " + named.name, read.order == named.order);
  }
  const std::string ball = "[[object]]\nshape = \"sphere\"\nradius = 0.1\n";
  const System both = build_system(trial_scene(springs + ball + "[strain_limits]\n"));
  differences.is("limits come before objects",
                 both.filters.size() == 2 &&
                     std::holds_alternative<StrainLimiter>(both.filters[0]) &&
                     std::holds_alternative<ObjectCollision>(both.filters[1]));
  differences.is("without the table no filter is built",
                 build_system(trial_scene(springs)).filters.empty());
  const Scene scene = trial_scene(springs + "[strain_limits]\nextension = 0.25\n");
  const std::vector<std::string> parts = describe_parts(scene, build_system(scene));
  differences.is("a run says what was built",
                 std::any_of(parts.begin(), parts.end(), [](const std::string& part) {
                   return part.find("limited to 1 to 1.25") != std::string::npos;
                 }));
  return differences.judged(1, "a decimal is rounded once when it is read and once here");
}

Finding rejected_finding() {
  return rejected_cases({
      {"[strain_limits]\n", {"[strain_limits]", "[stretch]"}},
      {springs + "[strain_limits]\nextension = -0.1\n", {"extension", "negative"}},
      {springs + "[strain_limits]\ncompression = -0.1\n", {"compression", "negative"}},
      {springs + "[strain_limits]\ncompression = 1\n", {"compression", "[0, 1)"}},
      {springs + "[strain_limits]\nsweeps = 0\n", {"sweeps", "1 .."}},
      {springs + "[strain_limits]\ntolerance = 0\n", {"tolerance", "> 0"}},
      {springs + "[strain_limits]\norder = \"random\"\n", {"order", "alternating", "jacobi"}},
      {springs + "[strain_limits]\norder = \"coloured\"\nthreads = 2\n", {"threads", "unknown"}},
      {springs + "[strain_limits]\nextention = 0.1\n", {"extention", "extension"}},
  });
}

/// v after the springs were corrected one after the other, in the given order.
PerParticle3 one_by_one(const StrainLimiter& limiter, const LimitedCloth& cloth, PerParticle3 v) {
  for (const LimitedSpring& spring : limiter.springs)
    limit_strain(
        {{{limiter.limits.extension, limiter.limits.compression}, SweepOrder::gauss_seidel, 1},
         limiter.ranges,
         {spring},
         {0, 1},
         limiter.inverse_mass},
        cloth.step, cloth.state.x, v);
  return v;
}

/// Springs of the cloth in their own order, for `sweeps` sweeps without early exit.
StrainLimiter limiter_of(const LimitedCloth& cloth, SweepOrder order, int sweeps) {
  const System system = build_system(cloth.scene);
  StrainLimits limits = *cloth.scene.strain_limits;
  limits.order = order;
  limits.sweeps = sweeps;
  limits.tolerance = 1e-300;
  return make_strain_limiter(limits, std::get<StretchSprings>(system.forces[0]).springs,
                             system.inverse_mass);
}

Finding orders_finding() {
  Table measured{{"case", ""}, {"numbers that differ from springs taken one by one", "1"}};
  for (const LimitedCloth& cloth : limited_cloths(SweepOrder::gauss_seidel)) {
    for (const SweepOrder order :
         {SweepOrder::gauss_seidel, SweepOrder::alternating, SweepOrder::coloured}) {
      StrainLimiter limiter = limiter_of(cloth, order, 2);
      PerParticle3 v = cloth.state.v;
      limit_strain(limiter, cloth.step, cloth.state.x, v);
      PerParticle3 expected = one_by_one(limiter, cloth, cloth.state.v);
      if (order == SweepOrder::alternating) std::ranges::reverse(limiter.springs);
      expected = one_by_one(limiter, cloth, expected);
      measured.row(cloth.name + ", order " + std::to_string(int(order)),
                   count_differing_entries(v, expected));
    }
  }
  return judge_worst(
      measured, 0,
      "two sweeps correct all springs twice, the second time backwards if sweeps alternate");
}

}  // namespace

std::vector<Check> strain_step_checks() {
  std::vector<Check> list;
  add_for_each_scheme(
      list, {{"strain.steps-stay-within-limits",
              "the positions that a step ends at keep the strain limits, to the tolerance.", source,
              steps_finding}});
  list.insert(
      list.end(),
      {{"strain.remaining-violation-is-reported",
        "A step reports its sweeps, and the largest violation that they left.", source,
        report_finding},
       {"strain.sweeps-never-add-kinetic-energy",
        "On a line, a sweep leads no farther from any velocity within the limits, so it never "
        "adds kinetic energy.",
        "Bregman 1967", nearer_finding},
       {"strain.sweeps-visit-springs-in-order",
        "A sweep corrects springs one after the other in the list's order; every other sweep "
        "goes backwards on request; coloured sweeps go colour by colour.",
        source, orders_finding},
       {"strain.springs-of-a-colour-share-no-particle",
        "No two springs of a colour share a particle, and every spring has a colour.", "our own",
        colours_finding},
       {"scene.strain-limits-are-read",
        "Strain limits are read as written, and act before objects.", "cases/KEYS.md",
        read_finding},
       {"scene.invalid-strain-limits-are-rejected",
        "Strain limits that make no sense are refused, with the line.", "cases/KEYS.md",
        rejected_finding}});
  return list;
}

}  // namespace foldproof
