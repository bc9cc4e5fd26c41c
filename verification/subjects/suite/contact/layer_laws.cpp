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
  const Vector3 given = momentum_of(scene, states[1].v) - momentum_of(scene, scene.v);
  const double lever = largest(scene.x.colwise() - middle_of(scene.x));  // m
  const Vector3 turned = (spin_of(scene, states[1]) - spin_of(scene, {scene.x, scene.v}));
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

/// Layers that pass through each other where a scene has no thickness, after one that has.
Finding thickness_goes_with_its_scene(Trial& trial) {
  PortableScene thick = two_layers("layers that may not pass", 0), thin = thick;
  upper_of(thick.x).row(2).array() += 1.5 * thick.thickness;
  thin.name = "layers that may pass, after a scene with a thickness";
  upper_of(thin.x).row(2).array() += 1.5 * thick.thickness;
  thin.thickness = 0;
  const double speed = 0.4;  // m/s
  const long steps = 30;     // through the other one
  trial.motion(thick, {3});
  upper_of(thin.v).row(2).setConstant(-speed);
  const PerParticle3 moved = trial.after(thin, steps).x - thin.x;
  const double way = lower_of(moved).row(2).mean() - upper_of(moved).row(2).mean(),
               free = speed * double(steps) * thin.dt;
  Table measured = table_of("way of one past the other [m] | free way [m] | difference [of it]");
  measured.row(way, free, std::abs(way - free) / free);
  return judge_worst(measured, 0.05, "without a thickness nothing holds layers apart");
}

