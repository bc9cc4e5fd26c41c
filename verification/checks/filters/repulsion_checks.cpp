// Layers within the thickness: their effect on each other, and what is conserved.
#include <numeric>

#include "reference/filters/cloth_pairs.h"
#include "verification/specimens/check.h"
#include "verification/specimens/layered_cloth.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

constexpr double step = 0.004;  // s

/// A vertex over a triangle, as two pieces of cloth: the vertex is a corner of a triangle that
/// extends up and away.
struct OverTriangle {
  double height, parting, sliding;  // of the vertex over it [m], v_N and along x [m/s]
  double stiffness, friction;       // N/m, 1
};

Scene over_triangle(const OverTriangle& wanted) {
  PerParticle3 rest(3, 6);
  rest << 0, 0.05, 0.01, /**/ 0.018, 0.05, 0.02,  //
      0, 0, 0.06, /**/ 0.021, 0.03, 0.07,         //
      0, 0, 0, /**/ wanted.height, 0.08, 0.09;
  Scene scene = scene_at_rest(make_triangle_mesh(rest, {{0, 1, 2}, {3, 4, 5}}), 0.31);
  scene.self_collision = SelfCollisionSettings{0.004, wanted.stiffness, wanted.friction, 8, true};
  scene.v.col(3) = Vector3(wanted.sliding, 0, wanted.parting);
  return scene;
}

/// The change of relative velocity by the rule of BFA02, coded a second time: with the weights of
/// the foot from areas, and m/(1 + ...) for the compliance.
Vector3 expected_change(const OverTriangle& wanted, const Scene& scene) {
  const PerParticle mass = lumped_masses(scene.mesh, scene.density);
  const auto area = [&](int a, int b, double x, double y) {
    const Vector3 p = scene.x.col(a), q = scene.x.col(b);
    return ((q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0])) / 2;
  };
  const double whole = 0.05 * 0.06 / 2;
  const double w0 = area(1, 2, 0.018, 0.021) / whole, w1 = area(2, 0, 0.018, 0.021) / whole,
               w2 = 1 - w0 - w1;
  const double pair_compliance =
      1 / mass[3] + w0 * w0 / mass[0] + w1 * w1 / mass[1] + w2 * w2 / mass[2];  // 1/kg
  const double overlap = 0.004 - wanted.height, largest = overlap / (10 * step);
  const double inelastic = wanted.parting < 0 ? -wanted.parting : 0,
               left = wanted.parting + inelastic;
  const double spring =
      left >= largest
          ? 0
          : std::fmin(step * wanted.stiffness * overlap * pair_compliance, largest - left);
  const double push = inelastic + spring;
  const double slide =
      std::copysign(std::fmin(std::abs(wanted.sliding), wanted.friction * push), wanted.sliding);
  return {-slide, 0, push};
}

Finding law_finding(const Subject& subject) {
  Table measured{{"case", ""},
                 {"difference of the change of relative velocity over its size", "1"}};
  for (const OverTriangle& wanted : {OverTriangle{0.0031, -0.4, 0.3, 0, 0},
                                     {0.0031, -0.4, 0.3, 0, 0.21},
                                     {0.0031, -0.4, 0.05, 0, 0.7},
                                     {0.0023, 0, -0.2, 1.3, 0.4},
                                     {0.0023, 0.005, 0.1, 1.3, 0},
                                     {0.0023, -0.1, 0.1, 900, 0.3},
                                     {0.0023, 0.041, 0.1, 900, 0.3},
                                     {0.0023, 0.5, 0.1, 900, 0.3}}) {
    const Scene scene = over_triangle(wanted);
    const PerParticle3 change =
        corrected_by_self_collision(subject, scene, {step, false}) - scene.v;
    const Nearness at = nearness(PairKind::vertex_triangle,
                                 corners_of({PairKind::vertex_triangle, {3, 0, 1, 2}}, scene.x));
    const Vector3 relative = change(Eigen::all, {3, 0, 1, 2}) * at.weights;
    const double scale = std::abs(wanted.parting) + std::abs(wanted.sliding);
    char name[90];
    std::snprintf(name, sizeof name, "%.4g m high, %.3g m/s, sliding %.3g m/s, k %.3g N/m, mu %.2g",
                  wanted.height, wanted.parting, wanted.sliding, wanted.stiffness, wanted.friction);
    measured.row(name, (relative - expected_change(wanted, scene)).norm() / scale);
  }
  return judge_worst(measured, 1e-12,
                     "the same law from areas instead of normals: some tens of roundings, with "
                     "heights a twentieth of the triangle's size");
}

