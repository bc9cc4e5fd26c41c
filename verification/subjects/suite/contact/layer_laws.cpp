// Two sheets in one mesh, neither joined to the other: what layers of cloth do to each other.

#include "verification/oracles/exact_crossings.h"
#include "verification/subjects/suite/contact/obstacle_scenes.h"

namespace foldproof {

namespace {

using namespace suite;

constexpr int lower_cells = 4, upper_cells = 3;
constexpr double cell = 0.05;  // m

//        ------          upper: 3 x 3 cells
//     ------------       lower: 4 x 4 cells; gap [m] between them
PortableScene two_layers(const char* name, double gap) {
  const PortableScene upper = limp_sheet(upper_cells, cell);
  PortableScene scene =
      together(name, {limp_sheet(lower_cells, cell), shifted(upper, Vector3(0.031, 0.022, gap))});
  scene.thickness = drawn("thickness of layers", 0.007, 0.009);
  return scene;
}

Eigen::Index count_of(int cells) { return limp_sheet(cells, cell).x.cols(); }

// The lower layer's particles come first.
auto lower_of(const PerParticle3& x) { return x.leftCols(count_of(lower_cells)); }
auto upper_of(const PerParticle3& x) { return x.rightCols(count_of(upper_cells)); }
auto upper_of(PerParticle3& x) { return x.rightCols(count_of(upper_cells)); }

Vector3 momentum(const PortableScene& scene, const PerParticle3& v) { return v * scene.mass; }

Vector3 spin(const PortableScene& scene, const Snapshot& now) {
  return torque_of(now.x.colwise() - middle_of(scene.x), now.v * scene.mass.asDiagonal());
}

/// The upper layer thrown at the lower one, which is free, beside its middle.
Finding meeting_keeps_momentum(Trial& trial) {
  PortableScene scene = two_layers("layer thrown at a layer", 0.0);
  const double speed = 0.5;  // m/s
  upper_of(scene.x).row(2).array() += 3 * scene.thickness;
  upper_of(scene.v).colwise() = Vector3(0.1, -0.05, -speed);
  upper_of(scene.x).row(0).array() += 0.02;
  const std::vector<long> steps{5, 60};
  const std::vector<Snapshot> states = trial.motion(scene, steps);
  require_start_velocity(scene, states[0].x, steps[0]);
  const double unit = scene.mass.tail(count_of(upper_cells)).sum() * speed;  // kg m/s
  const Vector3 given = momentum(scene, states[1].v) - momentum(scene, scene.v);
  const double lever = largest(scene.x.colwise() - middle_of(scene.x));  // m
  const Vector3 turned = (spin(scene, states[1]) - spin(scene, {scene.x, scene.v}));
  const double down = -(lower_of(states[1].v) * scene.mass.head(count_of(lower_cells))).z() / unit;
  if (!(down > 0.1))
    throw FailedWithoutNumber(
        fmt::format("the lower layer gets {:.2g} of the upper one's momentum: they do not meet",
                    down),
        "layers that meet are compared");
  Table measured = table_of("momentum | gained [of the upper layer's]");
  measured.row("linear", given.norm() / unit);
  measured.row("angular, over the largest lever", turned.norm() / (unit * lever));
  return judge_worst(measured, 0.02,
                     "layers push each other with opposite forces in one line; friction between "
                     "them acts a thickness apart, and a first order method errs by a step's way");
}

Finding apart_are_left_alone(Trial& trial) {
  PortableScene scene = two_layers("layers farther apart than the thickness", 0);
  upper_of(scene.x).row(2).array() += 1.3 * scene.thickness;
  const long steps = 30;
  Table measured = table_of("gap [thickness] | largest displacement [thickness]");
  measured.row(1.3, largest(trial.after(scene, steps).x - scene.x) / scene.thickness);
  return judge_worst(measured, 0.02,
                     "layers may be kept one thickness apart, and no farther: at rest, they stay");
}

Finding part_freely(Trial& trial) {
  PortableScene scene = two_layers("layers that part", 0);
  upper_of(scene.x).row(2).array() += 0.8 * scene.thickness;
  const double speed = drawn("speed of layers that part", 0.3, 0.5);
  upper_of(scene.v).row(2).setConstant(speed);
  const long steps = 40;
  const PerParticle3 moved = trial.after(scene, steps).x - scene.x;
  const double way = upper_of(moved).row(2).mean() - lower_of(moved).row(2).mean(),
               free = speed * double(steps) * scene.dt;
  Table measured = table_of("parted by [m] | free way [m] | held back [of the free way]");
  measured.row(way, free, std::max(0.0, 1 - way / free));
  return judge_worst(measured, 0.05,
                     "nothing holds layers together; nearer than the thickness they may be pushed");
}

PortableScene layers_on_a_plane(const char* name) {
  PortableScene scene = two_layers(name, 0);
  upper_of(scene.x).row(2).array() += 1.2 * scene.thickness;
  scene.planes = {{{0.3, 0.2, 0}, Vector3::UnitZ(), 0.4}};
  scene.gravity = Vector3(0, 0, -weight);
  return scene;
}

Finding layer_lies_on_layer(Trial& trial) {
  trial.require("planes");
  const PortableScene scene = layers_on_a_plane("layer on a layer on a plane");
  const Allowance allowed = allowance(trial.declaration(), scene);
  Table measured = table_of(
      "steps [1] | crossings [1] | mean height of the upper layer [m] | "
      "deepest particle [m] | largest part of what is allowed [1]");
  const std::vector<long> steps{30, 60, 90, 120};
  const std::vector<Snapshot> states = trial.motion(scene, steps);
  for (size_t k = 0; k < steps.size(); ++k) {
    const PerParticle3& x = states[k].x;
    const double crossings = double(oracles::exact_crossings(x, scene.mesh.triangles).size()),
                 height = upper_of(x).row(2).mean() - lower_of(x).row(2).mean(),
                 deepest = std::max(0.0, -x.row(2).minCoeff());
    const double most = 1.2 * scene.thickness, under = height > 0 ? 0 : 2;
    measured.row(
        steps[k], crossings, height, deepest,
        std::max({crossings > 0 ? 2.0 : 0, height / most, deepest / allowed.depth, under}));
  }
  return judge_worst(measured, 1,
                     "pairs that meet are counted without rounding, any counts as 2; the upper "
                     "layer lies above the lower one, no higher than it began; a depth of 1 mm "
                     "cannot be seen");
}

Finding thickness_does_not_lift(Trial& trial) {
  PortableScene scene = limp_sheet(3, 0.02);
  scene.name = "thick sheet on a plane";
  scene.thickness = 0.008;
  scene.planes = {{{0.3, 0.2, 0}, Vector3::UnitZ(), 0.4}};
  scene.gravity = Vector3(0, 0, -weight);
  const Allowance allowed = allowance(trial.declaration(), scene);
  const double highest = trial.after(scene, 30).x.row(2).maxCoeff();
  Table measured = table_of("thickness [m] | highest particle [m] | of what is allowed [1]");
  measured.row(scene.thickness, highest, highest / allowed.height);
  return judge_worst(measured, 1,
                     "the thickness is that between layers; a tenth of an edge is left");
}

/// Edges shorter than the thickness: neighbours in a sheet are no layers.
/// Two pieces of cloth, the second one thrown down at the first, which is held.
PortableScene thrown_triangle(const char* name, const PerParticle3& held,
                              const PerParticle3& thrown) {
  PerParticle3 rest(3, 6);
  rest << held, thrown;
  PortableScene scene =
      resting(name, make_triangle_mesh(rest, {{0, 1, 2}, {3, 4, 5}}), {.young = 0.1});
  scene.held = {0, 1, 2};
  scene.dt = 0.002;
  scene.thickness = 0.004;
  scene.v.rightCols(3).row(2).setConstant(-1);
  return scene;
}

/// A small triangle over the middle of a large one; edges of two that lie crosswise.
Finding pairs_that_meet_stop(Trial& trial) {
  PerParticle3 large(3, 3), small(3, 3), one(3, 3), other(3, 3);
  large << -0.1, 0.1, 0, -0.1, -0.1, 0.2, 0, 0, 0;
  small << -0.01, 0.01, 0, -0.01, -0.01, 0.02, 0.011, 0.013, 0.012;
  one << -0.1, 0.1, 0, 0, 0, 0.2, 0, 0, 0;
  other << 0.01, 0.01, -0.2, -0.3, 0.5, 0.1, 0.011, 0.011, 0.3;
  Table measured = table_of("pieces | time [s] | edges in triangles [1]");
  for (const auto& [name, held, thrown] :
       {std::tuple("vertices over a triangle", large, small), {"edges crosswise", one, other}}) {
    const PortableScene scene = thrown_triangle(name, held, thrown);
    for (const long count : multiples(2, 5)) {
      const PerParticle3 x = trial.after(scene, count).x;
      const double lowest = x.rightCols(3).row(2).minCoeff();
      // wholly through: only the small one can be
      const bool is_through = held == large && lowest < -0.002;
      measured.row(
          name, double(count) * scene.dt,
          double(oracles::exact_crossings(x, scene.mesh.triangles).size()) + (is_through ? 1 : 0));
    }
  }
  return judge_worst(measured, 0, "pairs that meet are counted without rounding");
}

Finding fine_mesh_stays(Trial& trial) {
  PortableScene scene = limp_sheet(6, 0.01);
  scene.name = "sheet finer than its thickness";
  const double edge = rest_lengths(scene.mesh).mean();
  Table measured = table_of("thickness [of an edge] | largest displacement [of an edge]");
  for (const double part : {0.5, 1.5}) {
    scene.thickness = part * edge;
    measured.row(part, largest(trial.after(scene, 20).x - scene.x) / edge);
  }
  return judge_worst(measured, 0.02, "neighbours in a flat sheet are no layers: it is at rest");
}

}  // namespace

std::vector<Law> layer_laws() {
  const char* const self = "self_collision";
  return {
      {"self-collision.layers-that-meet-keep-momentum",
       "A layer that is thrown at another keeps their momentum, and their spin.",
       "action and reaction", meeting_keeps_momentum, self, "momentum | gained"},
      {"self-collision.layers-beyond-the-thickness-are-left-alone",
       "Layers at rest that are farther apart than the thickness stay where they are.",
       "PROTOCOL.md", apart_are_left_alone, "self_collision still"},
      {"self-collision.layers-part-freely", "Nothing holds layers that part.", "inertia",
       part_freely, self, "parted by | free way"},
      {"self-collision.layer-lies-on-a-layer-on-a-plane",
       "On a layer that lies on a plane another one comes to lie, no farther than the thickness.",
       "impenetrability", layer_lies_on_layer, self,
       "crossings | mean height of the upper layer | deepest particle"},
      {"self-collision.thickness-is-not-kept-from-planes",
       "A sheet that has a thickness against itself lies on a plane.", "PROTOCOL.md",
       thickness_does_not_lift, "self_collision planes still", "highest particle"},
      {"self-collision.vertices-and-edges-stop",
       "Held cloth stops a vertex inside of a triangle, and an edge that crosses an edge.",
       "impenetrability", pairs_that_meet_stop, "self_collision held"},
      {"self-collision.fine-mesh-stays-at-rest",
       "A flat sheet whose edges are shorter than its thickness stays at rest.", "PROTOCOL.md",
       fine_mesh_stays, "self_collision still"},
  };
}

}  // namespace foldproof
