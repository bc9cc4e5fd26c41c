// pointwise-contact: what lies between the particles, when they alone are held out of an object.

#include "convergence/contact/contact_runs.h"
#include "convergence/study.h"
#include "verification/oracles/dense_algebra.h"

namespace foldproof {

namespace {

constexpr double radius = 0.2, side = 0.22;  // of the ball, of the sheet [m]

Scene sheet_on_ball(int n, PointKind points) {
  Scene scene = level_sheet(n, side, {0, radius + 0.002, 0});
  scene.stretch->damping = 0.3;
  scene.objects.push_back(solid_object("ball", Sphere{radius}, 0.5));
  scene.collision.points = points;
  return scene;
}

double longest_edge(const Scene& scene, const State& state) {
  Worst longest;
  for (const Edge& edge : scene.mesh.edges)
    longest.observe((state.x.col(edge.a) - state.x.col(edge.b)).norm());
  return longest.value();
}

/// How deep edges and triangles are once the sheet lies on the ball, over the length of a diagonal
/// edge at rest; and the longest edge as it is then.
Table cuts(const Subject& subject, const std::vector<int>& meshes, PointKind points) {
  return refine({{"edge", "m"},
                 {"depth of midpoints", "m"},
                 {"depth of centres", "m"},
                 {"longest edge, stretched", "m"}},
                meshes, [&](int n) {
                  const Scene scene = sheet_on_ball(n, points);
                  const State end = run_to_end(subject, scene, usual_step(scene), 0.4);
                  const Depths depths = depths_of(scene, end);
                  return std::tuple{std::sqrt(2.0) * side / n, depths.edges, depths.faces,
                                    longest_edge(scene, end)};
                });
}

NamedFinding order_finding(const Table& cut) {
  return {
      "pointwise-contact.edge-penetration-is-second-order",
      "Edges whose ends lie on a ball cut into it by the square of their length.",
      {order_verdict(
           convergence_of(cut, "depth of midpoints"), 2, 2, 0.1,
           "a chord of length L is L^2/(8R) deep, and another power is off by 1; between meshes "
           "whose "
           "edges differ by a factor of one and a half, a tenth of an order is four percent of a "
           "depth, more than the scatter from how the longest edges happen to lie along the ball"),
       cut, "measured is |order - 2| of the last two pairs"}};
}

NamedFinding bound_finding(const Table& cut) {
  const std::vector<double>&lengths = cut.numbers("longest edge, stretched"),
        &depths = cut.numbers("depth of midpoints");
  Worst worst;
  for (size_t k = 0; k < lengths.size(); ++k) {
    const double half = lengths[k] / 2;
    worst.observe(depths[k] / (radius - std::sqrt(radius * radius - half * half)));
  }
  return {
      "pointwise-contact.edge-penetration-is-within-the-chord",
      "No edge is deeper than a chord of the longest edge's length.",
      {{worst.value(), 1.001, 0, "1",
        "R - sqrt(R^2 - L^2/4) of the longest edge as it is stretched, its ends on the ball or "
        "outside; a thousandth for what a step leaves on a curved surface, the square of its way"},
       with_columns(cut, {"longest edge, stretched", "depth of midpoints"})}};
}

NamedFinding held_finding(const Table& particles, const Table& faces) {
  const double alone = particles.numbers("depth of centres").front(),
               held = faces.numbers("depth of centres").front();
  return {"pointwise-contact.centres-help-coarse-cloth",
          "With midpoints and centres as points, the centres of coarse triangles stay out.",
          {{held / alone, 0.1, 0, "1",
            "a step's error on a curved surface, the square of its displacement over the radius, "
            "is far below a tenth of a chord's depth"},
           Table("edge [m]; particles alone [m]; centres too [m]")
               .with_row(faces.numbers("edge").front(), alone, held),
           "of the coarsest mesh"}};
}

/// A thin upright pin under the middle of a cell.
NamedFinding spike_finding(const Subject& subject) {
  Scene scene = level_sheet(8, 0.3, {0.3 / 24, 0.03, 0.3 / 48});
  const Capsule pin{0.003, 0.6};
  scene.objects.push_back(solid_object("pin", pin, 0));
  auto& body = std::get<RigidObject>(scene.objects[0].object.body);
  body.place = {oracles::rotation_between(Vector3::UnitZ(), Vector3::UnitY()), {0, -0.6, 0}};
  const State end = run_to_end(subject, scene, usual_step(scene), 0.25);
  const double height = end.x.row(1).mean();
  return {
      "pointwise-contact.a-thin-pin-passes-through",
      "A pin thinner than an edge passes between the particles of a falling sheet.",
      {{height, -0.2, 0, "m",
        "in a quarter of a second it falls by 0.3 m, from 0.03 m above the pin's tip: had the pin "
        "held it, it would hang there"},
       Table("radius of the pin [m]; edge of the cloth [m]; mean height [m]")
           .with_row(pin.radius, scene.mesh.rest.col(1).x() - scene.mesh.rest.col(0).x(), height),
       "measured is the sheet's mean height over the pin's tip"}};
}

StudyResult run_pointwise_contact(const Subject& subject, Tier tier, const Progress& progress) {
  std::vector<int> meshes = {4, 6, 9, 13};
  if (tier == Tier::full) meshes.push_back(20);
  const Table particles = cuts(subject, meshes, PointKind::particles);
  progress(0.6);
  const Table faces = cuts(subject, {meshes.front()}, PointKind::faces);
  StudyResult result;
  result.findings = {order_finding(particles), bound_finding(particles),
                     held_finding(particles, faces), spike_finding(subject)};
  result.figures.push_back(
      {"depth",
       "How deep edges and triangles lie in a ball that holds the particles out",
       {"edge", "m", Scale::log},
       {"depth", "m", Scale::log},
       2,
       "A sheet at rest on a ball of radius 0.2 m. Chord: L^2/(8R).",
       {curve_of("midpoints of edges", particles, "edge", "depth of midpoints"),
        curve_of("centres of triangles", particles, "edge", "depth of centres"),
        curve_over("chord", particles.numbers("edge"),
                   [](double L) { return L * L / (8 * radius); })}});
  return result;
}

}  // namespace

Study pointwise_contact_study() {
  return {"pointwise-contact",
          "Edges between particles cut into a ball by the square of their length, no deeper than "
          "chords; a pin thinner than an edge passes through.",
          {"edge-penetration-is-second-order", "edge-penetration-is-within-the-chord",
           "a-thin-pin-passes-through"},
          "BMF03 section 5.2",
          "The response holds points out of objects. What lies between the points is held out only "
          "as far as the object is flat from one point to the next.",
          run_pointwise_contact};
}

}  // namespace foldproof
