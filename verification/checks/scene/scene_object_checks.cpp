// Objects and their contact with cloth in case files.
#include "verification/specimens/check.h"
#include "verification/specimens/trial_cases.h"

namespace foldproof {

namespace {

const std::string three_objects = R"(
[[hold]]
particles = [3]
[[object]]
shape = "capsule"
radius = 0.13
length = 0.7
friction = 0.31
turn = { axis = [1, -2, 0.5], angle = 41 }
move = [0.2, -0.3, 0.5]
velocity = [0.4, 0.1, -0.2]
angular_velocity = [30, 0, -50]
center = [0.1, 0.7, 0.2]
[[object]]
name = "board"
shape = "box"
size = [0.6, 0.4, 0.02]
[[object.keyframe]]
time = 0.2
[[object.keyframe]]
time = 0.8
move = [0.3, 0.5, -0.1]
turn = { axis = [0, 0, 1], angle = 60 }
[[object]]
shape = "torus"
ring_radius = 0.5
tube_radius = 0.1
[collision]
forecast_time = 0.017
points = "edges"
response = "projection"
)";

double distance_of(const SceneObject& part, const Vector3& p, double t) {
  return std::get<RigidObject>(part.object.body).at(p, {t, t, 0}).phi;
}

Vector3 rotate(double degrees, const Vector3& axis, const Vector3& x) {
  return Eigen::AngleAxisd(degrees * pi / 180, axis.normalized()) * x;
}

/// Distances that the solids must have at a time, worked out by hand from the case's text.
void see_places(const Scene& scene, Differences& differences) {
  const Vector3 tip = rotate(41, {1, -2, 0.5}, {0, 0, 0.35}) + Vector3(0.2, -0.3, 0.5);
  const Vector3 out = rotate(41, {1, -2, 0.5}, {0, 0, 1});
  differences.is_near("capsule, off its end",
                      distance_of(scene.objects[0], tip + 0.4 * out, 0) - 0.27);
  const double t = 0.6;
  const Vector3 rate(30, 0, -50), center(0.1, 0.7, 0.2);
  const Vector3 later =
      rotate(rate.norm() * t, rate, tip - center) + center + t * Vector3(0.4, 0.1, -0.2);
  const Vector3 later_out = rotate(rate.norm() * t, rate, out);
  differences.is_near("capsule, moved",
                      distance_of(scene.objects[0], later + 0.4 * later_out, t) - 0.27);
  differences.is_near("board at rest", distance_of(scene.objects[1], {0.1, 0.1, 0.31}, 0.1) - 0.3);
  const Vector3 half = rotate(30, {0, 0, 1}, {0.8, 0, 0}) + 0.5 * Vector3(0.3, 0.5, -0.1);
  differences.is_near("board half way", distance_of(scene.objects[1], half, 0.5) - 0.5);
  differences.is_near("ring", distance_of(scene.objects[2], {0.5, 0, 0.3}, 0) - 0.2);
}

Finding meaning_finding() {
  const Scene scene = trial_scene(three_objects);
  Differences differences;
  differences.is("there are three", scene.objects.size() == 3);
  differences.is_near("friction", scene.objects.at(0).object.friction - 0.31);
  differences.is_near("no friction", scene.objects[1].object.friction);
  differences.is("names", scene.objects[1].object.name == "board" &&
                              scene.objects[2].object.name == "torus 3");
  see_places(scene, differences);
  differences.is_near("forecast time", scene.collision.forecast_time - 0.017);
  const System system = build_system(scene);
  const auto& filter = std::get<ObjectCollision>(system.filters.at(0));
  differences.is_near("forecast time, built", filter.forecast_time - 0.017);
  differences.is("response", filter.response.name == "projection");
  const size_t points = size_t(scene.mesh.particles()) - 1 + scene.mesh.edges.size();
  differences.is("particles but the held one, and midpoints", filter.points.size() == points);
  const Scene one =
      trial_scene("[[object]]\nshape = \"sphere\"\nradius = 0.3\n", {"object.radius=0.7"});
  differences.is_near("the only entry needs no number",
                      distance_of(one.objects.at(0), {1, 0, 0}, 0) - 0.3);
  return differences.judged(30,
                            "rotations and distances of lengths below 2 m: a dozen roundings each");
}

/// The drawn surface lies on the solid, except for its facets.
Finding surface_finding() {
  const Scene scene = trial_scene(three_objects);
  Worst off;
  double outward = 0, triangles = 0;
  for (const SceneObject& part : scene.objects) {
    for (Eigen::Index i = 0; i < part.vertices.cols(); ++i)
      off.observe(std::abs(distance_of(part, part.vertices.col(i), 0)));
    for (const Triangle& t : part.triangles) {
      const Vector3 a = part.vertices.col(t[0]), b = part.vertices.col(t[1]),
                    c = part.vertices.col(t[2]);
      const Vector3 middle = (a + b + c) / 3;
      const Vector3 n = std::get<RigidObject>(part.object.body).at(middle, {0, 0, 0}).normal;
      outward += (b - a).cross(c - a).dot(n) > 0 ? 1 : 0;
      triangles += 1;
    }
  }
  const double inwards = triangles - outward;
  return {{inwards > 0 ? inwards : off.value(), 1e-7, 0, "m",
           "corners lie on the surface; those round the capsule's poles, a thousandth of its "
           "radius from the axis, stand off by half the square of that, 0.07 micrometres"},
          Table{{"triangles that face inwards", "1"}, {"corners off the surface", "m"}}.with_row(
              inwards, off.value()),
          "triangles that face inwards, if there are any, are counted instead"};
}

std::vector<RejectedCase> rejections() {
  const std::string ball = "[[object]]\nshape = \"sphere\"\nradius = 0.3\n";
  return {
      {"[[object]]\nshape = \"sphere\"\n", {"radius"}},
      {"[[object]]\nshape = \"sphere\"\nradius = 0\n", {"'radius' must be > 0"}},
      {"[[object]]\nshape = \"ball\"\nradius = 1\n", {"unknown shape 'ball'", "sphere", "torus"}},
      {"[[object]]\nradius = 0.3\n", {"either 'shape' or 'mesh'"}},
      {ball + "mesh = \"x.obj\"\n", {"not both"}},
      {ball + "frictoin = 0.3\n", {"unknown key 'frictoin'", "friction"}},
      {ball + "friction = -0.3\n", {"'friction' must not be negative"}},
      {ball + "size = [1, 1, 1]\n", {"unknown key 'size'"}},
      {"[[object]]\nshape = \"box\"\nsize = [1, 0, 1]\n", {"'size' must be > 0"}},
      {"[[object]]\nshape = \"torus\"\nring_radius = 0.1\ntube_radius = 0.2\n",
       {"smaller than 'ring_radius'"}},
      {"[[object]]\nmesh = \"nowhere.obj\"\n", {"there is no mesh file", "nowhere.obj"}},
      {ball + "[[object.keyframe]]\ntime = 1\n[[object.keyframe]]\ntime = 1\n", {"must rise"}},
      {ball + "[[object.keyframe]]\ntime = 1\nmvoe = [0, 0, 1]\n", {"unknown key 'mvoe'", "move"}},
      {ball + "velocity = [0, 0, 1]\n[[object.keyframe]]\ntime = 1\n", {"unknown key 'velocity'"}},
      {ball + "[collision]\nforecast_time = 0\n", {"'forecast_time' must be > 0"}},
      {ball + "[collision]\npoints = \"corners\"\n", {"unknown points 'corners'", "edges"}},
      {ball + "[collision]\nresponse = \"bounce\"\n", {"unknown response 'bounce'", "forecast"}},
      {ball + "[collision]\ntau = 0.1\n", {"unknown key 'tau'", "forecast_time"}},
      {"[collision]\npoints = \"edges\"\n", {"needs an [[object]]"}}};
}

Finding rejection_finding() { return rejected_cases(rejections()); }

}  // namespace

std::vector<Check> scene_object_checks() {
  return {{"scene.objects-are-as-written",
           "Objects have the place, motion, friction and response that the case says.",
           "cases/KEYS.md", meaning_finding},
          {"scene.drawn-surfaces-match-their-solids",
           "The surface drawn of an object is that of its solid, facing outwards.", "cases/KEYS.md",
           surface_finding},
          {"scene.invalid-objects-are-rejected",
           "Invalid settings of objects are refused with file, line and what is known.",
           "cases/KEYS.md", rejection_finding}};
}

}  // namespace foldproof
