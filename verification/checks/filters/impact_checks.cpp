// Motion that leaves the cloth free of crossings, rigid zones, and cloth that crosses itself at the
// start.
#include <fmt/format.h>
#include <thread>

#include "reference/fast/kept_values.h"
#include "reference/filters/cloth_pairs.h"
#include "reference/filters/impact_zones.h"
#include "reference/forces/degenerate.h"
#include "verification/oracles/exact_crossing_times.h"
#include "verification/oracles/exact_crossings.h"
#include "verification/specimens/check.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/layered_cloth.h"
#include "verification/specimens/random.h"
#include "verification/specimens/stepper.h"

namespace foldproof {

namespace {

constexpr double span = 0.004;  // s

/// Layers that would pass through each other in a step, stopped by impulses or, with very few
/// rounds of these, by zones.
std::vector<std::pair<std::string, LayeredSheets>> fast_layers() {
  std::vector<std::pair<std::string, LayeredSheets>> all;
  for (const int rounds : {8, 1}) {
    const bool zones = rounds == 1;
    LayeredSheets wanted{
        3, 0.003, 0.001, zones ? 4.0 : 2.0, {0.002, 3, 0.2, rounds, true}, zones ? 12u : 11u};
    all.push_back({zones ? "zones" : "impulses", wanted});
  }
  return all;
}

bool boxes_meet(const Corners4& a, const Corners4& b, int first) {
  Eigen::AlignedBox3d one, other;
  for (int k = 0; k < 4; ++k)
    (k < first ? one : other).extend(Vector3(a.col(k))).extend(Vector3(b.col(k)));
  return one.intersects(other);
}

/// Pairs that cross on the way from x to x + h v, as rounded, with the velocities v.
double meetings(const Scene& scene, const PerParticle3& v) {
  const PerParticle3 end = scene.x + span * v;
  double count = 0;
  for (const FeaturePair& pair : all_pairs(scene.mesh)) {
    const Corners4 from = corners_of(pair, scene.x), to = corners_of(pair, end);
    const bool vertex = pair.kind == PairKind::vertex_triangle;
    if (!boxes_meet(from, to, vertex ? 1 : 2)) continue;
    count += oracles::ever_meet(
        vertex ? oracles::Features::vertex_and_triangle : oracles::Features::edge_and_edge,
        oracles::exact_motion(from, to - from));
  }
  return count;
}

Finding free_finding(const Subject& subject) {
  Table measured{{"case", ""}, {"pairs that meet on their way", "pairs"}};
  for (const auto& [name, wanted] : fast_layers()) {
    const Scene scene = layered_scene(wanted);
    const double unanswered = meetings(scene, scene.v);
    measured.row(name + " (" + std::to_string(int(unanswered)) + " without)",
                 unanswered > 20
                     ? meetings(scene, corrected_by_self_collision(subject, scene, {span, true}))
                     : NAN);
  }
  return judge_worst(measured, 0,
                     "all pairs of features except neighbours, tested in exact arithmetic");
}

/// Of pairs that start farther apart than a tenth of the thickness, the least distance at the end
/// over that tenth.
Finding distance_finding(const Subject& subject) {
  Table measured{{"case", ""},
                 {"a tenth of the thickness over the least distance after the step", "1"}};
  for (const auto& [name, wanted] : fast_layers()) {
    const Scene scene = layered_scene(wanted);
    const double kept = 0.1 * wanted.settings.thickness;
    const PerParticle3 end =
        scene.x + span * corrected_by_self_collision(subject, scene, {span, true});
    double least = INFINITY;
    for (const FeaturePair& pair : all_pairs(scene.mesh))
      if (nearness(pair.kind, corners_of(pair, scene.x)).distance > kept)
        least = std::min(least, nearness(pair.kind, corners_of(pair, end)).distance);
    measured.row(name, kept / least);
  }
  return judge_worst(measured, 1,
                     "features that start farther apart than a tenth of the thickness stay so: the "
                     "planes between two features keep that distance");
}

Finding energy_finding(const Subject& subject) {
  Table measured{{"case", ""}, {"kinetic energy after over before", "1"}};
  for (auto [name, wanted] : fast_layers()) {
    wanted.settings.stiffness = 0;
    const Scene scene = layered_scene(wanted);
    const PerParticle mass = lumped_masses(scene.mesh, scene.density);
    measured.row(
        name, kinetic_energy_of(mass, corrected_by_self_collision(subject, scene, {span, true})) /
                  kinetic_energy_of(mass, scene.v));
  }
  return judge_worst(
      measured, 1,
      "without springs every correction only removes relative velocity: impulses stop, friction "
      "brakes, a zone's rigid motion has the least energy for its momentum");
}

/// Particles in a cloud, in a plane and on a line, and two alone.
std::vector<std::pair<std::string, PerParticle3>> clouds() {
  Random random(21);
  PerParticle3 cloud = random.vectors(17, 0.3), plane = random.vectors(9, 0.2),
               line = random.vectors(5, 0.2);
  plane.row(1).setConstant(0.4);
  for (Eigen::Index i = 1; i < line.cols(); ++i)
    line.col(i) = line.col(0) + 0.037 * double(i * i) * Vector3(1, -2, 0.5);
  return {{"cloud", cloud},
          {"plane", plane},
          {"line", line},
          {"two", PerParticle3(random.vectors(2, 0.1))}};
}

struct Zone {
  std::vector<int> members;
  PerParticle mass, inverse_mass;
  PerParticle3 v, after;
  double missed;
};

Zone zone_of(const PerParticle3& x, int prescribed) {
  Random random(22);
  Zone zone;
  zone.v = random.vectors(x.cols(), 1.3);
  zone.mass.resize(x.cols());
  for (int i = 0; i < int(x.cols()); ++i) {
    zone.members.push_back(i);
    zone.mass[i] = random.uniform(0.001, 0.004);
  }
  zone.inverse_mass = zone.mass.cwiseInverse();
  for (int i = 0; i < prescribed; ++i) {
    zone.inverse_mass[i] = 0;
    zone.v.col(i) = Vector3(0.3, -0.2, 0.7) + Vector3(0.4, 1.1, -0.6).cross(Vector3(x.col(i)));
  }
  zone.after = zone.v;
  zone.missed = move_as_one(zone.members, x, zone.mass, zone.inverse_mass, zone.after);
  return zone;
}

Finding zone_momentum_finding() {
  Table measured = roundings_of("sum m |v|, times the zone's size for angular momentum");
  for (const auto& [name, x] : clouds()) {
    const Zone zone = zone_of(x, 0);
    const PerParticle3 change = zone.after - zone.v;
    const double scale = zone.v.colwise().norm().dot(zone.mass.transpose());
    const double size = (x.colwise() - Vector3(x.rowwise().mean())).colwise().norm().maxCoeff();
    measured.row(name + ", linear",
                 linear_momentum_of(zone.mass, change).norm() / (epsilon * scale));
    measured.row(name + ", angular",
                 angular_momentum_of(zone.mass, x, change).norm() / (epsilon * scale * size));
  }
  return judge_worst(measured, 256,
                     "normal equations of six unknowns solved by their eigenvectors: some tens of "
                     "roundings, times the condition of the zone's inertia, below ten for these");
}

/// (x_i - x_j).(v_i - v_j) = 0: no distance changes; and prescribed particles keep their velocity.
Finding zone_rigid_finding() {
  Table measured{
      {"case", ""},
      {"rate of distance, or difference from the prescribed velocity, over the largest velocity",
       "1"}};
  for (const auto& [name, x] : clouds())
    for (const int prescribed : {0, 1, 2}) {
      const Zone zone = zone_of(x, prescribed);
      const double fastest = zone.v.colwise().norm().maxCoeff();
      Worst worst;
      worst.observe(zone.missed / fastest);
      for (Eigen::Index i = 0; i < x.cols(); ++i) {
        if (i < prescribed) worst.observe((zone.after.col(i) - zone.v.col(i)).norm() / fastest);
        for (Eigen::Index j = 0; j < i; ++j) {
          const Vector3 apart = x.col(i) - x.col(j), rate = zone.after.col(i) - zone.after.col(j);
          worst.observe(std::abs(apart.dot(rate)) / (apart.norm() * fastest));
        }
      }
      measured.row(name + ", " + std::to_string(prescribed) + " led", worst.value());
    }
  return judge_worst(
      measured, 256 * epsilon,
      "a rigid motion to some hundred roundings; the prescribed velocities are rigid too");
}

Finding forced_finding(const Subject& subject) {
  Table measured{{"case", ""}, {"forced crossings that were accepted", "runs"}};
  Scene scene = layered_scene({2, 0.003, 0.0005, 0, {0.002, 0, 0, 8, true}, 14});
  for (int i = 0; i < 84; ++i) {
    Motion motion;
    motion.velocity = {0, 0, i < 42 ? 1.0 : -1.0};
    scene.prescribed.push_back({i, scene.x.col(i), motion});
  }
  double accepted = 1;
  try {
    corrected_by_self_collision(subject, scene, {span, true});
  } catch (const DegenerateElement&) {
    accepted = 0;
  }
  measured.row("two held sheets led through each other", accepted);
  return judge_worst(measured, 0,
                     "no velocity can separate prescribed particles that pass through each other: "
                     "the run must stop and say so");
}

Finding same_bits_finding(const Subject& subject) {
  Table measured{{"case", ""}, {"velocities that differ", "velocities"}};
  const Scene scene = layered_scene(fast_layers()[1].second);
  const PerParticle3 alone = corrected_by_self_collision(subject, scene, {span, true});
  std::vector<PerParticle3> answers(3);
  std::vector<std::thread> threads;
  for (PerParticle3& answer : answers)
    threads.emplace_back([&] {
      answer = corrected_by_self_collision(subject, scene, {span, true});
    });
  for (std::thread& thread : threads) thread.join();
  double differ = 0;
  for (const PerParticle3& answer : answers)
    differ += double((answer.array() != alone.array()).count());
  measured.row("alone, and three at once", differ);
  return judge_worst(
      measured, 0,
      "one order of pairs, fixed by the mesh and the boxes; no state but the arguments");
}

/// Number of pairs that are in one list only, or at another position.
double differences(const std::vector<FeaturePair>& a, const std::vector<FeaturePair>& b) {
  double count = std::abs(double(a.size()) - double(b.size()));
  for (size_t k = 0; k < std::min(a.size(), b.size()); ++k)
    count += a[k].kind != b[k].kind || a[k].particles != b[k].particles;
  return count;
}

/// Pairs searched with 3 mm to spare, after random motions within and beyond this; also with some
/// particles marked.
void see_choices(Table& measured) {
  const double margin = 0.004, spare = 0.003;
  const Scene scene = layered_scene({4, 0.003, 0.001, 0, {0.004, 0, 0, 8, true}, 17});
  const ClothTree cloth = make_cloth_tree(scene.mesh);
  const PairsAhead ahead = pairs_ahead(cloth, scene.x, margin + spare);
  Random random(17);
  for (const double share : {0.0, 0.4, 0.97, 1.3}) {
    const PerParticle3 x = scene.x + random.vectors(scene.x.cols(), share * spare / 2);
    const PerParticle3 end = scene.x + random.vectors(scene.x.cols(), share * spare / 2);
    std::vector<char> marked(size_t(x.cols()));
    for (char& one : marked) one = random.uniform(0, 1) < 0.2;
    for (const std::vector<char>& moved : {std::vector<char>{}, marked}) {
      const auto chosen = pairs_among(ahead, x, end, margin, moved);
      const std::vector<FeaturePair> searched = near_pairs(cloth, x, end, margin, moved);
      const std::string name = fmt::format("moved by {} of half of what is to spare, {}", share,
                                           moved.empty() ? "all asked" : "some asked");
      if (share > 1) measured.row(name, chosen ? NAN : 0);
      if (share < 1)
        measured.row(name, chosen && searched.size() > 50 ? differences(*chosen, searched) : NAN);
    }
  }
}

/// Numbers at the end of a run that change if found pairs are kept; NaN if these are hardly ever
/// used again.
double numbers_that_kept_pairs_change() {
  Scene scene = layered_scene({3, 0.003, 0.001, 0.2, {0.004, 3, 0.2, 8, true}, 18});
  scene.stretch = StretchMaterial{20, 0.02, 1};
  const System system = build_system(scene);
  const auto& filter = std::get<SelfCollision>(system.filters.back());
  Work keeping, forgetting;
  keeping.kept = std::make_shared<KeptValues>();
  State kept = start_state(scene), searched = kept;
  double reused = 0;
  for (int n = 0; n < 60; ++n) {
    const std::vector<Bounds> before = keeping.kept->of<PairsAhead>(filter).boxes;
    begin_step(system, kept, keeping);
    const std::vector<Bounds>& after = keeping.kept->of<PairsAhead>(filter).boxes;
    reused += !before.empty() && after.front().min() == before.front().min();
    kept = integrator_named("C").step(system, {&kept, 1}, 5e-4, keeping);
    searched = integrator_named("C").step(system, {&searched, 1}, 5e-4, forgetting);
  }
  return reused > 10 ? count_differing_entries(kept.x, searched.x) +
                           count_differing_entries(kept.v, searched.v)
                     : NAN;
}

Finding kept_pairs_finding() {
  Table measured{{"case", ""}, {"pairs or numbers that differ", "1"}};
  see_choices(measured);
  measured.row("a run of 60 steps, and one that forgets", numbers_that_kept_pairs_change());
  return judge_worst(measured, 0,
                     "the kept pairs are candidates: the pairs chosen from them are those of a "
                     "search, in the same order");
}

/// Two sheets that cross are pushed apart step by step: the number of crossings left.
Finding untangle_finding(const Subject& subject) {
  Table measured{{"case", ""}, {"crossings left over those at the start", "1"}};
  Scene scene = layered_scene({2, 0.003, 0.0002, 0, {0.002, 5, 0, 8, true}, 15});
  // a corner is below
  for (Eigen::Index i = 42; i < 84; ++i)
    scene.x(2, i) -= 0.2 * std::max(0.0, scene.x(0, i) + scene.x(1, i) - 0.17);
  scene.stretch = StretchMaterial{20, 0.02, 1};
  const auto count = [&](const PerParticle3& x) {
    return double(oracles::exact_crossings(x, scene.mesh.triangles).size());
  };
  const double start = count(scene.x);
  Stepper stepper(subject, scene, "C");
  const State end = stepper.run(stepper.start(), 0.001, 150);
  measured.row(std::to_string(int(start)) + " at the start",
               start > 5 ? count(end.x) / start : NAN);
  return judge_worst(measured, 0,
                     "the line of intersection cuts off a corner, where it can shrink to nothing");
}

}  // namespace

std::vector<Check> impact_checks() {
  return {
      {"self-collision.a-step-is-free-of-crossings",
       "Layers that would pass through each other in a step do not, by impulses or by rigid zones.",
       "BMF03 section 5; Bridson, Fedkiw, Anderson 2002 section 7", free_finding},
      {"self-collision.gaps-stay-above-a-tenth-of-the-thickness",
       "Features farther apart than a tenth of the thickness stay farther apart.", "ours",
       distance_finding},
      {"self-collision.response-never-adds-kinetic-energy",
       "Without springs, keeping layers apart adds no kinetic energy.",
       "Bridson, Fedkiw, Anderson 2002 section 7", energy_finding},
      {"self-collision.zones-conserve-momentum",
       "A rigid impact zone keeps linear and angular momentum.",
       "Bridson, Fedkiw, Anderson 2002 section 7.5; Provot 1997", zone_momentum_finding},
      {"self-collision.zones-are-rigid",
       "A rigid impact zone changes no distance, and follows the prescribed particles in it.",
       "Bridson, Fedkiw, Anderson 2002 section 7.5; Provot 1997", zone_rigid_finding},
      {"self-collision.forced-crossings-stop-the-run",
       "Prescribed motion that takes cloth through itself stops the run.", "ours", forced_finding},
      {"self-collision.results-are-bitwise-reproducible",
       "The same cloth gets the same answer to the bit, alone or beside others.", "ours",
       same_bits_finding},
      {"self-collision.cached-pairs-match-a-fresh-search",
       "Pairs cached from step to step save searches and change no bit.", "ours",
       kept_pairs_finding},
      {"self-collision.tangles-come-apart",
       "Cloth that starts crossing itself along a line that cuts off a corner is pushed out of the "
       "tangle.",
       "Volino and Magnenat-Thalmann 2006", untangle_finding},
  };
}

}  // namespace foldproof