struct MomentumCase {
  const char* name;
  LayeredSheets layered;
  bool moves;
};

std::vector<MomentumCase> momentum_cases() {
  LayeredSheets still{3, 0.003, 0.001, 0.3, {0.004, 0, 0, 8, true}, 3},
      springy = still, rubbing = still, fast = still;
  springy.settings.stiffness = 7;
  springy.seed = 4;
  rubbing.settings.friction = 0.4;
  fast.speed = 3;
  fast.settings.friction = 0.3;
  return {{"repulsion", still, false},
          {"repulsion with springs", springy, false},
          {"with friction", rubbing, false},
          {"crossings and friction", fast, true}};
}

/// sum m |v|: the scale for roundings of momentum.
double momentum_scale(const PerParticle& mass, const PerParticle3& v) {
  return v.colwise().norm().dot(mass.transpose());
}

constexpr const char* why_roundings =
    "every impulse adds w_i j/m_i to four velocities, with weights that sum to zero up to a "
    "rounding each; a particle takes part in some tens of them";

Finding linear_finding(const Subject& subject) {
  Table measured = roundings_of("sum m |v|");
  for (const MomentumCase& of : momentum_cases()) {
    const Scene scene = layered_scene(of.layered);
    const PerParticle mass = lumped_masses(scene.mesh, scene.density);
    const PerParticle3 after = corrected_by_self_collision(subject, scene, {step, of.moves});
    const double changed = momentum_scale(mass, after - scene.v),
                 size = momentum_scale(mass, scene.v);
    measured.row(of.name, changed > 0.01 * size
                              ? linear_momentum_of(mass, after - scene.v).norm() / (epsilon * size)
                              : NAN);
  }
  return judge_worst(measured, 64, why_roundings);
}

Finding angular_finding(const Subject& subject) {
  Table measured = roundings_of("sum m |v| times the cloth's size");
  for (const MomentumCase& of : momentum_cases()) {
    if (of.layered.settings.friction > 0) continue;
    const Scene scene = layered_scene(of.layered);
    const PerParticle mass = lumped_masses(scene.mesh, scene.density);
    const PerParticle3 after = corrected_by_self_collision(subject, scene, {step, of.moves});
    const double size = momentum_scale(mass, scene.v) * 0.1;
    measured.row(of.name,
                 angular_momentum_of(mass, scene.x, after - scene.v).norm() / (epsilon * size));
  }
  return judge_worst(measured, 64 * 8,
                     std::string(why_roundings) +
                         "; the normal is the line between the points to an epsilon times the "
                         "features' size over their distance, some eight here");
}

/// Friction acts at two points a distance apart: the angular momentum changes by at most that
/// distance times the impulse.
Finding friction_turn_finding(const Subject& subject) {
  Table measured{
      {"case", ""},
      {"change of angular momentum over thickness times friction times normal impulses", "1"}};
  for (const unsigned seed : {3u, 8u}) {
    LayeredSheets wanted{2, 0.003, 0.001, 0.3, {0.004, 0, 0.4, 8, true}, seed};
    const Scene rubbing = layered_scene(wanted);
    const PerParticle mass = lumped_masses(rubbing.mesh, rubbing.density);
    const PerParticle3 change =
        corrected_by_self_collision(subject, rubbing, {step, false}) - rubbing.v;
    const Eigen::Index half = change.cols() / 2;
    // normal impulses: at least the change of the upper sheet's momentum across the layers, per
    // particle
    const double normal = (change.row(2).rightCols(half).cwiseAbs() * mass.tail(half))[0];
    measured.row("seed " + std::to_string(seed),
                 angular_momentum_of(mass, rubbing.x, change).norm() / (0.004 * 0.4 * normal));
  }
  return judge_worst(measured, 2,
                     "a pair's friction impulse is at most mu times its normal one and acts with "
                     "an arm of at most the thickness; impulses up and down on one particle cancel "
                     "in part, so that their sum may be up to twice what is left of it");
}