/// Particle over particle, edge over edge, with and without a second upper layer.
Finding aligned_layers_stop(Trial& trial) {
  Table measured = table_of(
      "layers [1] | speed [m/s] | crossings [1] | least gap of neighbours' particles [thickness]");
  const PortableScene sheet = limp_sheet(3, cell);
  const Eigen::Index count = sheet.x.cols();
  const double thickness = drawn("thickness of aligned layers", 0.007, 0.009);
  for (const auto& [layers, speed] :
       {std::pair(2, 0.4), {3, 0.4}, {2, drawn("speed of aligned layers", 30, 40)}}) {
    std::vector<PortableScene> all;
    for (int k = 0; k < layers; ++k) all.push_back(shifted(sheet, {0, 0, 2.5 * k * thickness}));
    PortableScene scene = together("layers that meet, particle over particle", all);
    scene.thickness = thickness;
    for (int k = 0; k < layers; ++k)
      scene.v.middleCols(k * count, count).row(2).setConstant(-speed * k);
    for (const Snapshot& now : trial.motion(scene, {20, 40, 60})) {
      double gap = INFINITY;
      for (int k = 1; k < layers; ++k)
        for (Eigen::Index i = 0; i < count; ++i)
          gap = std::min(gap, now.x(2, k * count + i) - now.x(2, (k - 1) * count + i));
      const auto crossings = oracles::exact_crossings(now.x, scene.mesh.triangles).size();
      measured.row(layers, speed, double(crossings), gap / thickness);
    }
  }
  Worst passed;
  for (const double gap : measured.numbers("least gap of neighbours' particles"))
    passed.observe(-gap);
  for (const double crossings : measured.numbers("crossings")) passed.observe(crossings);
  return {{passed.value(), 0, 0, "1", "no layer passes another"}, measured, ""};
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

/// The upper layer slides on the lower one, which is held, where the scene states no friction.
Finding layers_slide_freely(Trial& trial) {
  PortableScene scene = two_layers("layer that slides on a held layer", 0);
  upper_of(scene.x).row(2).array() += 1.1 * scene.thickness;
  for (int i = 0; i < int(lower_of(scene.x).cols()); ++i) scene.held.push_back(i);
  scene.gravity = Vector3(0, 0, -weight);
  const Vector3 velocity(0.3, -0.4, 0);  // m/s
  upper_of(scene.v).colwise() = velocity;
  constexpr long steps = 40;
  const Snapshot end = trial.after(scene, steps);
  const double time = double(steps) * scene.dt,
               fallen = -(upper_of(end.x) - upper_of(scene.x)).row(2).mean() /
                        (weight * time * time / 2);
  if (!(fallen < 0.5))
    throw FailedWithoutNumber("the upper layer falls through the lower one", "a layer on a layer");
  const Vector3 lost = velocity - upper_of(end.v).rowwise().mean();
  const double along = lost.dot(velocity.normalized());
  Table measured = table_of("speed [m/s] | lost [m/s] | lost to friction [of g t]");
  measured.row(velocity.norm(), along, along / (weight * time));
  return judge_worst(measured, 0.05,
                     "no friction is stated; vertices that meet edges of a layer that sags turn a "
                     "part of their push");
}

/// Layers of a stack lie shifted, so that vertices, edges and triangles meet in all ways.
Finding stack_keeps_its_order(Trial& trial) {
  constexpr int count = 6;
  const PortableScene layer = limp_sheet(3, cell);
  const double thickness = drawn("thickness of a stack", 0.006, 0.008);
  std::vector<PortableScene> layers;
  for (int k = 0; k < count; ++k) {
    const double turn = drawn("turn of a stack", 1, 2) * k;
    layers.push_back(shifted(
        layer, {0.3 * cell * std::cos(turn), 0.3 * cell * std::sin(turn), 1.5 * thickness * k}));
  }
  for (int i = 0; i < int(layer.x.cols()); ++i) layers[0].held.push_back(i);
  PortableScene scene = together("stack of layers", layers);
  scene.thickness = thickness;
  scene.gravity = Vector3(0, 0, -weight);
  Table measured =
      table_of("steps [1] | crossings [1] | crossings and layers below the one below them [1]");
  const std::vector<long> steps{40, 80, 120};
  const std::vector<Snapshot> states = trial.motion(scene, steps);
  for (size_t k = 0; k < steps.size(); ++k) {
    const auto height = [&](int of) {
      return states[k].x.middleCols(of * layer.x.cols(), layer.x.cols()).row(2).mean();
    };
    int wrong = 0;
    for (int of = 1; of < count; ++of) wrong += height(of) > height(of - 1) ? 0 : 1;
    const auto crossings = oracles::exact_crossings(states[k].x, scene.mesh.triangles).size();
    measured.row(steps[k], crossings, wrong + int(crossings));
  }
  return judge_worst(measured, 0, "pairs that meet are counted without rounding");
}

/// Edges shorter than the thickness: neighbours in a sheet are no layers.
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
      {"self-collision.layers-slide-where-no-friction-is-stated",
       "Where the scene states no friction of layers, one slides freely on another.",
       "protocol: 'layer_friction'", layers_slide_freely, "self_collision held",
       "lost to friction"},
      {"self-collision.layer-lies-on-a-layer-on-a-plane",
       "On a layer that lies on a plane another one comes to lie, no farther than the thickness.",
       "impenetrability", layer_lies_on_layer, self,
       "crossings | mean height of the upper layer | deepest particle"},
      {"self-collision.thickness-is-not-kept-from-planes",
       "A sheet that has a thickness against itself lies on a plane.", "PROTOCOL.md",
       thickness_does_not_lift, "self_collision planes still", "highest particle"},
      {"self-collision.thickness-goes-with-its-scene",
       "Layers of a scene without a thickness pass, even if the scene before had one.",
       "protocol: 'thickness'", thickness_goes_with_its_scene, "self_collision",
       "way of one past the other | free way"},
      {"self-collision.aligned-layers-stop",
       "Layers whose particles and edges lie over each other's do not pass through, slow or fast.",
       "impenetrability", aligned_layers_stop, "self_collision"},
      {"self-collision.stack-keeps-its-order",
       "Of six layers that fall on each other, each stays above the one below.", "impenetrability",
       stack_keeps_its_order, "self_collision held"},
      {"self-collision.fine-mesh-stays-at-rest",
       "A flat sheet whose edges are shorter than its thickness stays at rest.", "PROTOCOL.md",
       fine_mesh_stays, "self_collision still"},
  };
}

}  // namespace foldproof
