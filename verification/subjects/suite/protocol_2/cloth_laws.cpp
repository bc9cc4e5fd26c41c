// What cloth may have besides: several materials, strain limits, air.
#include <algorithm>
#include <cmath>

#include "verification/subjects/suite/protocol_2/carriers.h"

namespace foldproof {

namespace {

using namespace suite;

PortableMaterial other_material(const PortableMaterial& one) {
  PortableMaterial other = one;
  other.density *= drawn("density of the other", 1.4, 1.8);
  other.young *= drawn("stiffness of the other", 0.4, 0.6);
  return other;
}

/// A stretched sheet that swings, of one material.
PortableScene patch(const PortableMaterial& material) {
  PortableScene scene = moving_sheet();
  scene.material = material;
  scene.mass = lumped_masses(scene.mesh, material.density);
  return scene;
}

/// Two patches that share no particle, the other one beside the first.
PortableScene two_patches(const PortableScene& one, const PortableScene& other) {
  PortableScene both = together("two patches", {one, shifted(other, Vector3(1, 0, 0))});
  both.materials = {one.material, other.material};
  both.material_of_triangle.assign(one.mesh.triangles.size(), 0);
  both.material_of_triangle.resize(both.mesh.triangles.size(), 1);
  return both;
}

/// Patches of two materials in one scene move as each does alone.
Finding materials_are_those_of_triangles(Trial& trial) {
  const PortableScene one = patch(moving_sheet().material),
                      other = patch(other_material(one.material));
  const PortableScene both = two_patches(one, other);
  constexpr long steps = 6;
  const Snapshot together = trial.after(both, steps);
  Table measured = table_of("patch [1] | way [m] | difference from the patch alone [of its way]");
  int first = 0, number = 1;
  double rounding = 0;
  for (const PortableScene* alone : {&one, &other}) {
    const Eigen::Index n = alone->x.cols();
    PerParticle3 x = together.x.middleCols(first, n);
    if (number == 2) x.row(0).array() -= 1;
    const double way = largest(x - alone->x);
    measured.row(number, way, largest(x - trial.after(*alone, steps).x) / way);
    rounding = std::max(rounding,
                        rounding_error(both, steps, trial.declaration()) * largest(both.x) / way);
    first += int(n), ++number;
  }
  return judge_worst(measured, narrow(rounding, trial.declaration()),
                     "patches that share nothing do not act on each other: rounding");
}

constexpr double of_first = 0.4;  // mu of the first of two materials

/// Two small sheets on a slope of the obstacle, each of a material. The second has this coefficient
/// of its own; none: it has the obstacle's. They lie in one place and, without a thickness, do not
/// act on each other. Triangles are listed in another order than particles.
PortableScene sheets_of_own_friction(const Carrier& carrier, double slope,
                                     const std::optional<double>& own) {
  const PortableScene one = sheet_on_top("");
  const double heading = drawn("way down of materials", 0, 6), angle = std::atan(slope);
  const Vector3 down(std::cos(heading), std::sin(heading), 0);
  PortableScene scene = together("sheets of materials with friction", {one, one});
  scene.gravity = weight * (std::sin(angle) * down - std::cos(angle) * Vector3::UnitZ());
  carrier.put(scene, 0.25, carrier.standing());
  scene.materials = {one.material, one.material};
  scene.materials[0].friction = of_first, scene.materials[1].friction = own;
  scene.material = scene.materials[0];
  std::vector<Triangle> triangles = scene.mesh.triangles;
  std::ranges::reverse(triangles);
  scene.mesh = make_triangle_mesh(scene.mesh.rest, triangles);
  scene.material_of_triangle.assign(one.mesh.triangles.size(), 1);
  scene.material_of_triangle.resize(triangles.size(), 0);
  return scene;
}

/// No friction of its own, little, much, and none stated: on each kind of obstacle.
Finding materials_rub_by_themselves(Trial& trial) {
  Table measured = table_of(
      "obstacle | mu of the material | way down [m] | by Coulomb's law [m] | difference [of the "
      "frictionless way]");
  constexpr long steps = 50;
  constexpr double slope = 0.45;
  for_each_carrier(trial, [&](const Carrier& carrier) {
    for (const std::optional<double>& own :
         {std::optional(0.0), std::optional(drawn("mu of a material", 0.1, 0.15)),
          std::optional(drawn("mu of another", 0.55, 0.6)), std::optional<double>()}) {
      const PortableScene scene = sheets_of_own_friction(carrier, slope, own);
      const double time = steps * scene.dt,
                   free = weight * std::sin(std::atan(slope)) * time * time / 2;
      const Vector3 down = Vector3(scene.gravity.x(), scene.gravity.y(), 0).normalized();
      const PerParticle3 ways = trial.after(scene, steps).x - scene.x;
      const Eigen::Index half = ways.cols() / 2;
      for (const auto& [way, mu] : {std::pair(ways.leftCols(half).eval(), std::optional(of_first)),
                                    {ways.rightCols(half), own}}) {
        const double due = std::max(0.0, 1 - mu.value_or(0.25) / slope) * free;
        const Vector3 mean = way.rowwise().mean();
        measured.row(carrier.capability, mu ? fmt::format("{:.3g}", *mu) : "none stated",
                     mean.dot(down), due, (mean - due * down).norm() / free);
      }
    }
  });
  return judge_worst(measured, 0.05,
                     "a first order method errs by 2 %, the step in which contact begins by as "
                     "much, and the sheet's own waves by 1 %");
}

/// A small sheet lies on a large one that is held; gravity is tilted.
PortableScene layer_on_layer(double slope, double heading, double friction) {
  PortableScene lower = sheet_at_rest(), upper = small_sheet();
  for (int i = 0; i < int(lower.x.cols()); ++i) lower.held.push_back(i);
  const double thickness = drawn("thickness of layers", 0.004, 0.006);  // m
  const Vector3 onto = middle_of(lower.x) - middle_of(upper.x) + thickness * Vector3::UnitZ();
  PortableScene both = together("layer on a layer", {lower, shifted(upper, onto)});
  both.thickness = thickness, both.layer_friction = friction;
  const double along = weight * std::sin(slope);
  both.gravity << along * std::cos(heading), along * std::sin(heading), -weight * std::cos(slope);
  return both;
}

Finding layers_rub_as_coulomb_says(Trial& trial) {
  Table measured = table_of(
      "slope [rad] | mu [1] | way down [m] | by Coulomb's law [m] | "
      "difference [of the frictionless way]");
  constexpr long steps = 60;
  for (const auto& [slope, mu] : {std::pair(0.2, 0.5), {0.4, 0.15}, {0.5, 0.3}}) {
    const double heading = drawn("heading of layers", 0, 6);
    const PortableScene scene = layer_on_layer(slope, heading, mu);
    const Eigen::Index upper = scene.x.cols() - Eigen::Index(scene.held.size());
    const double time = steps * scene.dt, free = weight * std::sin(slope) * time * time / 2;
    const Vector3 way = (trial.after(scene, steps).x - scene.x).rightCols(upper).rowwise().mean();
    const Vector3 down(std::cos(heading), std::sin(heading), 0);
    const double expected = std::max(0.0, 1 - mu / std::tan(slope)) * free;
    measured.row(slope, mu, way.dot(down), expected,
                 (Vector3(way.x(), way.y(), 0) - expected * down).norm() / free);
  }
  return judge_worst(measured, 0.05,
                     "a first order method errs by 2 %, the step in which contact begins by 1 %, "
                     "and the layer's own waves by 1 %");
}

/// A soft sheet stretched by its weight; without limits its upper edges would be far longer.
Finding strain_limits_are_kept(Trial& trial) {
  PortableScene scene = hanging_sheet();
  scene.name = "limp sheet with strain limits";
  scene.held = {0, 1, 2, 3, 4, 5, 6};
  const double limit = drawn("largest extension", 0.06, 0.09);
  scene.strain_limits = {limit, 0.9};
  PortableScene free = scene;
  free.strain_limits.reset();
  constexpr long steps = 150;
  const auto most = [&](const PerParticle3& x) {
    double extension = 0;
    const Eigen::VectorXd lengths = rest_lengths(scene.mesh);
    for (size_t e = 0; e < scene.mesh.edges.size(); ++e) {
      const Edge& edge = scene.mesh.edges[e];
      extension = std::max(extension,
                           (x.col(edge.a) - x.col(edge.b)).norm() / lengths[Eigen::Index(e)] - 1);
    }
    return extension;
  };
  const double without = most(trial.after(free, steps).x);
  if (!(without > 2 * limit))
    throw CannotTell(
        fmt::format("nothing happened: without limits no edge is longer than {:.3g}", 1 + without));
  Table measured = table_of(
      "steps [1] | limit [1] | extension without limits [1] | largest extension [1] | beyond the "
      "limit [of it]");
  std::vector<long> at = multiples(steps / 5, 5);
  const std::vector<Snapshot> states = trial.motion(scene, at);
  for (size_t k = 0; k < at.size(); ++k) {
    const double extension = most(states[k].x);
    measured.row(at[k], limit, without, extension, extension / limit - 1);
  }
  return judge_worst(measured, 0.1,
                     "sweeps end when limits are kept to a thousandth of a length, 2 % of this "
                     "limit; a tenth is more than any of them leaves");
}

/// A flat sheet that falls broadside stays flat: v = v_e tanh(g t/v_e), with drag like gravity.
Finding air_drags_a_falling_sheet(Trial& trial) {
  Table measured = table_of(
      "density of air [kg/m^3] | wind [m/s] | speed [m/s] | by the law of drag [m/s] | difference "
      "[of the speed that is lost]");
  constexpr long steps = 150;
  for (const double wind : {0.0, drawn("wind", 0.5, 0.8)}) {
    PortableScene scene = falling_sheet();
    scene.name = "sheet falling broadside in air";
    const PortableAir air{drawn("density of air", 1.1, 1.3), Vector3(0, 0, -wind),
                          drawn("normal drag", 1.0, 1.3), 0};
    scene.air = air;
    const double end = steps * scene.dt,
                 factor = air.density * air.normal_drag / (2 * scene.material.density);
    // relative to the air it starts at -wind, and tends to the speed at which drag is the weight
    const double ends_at = std::sqrt(weight / factor);
    const double due =
        wind + ends_at * std::tanh(weight * end / ends_at - std::atanh(wind / ends_at));
    const double speed = -trial.after(scene, steps).v.row(2).mean();
    measured.row(air.density, wind, speed, due,
                 std::abs(speed - due) / std::abs(weight * end - due));
  }
  return judge_worst(measured, 0.05,
                     "a first order method errs by a step of the lost speed's growth, 2 dt/t = "
                     "1.3 %; velocities of the start of a step, by as much again");
}

}  // namespace

std::vector<Law> cloth_laws() {
  return {
      {"materials.each-triangle-has-its-own",
       "Patches of two materials in one scene move as each does alone.", "protocol",
       materials_are_those_of_triangles, "materials"},
      {"materials.rub-by-their-own-coefficient",
       "A material with a coefficient of friction slides by it, others by the obstacle's.",
       "protocol", materials_rub_by_themselves, "materials material_friction",
       "mu of the material | way down | by Coulomb's law"},
      {"strain-limits.are-kept", "Where strain is limited, no edge gets longer.", "protocol",
       strain_limits_are_kept, "held strain_limits", "limit | largest extension"},
      {"layers.rub-as-coulomb-says",
       "A layer on another one sticks, or slides, as Coulomb's law says.", "Coulomb",
       layers_rub_as_coulomb_says, "held self_collision layer_friction",
       "slope | mu | way down | by Coulomb's law"},
      {"air.drags-a-falling-sheet",
       "A flat sheet that falls broadside in air, or in wind, gains speed as drag allows.",
       "law of drag", air_drags_a_falling_sheet, "air", "speed | by the law of drag"},
  };
}

}  // namespace foldproof