Finding untouched_finding(const Subject& subject) {
  Table measured{{"case", ""}, {"particles that were changed", "particles"}};
  const auto changed = [](const PerParticle3& a, const PerParticle3& b) {
    return double((a.array() != b.array()).colwise().any().count());
  };
  LayeredSheets apart{3, 0.02, 0.001, 0.3, {0.004, 9, 0.3, 8, true}, 5};
  const Scene far = layered_scene(apart);
  measured.row("layers too far apart",
               changed(corrected_by_self_collision(subject, far, {step, true}), far.v));
  Scene rising = layered_scene({3, 0.003, 0.0005, 0, {0.004, 0, 0.3, 8, true}, 5});
  for (Eigen::Index i = 0; i < rising.v.cols(); ++i) rising.v(2, i) = 0.4 * double(i / 42);
  measured.row("layers that part",
               changed(corrected_by_self_collision(subject, rising, {step, true}), rising.v));
  Scene prescribed = layered_scene({3, 0.003, 0.001, 2, {0.004, 9, 0.3, 8, true}, 6});
  Motion onward;
  onward.velocity = {0.3, -0.2, 0.1};
  for (int i = 42; i < 84; ++i) prescribed.prescribed.push_back({i, prescribed.x.col(i), onward});
  const State s = start_state(prescribed);
  const PerParticle3 after = corrected_by_self_collision(subject, prescribed, {step, true});
  measured.row("particles that are led", changed(after.middleCols(42, 42), s.v.middleCols(42, 42)));
  return judge_worst(measured, 0, "nothing is to be done about them: not a bit may change");
}

/// Every pair that comes nearer than the margin is found once; found pairs have no particle in
/// common.
Finding pairs_finding() {
  Table measured{{"case", ""}, {"pairs missed, found twice, or of neighbours", "pairs"}};
  const double margin = 0.004;
  for (const unsigned seed : {1u, 2u, 3u}) {
    const Scene scene = layered_scene({2, 0.003, 0.0014, 1.5, {0.004, 0, 0, 8, true}, seed});
    const PerParticle3 end = scene.x + step * scene.v;
    const auto key = [](const FeaturePair& pair) {
      auto [a, b, c, d] = pair.particles;
      if (pair.kind == PairKind::vertex_triangle) {
        std::array<int, 3> t{b, c, d};
        std::sort(t.begin(), t.end());
        return std::array<int, 5>{0, a, t[0], t[1], t[2]};
      }
      if (a > b) std::swap(a, b);
      if (c > d) std::swap(c, d);
      return std::min(std::array<int, 5>{1, a, b, c, d}, std::array<int, 5>{1, c, d, a, b});
    };
    std::vector<std::array<int, 5>> found;
    for (const FeaturePair& pair : near_pairs(make_cloth_tree(scene.mesh), scene.x, end, margin))
      found.push_back(key(pair));
    std::sort(found.begin(), found.end());
    double wrong = double(found.end() - std::unique(found.begin(), found.end()));
    size_t near = 0, seen = 0;
    for (const FeaturePair& pair : all_pairs(scene.mesh)) {
      const bool is_found = std::binary_search(found.begin(), found.end(), key(pair));
      seen += is_found;
      double least = INFINITY;
      for (const double t : {0.0, 0.3, 0.7, 1.0})
        least = std::min(
            least, nearness(pair.kind, corners_of(pair, PerParticle3(scene.x + t * step * scene.v)))
                       .distance);
      if (!(least < margin)) continue;
      ++near;
      if (!is_found) ++wrong;
    }
    wrong += double(found.size() - seen);
    measured.row("seed " + std::to_string(seed) + ", " + std::to_string(near) + " near",
                 near > 100 ? wrong : NAN);
  }
  return judge_worst(measured, 0,
                     "counted against all pairs of two sheets, looked at four times on their way");
}

