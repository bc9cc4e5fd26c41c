// One correction by strain limits: of one spring, exactly; of a cloth, in every order of sweeps.
#include "reference/dynamics/system.h"
#include "verification/oracles/limited_spring.h"
#include "verification/specimens/check.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/random.h"
#include "verification/specimens/strain_scenes.h"

namespace foldproof {

namespace {

// ---- one spring of a triangle

/// A triangle whose third corner is so far away and so slow that only the spring 0-1 leaves its
/// limits.
struct OneSpring {
  LimitedCloth cloth;
  oracles::LimitedSpringInput input;
  oracles::LimitedSpringAnswer answer;
};

/// State of the spring 0-1 of a triangle: at rest, now and after a step.
struct SpringDraw {
  double now_low, now_high;  // current over rest length [1]
  // change of its length by the motion along it, over the rest length [1]
  double along_low, along_high;
  double across_low, across_high;  // by the motion across it [1]
  int held;                        // 0, 1 or none: -1
};

OneSpring one_spring(const SpringDraw& draw, Random& random) {
  const double L = random.uniform(0.04, 0.09), h = random.uniform(0.003, 0.02), far = 30;
  PerParticle3 rest(3, 3);
  rest << 0, L, 0.4 * L, 0, 0, far * L, 0, 0, 0;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(random.uniform(-3, 3), random.vectors(1, 1).col(0).normalized()).matrix();
  Scene scene =
      scene_at_rest(make_triangle_mesh(turn * rest, {{0, 1, 2}}), random.uniform(0.1, 0.4));
  scene.stretch = StretchMaterial{29, 0, 1};
  StrainLimits limits;
  limits.extension = 0.083;
  limits.compression = 0.037;
  scene.strain_limits = limits;
  const Vector3 along = turn.col(0), across = turn * Vector3(0, std::sin(0.7), std::cos(0.7));
  scene.x.col(1) += (random.uniform(draw.now_low, draw.now_high) - 1) * L * along;
  scene.v.colwise() = Vector3(0.31, -0.23, 0.17);
  scene.v.col(1) += L / h *
                    (random.uniform(draw.along_low, draw.along_high) * along +
                     random.uniform(draw.across_low, draw.across_high) * across);
  if (draw.held >= 0) scene.prescribed.push_back({draw.held, scene.x.col(draw.held), Motion{}});
  // the filter's input: includes the velocity of a prescribed particle
  State state{0, scene.x, scene.v};
  const PerParticle mass = lumped_masses(scene.mesh, scene.density);
  const auto inverse = [&](int i) { return draw.held == i ? 0 : 1 / mass[i]; };
  const double rest_length = (scene.mesh.rest.col(1) - scene.mesh.rest.col(0)).norm();
  const oracles::LimitedSpringInput input{state.x.col(0),
                                          state.x.col(1),
                                          state.v.col(0),
                                          state.v.col(1),
                                          inverse(0),
                                          inverse(1),
                                          h,
                                          (1 - limits.compression) * rest_length,
                                          (1 + limits.extension) * rest_length};
  return {{"", std::move(scene), std::move(state), h}, input, limited_spring(input)};
}

/// Distance from the oracle's velocities, in roundings of the terms that they are computed from;
/// infinite if the far corner's velocity differs in any bit.
double error_of(const Subject& subject, const OneSpring& spring) {
  const PerParticle3 v = corrected_by_strain_limits(subject, spring.cloth, spring.cloth.state.v);
  if (!(v.col(2) == spring.cloth.state.v.col(2))) return INFINITY;
  const double error =
      std::max((v.col(0) - spring.answer.v_a).norm(), (v.col(1) - spring.answer.v_b).norm());
  const double d = (spring.input.x_b - spring.input.x_a).norm();
  const double size = d / spring.input.step + spring.input.v_a.norm() + spring.input.v_b.norm();
  return error / (epsilon * size * spring.answer.sensitivity);
}

struct DrawKind {
  std::string name;
  SpringDraw draw;
  bool is_reachable;
};

Finding compare_draws(const Subject& subject, const std::vector<DrawKind>& kinds) {
  Table measured{{"case", ""}, {"error", "epsilon of |d|/h + |v|, times the answer's sensitivity"}};
  for (const DrawKind& kind : kinds) {
    Random random(91);
    Worst worst;
    for (int k = 0; k < 40; ++k) {
      const OneSpring spring = one_spring(kind.draw, random);
      const bool is_meant =
          spring.answer.is_violated && spring.answer.is_reachable == kind.is_reachable;
      worst.observe(is_meant ? error_of(subject, spring) : NAN);
    }
    measured.row(kind.name, worst.value());
  }
  return judge_worst(measured, 16,
                     "d, d + h dv and their products are rounded about eight times, the impulse "
                     "and the two velocities as often");
}

Finding one_spring_finding(const Subject& subject) {
  return compare_draws(subject,
                       {{"too long", {0.98, 1.06, 0.15, 0.9, -0.2, 0.2, -1}, true},
                        {"too long by its turning", {1.01, 1.08, -0.01, 0.01, 0.45, 0.6, -1}, true},
                        {"too long, turned round", {0.98, 1.06, -2.9, -2.3, -0.3, 0.3, -1}, true},
                        {"too short", {0.98, 1.06, -0.7, -0.2, -0.2, 0.2, -1}, true},
                        {"too short, turned round", {0.98, 1.06, -1.8, -1.3, -0.2, 0.2, -1}, true},
                        {"beyond the upper limit now", {1.2, 1.9, -0.03, 0.2, -0.3, 0.3, -1}, true},
                        {"beyond the lower limit now", {0.3, 0.8, -0.2, 0.05, -0.3, 0.3, -1}, true},
                        {"one end held", {0.98, 1.06, 0.15, 0.9, -0.2, 0.2, 0}, true},
                        {"the other end held", {0.98, 1.06, -0.7, -0.2, -0.2, 0.2, 1}, true}});
}

Finding beyond_reach_finding(const Subject& subject) {
  return compare_draws(
      subject, {{"turns fast", {0.98, 1.06, -0.1, 0.3, 1.12, 1.7, -1}, false},
                {"turns fast, one end held", {0.98, 1.06, -0.1, 0.3, 1.12, 1.7, 1}, false}});
}

// ---- a cloth

Finding limits_finding(const Subject& subject, SweepOrder order) {
  Table measured{{"case", ""}, {"violation left over the tolerance", "1"}};
  std::vector<LimitedCloth> cloths = limited_cloths(order);
  for (size_t k = 0; k < cloths.size(); ++k) {
    LimitedCloth& cloth = cloths[k];
    if (k % 2 == 1) cloth.scene.prescribed.push_back({4, cloth.state.x.col(4), Motion{}});
    const PerParticle3 v = corrected_by_strain_limits(subject, cloth, cloth.state.v);
    const double before = strain_violation(cloth.scene, cloth.state.x + cloth.step * cloth.state.v);
    const double after = strain_violation(cloth.scene, cloth.state.x + cloth.step * v);
    const double tolerance = cloth.scene.strain_limits->tolerance;
    measured.row(cloth.name, before > 100 * tolerance ? after / tolerance : NAN);
  }
  return judge_worst(
      measured, 1 + 1e-9,
      "sweeps end within the tolerance, since velocities within the limits exist; a billionth for "
      "rounding in a different order of summation. Motions that break no limit count as NaN");
}

Finding momentum_finding(const Subject& subject) {
  Table measured{{"case", ""}, {"momentum gained", "epsilon of sum m |v|, or of sum m |x| |v|"}};
  for (LimitedCloth& cloth : cloths_in_all_orders()) {
    cloth.scene.strain_limits->sweeps = 12;
    cloth.state.x.colwise() += Vector3(0.31, -0.17, 0.23);
    const PerParticle3 change =
        corrected_by_strain_limits(subject, cloth, cloth.state.v) - cloth.state.v;
    const PerParticle mass = lumped_masses(cloth.scene.mesh, cloth.scene.density);
    Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();
    double linear_size = 0, angular_size = 0;
    for (Eigen::Index i = 0; i < mass.size(); ++i) {
      const Vector3 x = cloth.state.x.col(i), gained = mass[i] * change.col(i);
      const double size = mass[i] * cloth.state.v.col(i).norm();
      linear += gained;
      angular += x.cross(gained);
      linear_size += size;
      angular_size += x.norm() * size;
    }
    measured.row(cloth.name, linear.norm() / (epsilon * linear_size));
    measured.row(cloth.name + ", angular", angular.norm() / (epsilon * angular_size));
  }
  return judge_worst(measured, 8,
                     "in each of 12 sweeps some six impulses meet at a particle, each a rounding "
                     "of its velocity, half an epsilon at most: 72 of them add up like a random "
                     "walk to 4, and the impulses' own to as much");
}

/// The last particle flies across the cloth in one step.
void make_last_fast(LimitedCloth& cloth) {
  const Eigen::Index last = cloth.state.v.cols() - 1;
  cloth.state.v.col(last) *= extent(cloth.state.x) / (cloth.step * cloth.state.v.col(last).norm());
}

Finding held_finding(const Subject& subject) {
  Table measured{{"case", ""}, {"numbers that differ", "numbers"}};
  for (LimitedCloth& cloth : cloths_in_all_orders()) {
    // two neighbours are held: their violated spring stays violated
    cloth.scene.strain_limits->sweeps = 30;
    for (const int i : {0, 3, 7, 8})
      cloth.scene.prescribed.push_back({i, cloth.state.x.col(i), Motion{}});
    make_last_fast(cloth);
    const PerParticle3 v = corrected_by_strain_limits(subject, cloth, cloth.state.v);
    double differing = 0;
    for (const int i : {0, 3, 7, 8})
      differing += count_differing_entries(v.col(i), cloth.state.v.col(i));
    const bool is_tried = count_differing_entries(v, cloth.state.v) > 0;
    measured.row(cloth.name, is_tried ? differing : NAN);
  }
  return judge_worst(measured, 0, "a prescribed velocity is known");
}

/// Slows a motion down until no spring leaves its limits.
PerParticle3 gentle(const LimitedCloth& cloth) {
  PerParticle3 v = cloth.state.v;
  while (strain_violation(cloth.scene, cloth.state.x + cloth.step * v) > -1e-6) v *= 0.7;
  return v;
}

/// Gentle velocities, except for the fast last particle: particles with no triangle in common with
/// it must keep theirs.
Finding untouched_within_limits_finding(const Subject& subject) {
  Table measured{{"case", ""}, {"numbers that differ", "numbers"}};
  for (LimitedCloth& cloth : cloths_in_all_orders()) {
    const PerParticle3 slow = gentle(cloth);
    measured.row(cloth.name,
                 count_differing_entries(corrected_by_strain_limits(subject, cloth, slow), slow));
    cloth.scene.strain_limits->sweeps = 1;
    PerParticle3 fast = slow;
    const Eigen::Index last = fast.cols() - 1;
    make_last_fast(cloth);
    fast.col(last) = cloth.state.v.col(last);
    const PerParticle3 v = corrected_by_strain_limits(subject, cloth, fast);
    const double after = strain_violation(cloth.scene, cloth.state.x + cloth.step * fast);
    measured.row(cloth.name + ", one fast",
                 after > 0 && count_differing_entries(v.col(last), fast.col(last)) > 0
                     ? count_differing_entries(v.col(0), fast.col(0))
                     : NAN);
  }
  return judge_worst(
      measured, 0,
      "the filter must not touch motion that breaks no limit; in one sweep a correction cannot get "
      "from the last particle of a sheet to the first, at its other end");
}

}  // namespace

std::vector<Check> strain_limit_checks() {
  const std::string source = "BMF03 section 3, after Provot 1995";
  std::vector<Check> list = {{"strain.one-spring-is-corrected-exactly",
                              "A spring that would leave its limits is given the impulse along its "
                              "current direction that takes its predicted length to the limit.",
                              source, one_spring_finding},
                             {"strain.unreachable-limits-leave-the-shortest-spring",
                              "A spring that turns so fast that no impulse along it keeps its "
                              "limit is given the impulse that leaves it shortest.",
                              source, beyond_reach_finding}};
  for (const NamedOrder& named : sweep_orders())
    list.push_back(
        {"strain.predicted-lengths-stay-within-limits." + named.name,
         "Velocities from sweeps in the order '" + named.name +
             "' predict lengths within the limits, to the tolerance, of cloth that is within them.",
         source,
         [order = named.order](const Subject& subject) { return limits_finding(subject, order); }});
  list.insert(list.end(),
              {{"strain.momentum-is-conserved",
                "A correction changes neither the linear nor the angular momentum of a free cloth.",
                source, momentum_finding},
               {"strain.prescribed-particles-are-left-alone",
                "Velocities of particles with prescribed motion are unchanged, bit for bit.",
                source, held_finding},
               {"strain.springs-within-limits-are-left-alone",
                "Where no spring would leave its limits, velocities are unchanged, bit for bit.",
                source, untouched_within_limits_finding}});
  return list;
}

}  // namespace foldproof
