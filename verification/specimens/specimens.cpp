#include "verification/specimens/specimens.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "reference/mesh/shapes.h"
#include "verification/seeds.h"
#include "verification/specimens/random.h"

namespace foldproof {

namespace {

std::vector<double> random_angles(Random& random, size_t count) {
  std::vector<double> angles(count);
  for (double& angle : angles) angle = random.uniform(-0.9, 0.9);
  return angles;
}

/// The mesh displaced at random; `edge` [m] is the unit of the displacements.
Specimen crumple_specimen(const std::string& name, TriangleMesh mesh, double edge, unsigned seed) {
  Random random(seed);
  Specimen specimen{name, scene_at_rest(std::move(mesh), 0.23), {}};
  Scene& scene = specimen.scene;
  const Eigen::Index count = scene.x.cols();
  scene.rest_angles = random_angles(random, scene.mesh.hinges.size());

  PerParticle3 displacement = random.vectors(count, 0.2 * edge);
  const bool is_flat = scene.x.row(2).cwiseAbs().maxCoeff() == 0;
  if (is_flat) displacement.row(2) *= 1.75;
  scene.x += displacement;
  scene.v = random.vectors(count, 1.5);
  specimen.state = start_state(scene);
  return specimen;
}

Sheet sheet_of(SheetPattern pattern) { return {pattern, 0.43, 0.31, 6, 5, 0.24, shifted_seed(71)}; }

Specimen at_rest(const std::string& name, TriangleMesh mesh) {
  Specimen specimen{name, scene_at_rest(std::move(mesh), 0.31), {}};
  specimen.scene.rest_angles = hinge_angles(specimen.scene.mesh, specimen.scene.mesh.rest);
  specimen.state = start_state(specimen.scene);
  return specimen;
}

TriangleMesh pleats() {
  Sheet sheet = sheet_of(SheetPattern::one_diagonal);
  sheet.columns = 9;
  const TriangleMesh flat = make_sheet(sheet);
  return make_triangle_mesh(pleated_positions(flat, 3, 2.3), flat.triangles);
}

double aspect_ratio(const Vector3& a, const Vector3& b, const Vector3& c) {
  const Vector3 normal = (b - a).cross(c - a);
  const double longest =
      std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return longest / normal.norm();
}

}  // namespace

std::vector<Specimen> crumpled_sheets() {
  return {
      crumple_specimen("one_diagonal", make_sheet(sheet_of(SheetPattern::one_diagonal)), 0.066, 3),
      crumple_specimen("equilateral", make_sheet(sheet_of(SheetPattern::equilateral)), 0.066, 5),
      crumple_specimen("union_jack", make_sheet(sheet_of(SheetPattern::union_jack)), 0.066, 7),
      crumple_specimen("criss_cross", make_sheet(sheet_of(SheetPattern::criss_cross)), 0.044, 11),
      crumple_specimen("jittered", make_sheet(sheet_of(SheetPattern::jittered)), 0.066, 13),
      crumple_specimen("random_delaunay", make_sheet(sheet_of(SheetPattern::random_delaunay)), 0.05,
                       17),
      crumple_specimen("disc", make_disc(0.29, 4), 0.07, 19),
      crumple_specimen("icosphere", make_icosphere(0.17, 1), 0.1, 23)};
}

std::vector<Specimen> small_crumpled_sheets() {
  Sheet even = sheet_of(SheetPattern::one_diagonal),
        irregular = sheet_of(SheetPattern::random_delaunay);
  even.columns = irregular.columns = 3;
  even.rows = irregular.rows = 2;
  return {crumple_specimen("one_diagonal", make_sheet(even), 0.14, 29),
          crumple_specimen("random_delaunay", make_sheet(irregular), 0.1, 31),
          crumple_specimen("icosahedron", make_icosphere(0.19, 0), 0.2, 37)};
}

const TriangleMesh& small_statue() {
  static const TriangleMesh statue = make_statue(0.37, 3);
  return statue;
}

std::vector<Specimen> curved_shapes() {
  return {at_rest("statue", small_statue()), at_rest("icosphere", make_icosphere(0.13, 2)),
          at_rest("cylinder", make_cylinder(0.11, 0.27, 13, 5)), at_rest("pleats", pleats())};
}

Corners random_corners(Random& random, double angle) {
  const double edge = random.uniform(0.03, 0.2);
  const double foot1 = random.uniform(-0.4, 1.4) * edge, foot2 = random.uniform(-0.4, 1.4) * edge;
  const double height1 = random.uniform(0.4, 1.5) * edge, height2 = random.uniform(0.4, 1.5) * edge;
  Corners corners = {Vector3(foot1, height1, 0),
                     Vector3(foot2, -height2 * std::cos(angle), -height2 * std::sin(angle)),
                     Vector3(0, 0, 0), Vector3(edge, 0, 0)};
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(random.uniform(-3, 3), random.vectors(1, 1).col(0).normalized()).matrix();
  const Vector3 shift = random.vectors(1, 0.3).col(0);
  for (Vector3& corner : corners) corner = (turn * corner + shift).eval();
  return corners;
}

Specimen random_hinge(unsigned seed, double angle) {
  Random random(seed);
  const Corners rest = random_corners(random, random.uniform(-2.6, 2.6));
  Specimen specimen{
      "hinge " + std::to_string(seed), hinge_scene(rest, random.uniform(-2.3, 2.3)), {}};
  specimen.state = state_of(random_corners(random, angle));
  specimen.state.v = random.vectors(4, 1.7);
  return specimen;
}

std::vector<Specimen> hinges_of_all_angles() {
  std::vector<Specimen> hinges;
  unsigned seed = 101;
  for (const double angle :
       {0.0, 1e-9, 1e-4, 0.03, 0.4, 1.1, 1.5707, 1.5709, 2.2, 2.9, 3.1, 3.1411}) {
    hinges.push_back(random_hinge(seed++, angle));
    if (angle > 0) hinges.push_back(random_hinge(seed++, -angle));
  }
  return hinges;
}

std::vector<Specimen> sheets_and_hinges() {
  std::vector<Specimen> specimens = crumpled_sheets();
  for (Specimen& hinge : hinges_of_all_angles()) specimens.push_back(std::move(hinge));
  return specimens;
}

Scene hinge_scene(const Corners& rest, double rest_angle) {
  Scene scene = scene_at_rest(make_triangle_mesh(state_of(rest).x, {{0, 2, 3}, {1, 3, 2}}), 0.19);
  scene.rest_angles = {rest_angle};
  return scene;
}

void add_flat_hinges(Scene& scene, double stiffness, double damping) {
  scene.bending = BendingMaterial{stiffness, damping};
  scene.rest_angles.assign(scene.mesh.hinges.size(), 0);
}

std::vector<int> free_particles(const Scene& scene) {
  std::vector<char> held(size_t(scene.mesh.particles()), 0);
  for (const PrescribedParticle& one : scene.prescribed) held[size_t(one.particle)] = 1;
  std::vector<int> free;
  for (int i = 0; i < scene.mesh.particles(); ++i)
    if (!held[size_t(i)]) free.push_back(i);
  return free;
}

State resting_state(PerParticle3 x) {
  PerParticle3 v = PerParticle3::Zero(3, x.cols());
  return {0, std::move(x), std::move(v)};
}

State state_of(const Corners& x) {
  State s{0, PerParticle3(3, 4), PerParticle3::Zero(3, 4)};
  for (int k = 0; k < 4; ++k) s.x.col(k) = x[k];
  return s;
}

Corners corners_of(const Hinge& hinge, const PerParticle3& x) {
  const auto [i1, i2, i3, i4] = hinge.particles;
  return {x.col(i1), x.col(i2), x.col(i3), x.col(i4)};
}

oracles::HingeInput hinge_input(const Specimen& specimen, size_t hinge) {
  const Scene& scene = specimen.scene;
  const Hinge& of_mesh = scene.mesh.hinges.at(hinge);
  const BendingMaterial& material = scene.bending.value();
  oracles::HingeInput input;
  input.x = corners_of(of_mesh, specimen.state.x);
  input.v = corners_of(of_mesh, specimen.state.v);
  input.rest = corners_of(of_mesh, scene.mesh.rest);
  input.ke = material.stiffness;
  input.kd = material.damping;
  input.theta0 = scene.rest_angles.at(hinge);
  input.elastic_geometry =
      material.weighting == Weighting::rest ? oracles::Geometry::rest : oracles::Geometry::current;
  input.damping_factor = material.damping_factor == DampingFactor::edge
                             ? oracles::DampingFactor::edge_length
                             : oracles::DampingFactor::anisotropy;
  return input;
}

double aspect_ratio(const Corners& x) {
  return std::max(aspect_ratio(x[0], x[2], x[3]), aspect_ratio(x[1], x[3], x[2]));
}

std::vector<BendingMaterial> bending_variants() {
  return {{3.7e-4, 0, Weighting::rest, DampingFactor::edge, "sine"},
          {8.1e-2, 0, Weighting::current, DampingFactor::edge, "sine"},
          {5.3e-3, 0, Weighting::rest, DampingFactor::edge, "cubic"},
          {6.9e-4, 0, Weighting::current, DampingFactor::edge, "cubic"}};
}

std::vector<BendingMaterial> damped_bending_variants() {
  return {{2.9e-4, 4.3e-4, Weighting::rest, DampingFactor::edge, "sine"},
          {7.7e-3, 1.9e-5, Weighting::current, DampingFactor::edge_squared_over_area, "sine"}};
}

std::string describe(const Specimen& specimen, const BendingMaterial& material) {
  const std::string weighting = material.weighting == Weighting::rest ? "rest" : "current";
  if (material.damping == 0)
    return specimen.name + ", " + weighting + ", " + std::string(material.law);
  return specimen.name +
         (material.damping_factor == DampingFactor::edge ? ", |E|" : ", |E|^2/(|N1|+|N2|)");
}

}  // namespace foldproof