/// A stack of sheets on a slope. The lowest is held, and larger, so that nothing overhangs its rim;
/// Coulomb's law holds between any two. Distances that the others slide in 0.1 s [m], from below.
std::vector<double> ways_on_slope(const Subject& subject, double friction, double degrees) {
  constexpr int free_sheets = 3;
  Scene scene = layered_scene({1 + free_sheets, 0.0035, 0, 0, {0.004, 0, friction, 8, true}, 7});
  const Vector3 middle = scene.x.leftCols(42).rowwise().mean();
  scene.x.leftCols(42) =
      (Vector3(1.5, 1.5, 1).asDiagonal() * (scene.x.leftCols(42).colwise() - middle)).colwise() +
      middle;
  const double angle = degrees * pi / 180;
  scene.gravity = Vector3(9.81 * std::sin(angle), 0, -9.81 * std::cos(angle));
  scene.stretch = StretchMaterial{20, 0.02, 1};
  for (int i = 0; i < 42; ++i) scene.prescribed.push_back({i, scene.x.col(i), Motion{}});
  Stepper stepper(subject, scene, "C");
  const State end = stepper.run(stepper.start(), 0.001, 100);
  std::vector<double> ways;
  for (int k = 1; k <= free_sheets; ++k)
    ways.push_back((end.x - scene.x).middleCols(42 * k, 42).row(0).mean());
  return ways;
}

Finding slope_finding(const Subject& subject) {
  Table measured{
      {"case", ""},
      {"|distance over that of Coulomb's law - 1|; or distance over that without friction", "1"}};
  const double seconds = 0.1;
  for (const auto& [friction, degrees] : {std::pair{0.3, 20.0}, {0.5, 35.0}}) {
    const double angle = degrees * pi / 180;
    const double slides =
        9.81 * (std::sin(angle) - friction * std::cos(angle)) * seconds * seconds / 2;
    const std::vector<double> ways = ways_on_slope(subject, friction, degrees);
    const double mean = std::accumulate(ways.begin(), ways.end(), 0.0) / double(ways.size());
    measured.row("slides, mu " + std::to_string(friction).substr(0, 4) + ", mean",
                 std::abs(mean / slides - 1));
  }
  for (const auto& [friction, degrees] : {std::pair{0.4, 20.0}, {0.75, 35.0}}) {
    const double free = 9.81 * std::sin(degrees * pi / 180) * seconds * seconds / 2;
    const std::vector<double> ways = ways_on_slope(subject, friction, degrees);
    for (size_t k = 0; k < ways.size(); ++k)
      measured.row("holds, mu " + std::to_string(friction).substr(0, 4) + ", sheet " +
                       std::to_string(k + 1) + " on the one below",
                   std::abs(ways[k] - (k > 0 ? ways[k - 1] : 0)) / free);
  }
  return judge_worst(
      measured, 0.1,
      "Coulomb's law; a tenth for the unevenness of pairs that are corrected one after the other, "
      "each for the normal velocity left by the others. Sliding sheets use all the friction "
      "between them, so noise separates them: their mean is judged");
}

}  // namespace

std::vector<Check> repulsion_checks() {
  return {
      {"self-collision.repulsion-follows-its-law",
       "Two features nearer than the thickness stop approaching, are separated by at most a tenth "
       "of their overlap in a step, and have Coulomb friction.",
       "Bridson, Fedkiw, Anderson 2002 section 7.1; BMF03 section 5", law_finding},
      {"self-collision.linear-momentum-is-conserved",
       "Repulsion, friction and impulses against crossings keep the linear momentum of free cloth.",
       "Bridson, Fedkiw, Anderson 2002 section 7", linear_finding},
      {"self-collision.repulsion-conserves-angular-momentum",
       "Repulsion without friction keeps the angular momentum of free cloth.",
       "Bridson, Fedkiw, Anderson 2002 section 7.1", angular_finding},
      {"self-collision.friction-torque-is-bounded-by-its-arm",
       "Friction between layers changes angular momentum by no more than its impulses times the "
       "distance at which they act.",
       "ours; Bridson, Fedkiw, Anderson 2002 section 7.1", friction_turn_finding},
      {"self-collision.separate-layers-are-bitwise-unchanged",
       "Layers that are apart or separating, and prescribed particles, keep every bit of their "
       "velocities.",
       "BMF03 section 5", untouched_finding},
      {"self-collision.near-pairs-are-found-exactly-once",
       "The search by boxes finds every pair of features that comes near, exactly once, and no "
       "neighbours.",
       "Bridson, Fedkiw, Anderson 2002 section 6", pairs_finding},
      {"self-collision.a-stack-on-a-slope-obeys-coulomb",
       "Where tan(angle) is below the friction, sheets of a stack on a slope slip by less than a "
       "tenth of what they would slide without friction; where it is not, the stack slides as "
       "Coulomb says, to a tenth.",
       "BMF03 section 5.2; Bridson, Fedkiw, Anderson 2002 section 7.1", slope_finding},
  };
}

}  // namespace foldproof
