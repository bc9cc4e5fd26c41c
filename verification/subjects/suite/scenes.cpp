#include "verification/subjects/suite/scenes.h"

#include <fmt/format.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include "reference/mesh/shapes.h"
#include "verification/seeds.h"

namespace foldproof::suite {

namespace {

constexpr double step = 0.002;  // s; a third of the explicit limit of the sheet
constexpr double young = 5;     // N/m

const Vector3 earth{0, 0, -9.81};

// The oblique plane: its frame, whose third axis is the normal, and where the sheet's corner lies.
const Eigen::Matrix3d plane_frame =
    Eigen::AngleAxisd(1.1, Vector3(0.4, -0.7, 0.5).normalized()).toRotationMatrix();
const Vector3 corner_on_plane{0.4, -0.3, 0.7};  // m

}  // namespace

double drawn(std::string_view what, double least, double most) {
  unsigned own = 2166136261u;  // FNV-1a
  for (const char letter : what) own = (own ^ static_cast<unsigned char>(letter)) * 16777619u;
  std::mt19937 generator(shifted_seed(own));
  return least + (most - least) * double(generator()) / double(std::mt19937::max());
}

PortableScene resting(std::string name, TriangleMesh mesh, const PortableMaterial& material) {
  PortableScene scene;
  scene.name = std::move(name);
  scene.mesh = std::move(mesh);
  scene.x = scene.mesh.rest;
  scene.v = PerParticle3::Zero(3, scene.x.cols());
  scene.material = material;
  scene.mass = lumped_masses(scene.mesh, material.density);
  return scene;
}

PortableScene shifted(PortableScene scene, const Vector3& by) {
  scene.mesh.rest.colwise() += by;
  scene.x.colwise() += by;
  return scene;
}

PortableScene together(std::string name, const std::vector<PortableScene>& sheets) {
  Eigen::Index particles = 0;
  for (const PortableScene& sheet : sheets) particles += sheet.x.cols();
  PortableScene all = sheets.front();
  all.name = std::move(name);
  all.held.clear(), all.rest_angles.clear();
  PerParticle3 rest(3, particles);
  all.x.resize(3, particles), all.v.resize(3, particles), all.mass.resize(particles);
  std::vector<Triangle> triangles;
  int first = 0;
  for (const PortableScene& sheet : sheets) {
    const Eigen::Index count = sheet.x.cols();
    rest.middleCols(first, count) = sheet.mesh.rest;
    all.x.middleCols(first, count) = sheet.x;
    all.v.middleCols(first, count) = sheet.v;
    all.mass.segment(first, count) = sheet.mass;
    for (const Triangle& t : sheet.mesh.triangles)
      triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    for (const int i : sheet.held) all.held.push_back(i + first);
    all.rest_angles.insert(all.rest_angles.end(), sheet.rest_angles.begin(),
                           sheet.rest_angles.end());  // hinges are numbered by their particles
    first += int(count);
  }
  all.mesh = make_triangle_mesh(rest, triangles);
  return all;
}

PortableScene sheet_of_cells(int cells) {
  PortableScene scene = resting("",
                                make_sheet({.pattern = SheetPattern::jittered,
                                            .width = 0.1 * cells,
                                            .columns = cells,
                                            .rows = cells,
                                            .jitter = 0.2,
                                            .seed = 7}),
                                {.young = young});
  scene.dt = step;
  return scene;
}

PortableScene sheet_at_rest() {
  PortableScene scene = sheet_of_cells(6);
  scene.name = "sheet at rest";
  return scene;
}

std::vector<PortableScene> sheets_at_rest() {
  std::vector<PortableScene> all;
  for (const auto& [name, pattern] : {std::pair("one diagonal", SheetPattern::one_diagonal),
                                      {"alternating diagonals", SheetPattern::alternating},
                                      {"union jack", SheetPattern::union_jack},
                                      {"criss cross", SheetPattern::criss_cross},
                                      {"equilateral", SheetPattern::equilateral},
                                      {"random Delaunay", SheetPattern::random_delaunay},
                                      {"curved", SheetPattern::one_diagonal}}) {
    TriangleMesh mesh = make_sheet(
        {.pattern = pattern, .width = 0.6, .height = 0.52, .columns = 6, .rows = 5, .seed = 7});
    if (std::string(name) == "curved")
      for (Eigen::Index i = 0; i < mesh.rest.cols(); ++i)
        mesh.rest(2, i) = 0.05 * std::sin(8 * mesh.rest(0, i));
    all.push_back(resting(name, std::move(mesh), {.young = young}));
    all.back().dt = step / 2;
  }
  return all;
}

PortableScene soft_sheet(std::string name) {
  PortableScene scene = sheet_of_cells(4);
  scene.name = std::move(name);
  scene.material.young = 1e-4;
  return scene;
}

PortableScene small_sheet() {
  PortableScene scene = sheet_of_cells(2);
  scene.name = "small sheet";
  return scene;
}

PortableScene falling_sheet() {
  PortableScene scene = sheet_at_rest();
  scene.name = "falling sheet";
  scene.gravity = earth;
  return scene;
}

PortableScene drifting_sheet() {
  PortableScene scene = sheet_at_rest();
  scene.name = "drifting sheet";
  scene.v.colwise() = Vector3(0.31, -0.23, 0.47);
  return scene;
}

PortableScene moving_sheet() {
  PortableScene scene = sheet_at_rest();
  scene.name = "moving sheet";
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const Vector3 p = scene.mesh.rest.col(i);
    scene.x.col(i) << 1.04 * p[0], 1.06 * p[1], 0.03 * std::sin(7 * p[0]) * std::cos(5 * p[1]);
    scene.v.col(i) << 0.11 - 0.7 * p[1], 0.6 * p[0] + 0.2 * p[1], 0.3 * std::cos(6 * p[0]) - 0.17;
  }
  return scene;
}

PortableScene damped_moving_sheet() {
  PortableScene scene = moving_sheet();
  scene.name = "damped moving sheet";
  scene.dt = 1.5 * step;  // long enough for errors of second order to stand out of single precision
  // The highest frequency omega is 2 over the explicit limit, that is 2/(3 step). With dampers of
  // tau times the springs' stiffness its damping ratio is omega tau/2.
  constexpr double tau = step;  // s
  scene.material.stretch_damping = tau * scene.material.young;
  return scene;
}

PortableScene moving_sheet_of_unequal_masses() {
  PortableScene scene = moving_sheet();
  scene.name = "moving sheet of unequal masses";
  for (Eigen::Index i = 0; i < scene.mass.size(); ++i)
    scene.mass[i] *= 1.15 + 0.55 * std::sin(1.7 * double(i) + 0.4);
  scene.own_masses = true;
  return scene;
}

PortableScene hanging_sheet() {
  PortableScene scene = falling_sheet();
  scene.name = "hanging sheet";
  scene.held = {0, 6};
  return scene;
}

PortableScene sheet_on_a_plane(const Tilt& tilt, double friction) {
  PortableScene scene = sheet_at_rest();
  scene.name = "sheet on a plane";
  scene.mesh.rest = (plane_frame * scene.mesh.rest).colwise() + corner_on_plane;
  scene.x = scene.mesh.rest;
  const double along = std::sin(tilt.slope);
  scene.gravity = earth.norm() * plane_frame *
                  Vector3(along * std::cos(tilt.heading), along * std::sin(tilt.heading),
                          -std::cos(tilt.slope));
  const Vector3 beside = plane_frame * Vector3(0.45, 0.1, 0);  // m, from the corner
  scene.planes = {{corner_on_plane + beside, plane_frame.col(2), friction}};
  return scene;
}

PerParticle3 seen_from_the_plane(const PerParticle3& x) {
  return plane_frame.transpose() * (x.colwise() - corner_on_plane);
}

std::vector<std::string> split(std::string_view text, std::string_view separator) {
  std::vector<std::string> parts;
  for (size_t from = 0; from < text.size();) {
    parts.emplace_back(text.substr(from, text.find(separator, from) - from));
    from += parts.back().size() + separator.size();
  }
  return parts;
}

Table table_of(std::string_view columns) {
  Table table;
  for (const std::string& column : split(columns, " | ")) {
    const size_t unit = column.find(" [");
    if (unit == std::string::npos)
      table.add({column, ""});
    else
      table.add({column.substr(0, unit), column.substr(unit + 2, column.size() - unit - 3)});
  }
  return table;
}

double largest(const PerParticle3& vectors) { return vectors.colwise().norm().maxCoeff(); }

Vector3 middle_of(const PerParticle3& x) {
  return (x.rowwise().maxCoeff() + x.rowwise().minCoeff()) / 2;
}

std::vector<long> multiples(long stride, long count) {
  std::vector<long> all;
  for (long k = 1; k <= count; ++k) all.push_back(k * stride);
  return all;
}

PerParticle3 momentum_velocities(const PortableScene& scene, const PerParticle3& v,
                                 const Declaration& declared) {
  if (!declared.has_consistent_mass) return v;
  PerParticle3 sum = PerParticle3::Zero(3, v.cols());
  for (const Triangle& t : scene.mesh.triangles) {
    const auto rest = [&](int k) { return Vector3(scene.mesh.rest.col(t[size_t(k)])); };
    const double area = (rest(1) - rest(0)).cross(rest(2) - rest(0)).norm() / 2;
    const Vector3 all = v.col(t[0]) + v.col(t[1]) + v.col(t[2]);
    for (const int i : t) sum.col(i) += scene.material.density * area / 12 * (all + v.col(i));
  }
  return sum * scene.mass.cwiseInverse().asDiagonal();
}

long parts_of_step(double dt, const Declaration& declared) {
  return declared.substep > 0 ? long(std::ceil(dt / declared.substep * (1 - 1e-9))) : 1;
}

double kinetic_energy(const PortableScene& scene, const PerParticle3& v) {
  return (v.colwise().squaredNorm() * scene.mass)[0] / 2;
}

double gained_energy(const PortableScene& scene, const PerParticle3& from, const Snapshot& now) {
  return kinetic_energy(scene, now.v) - scene.gravity.dot((now.x - from) * scene.mass);
}

Vector3 torque_of(const PerParticle3& x, const PerParticle3& f) {
  Vector3 torque = Vector3::Zero();
  for (Eigen::Index i = 0; i < f.cols(); ++i) torque += Vector3(x.col(i)).cross(Vector3(f.col(i)));
  return torque;
}

Vector3 momentum_of(const PortableScene& scene, const PerParticle3& v) { return v * scene.mass; }

Vector3 spin_of(const PortableScene& scene, const Snapshot& now) {
  return torque_of(now.x.colwise() - middle_of(scene.x), now.v * scene.mass.asDiagonal());
}

double middle(const Interval& interval) { return (interval[0] + interval[1]) / 2; }

Interval bisected(Interval tried, double width, const std::function<bool(double)>& is_beyond) {
  while (tried[1] - tried[0] > width) {
    const double value = middle(tried);
    tried[is_beyond(value) ? 1 : 0] = value;
  }
  return tried;
}

std::string found_text(const Interval& found, const Interval& tried) {
  if (found[1] == tried[1]) return fmt::format(">= {:.4g}, the most that is tried", tried[1]);
  if (found[0] == tried[0]) return fmt::format("<= {:.4g}, the least that is tried", tried[0]);
  return fmt::format("{:.4g}", middle(found));
}

void require_start_velocity(const PortableScene& scene, const PerParticle3& x, long steps) {
  const double time = double(steps) * scene.dt;
  const double came = (scene.v.cwiseProduct(x - scene.x) * scene.mass).sum(),
               free = (scene.v.colwise().squaredNorm() * scene.mass)[0] * time;
  if (!(came >= free / 2))
    throw NotOffered{
        fmt::format("the start's velocity: before any contact the sheet comes {:.2g} of the way "
                    "that it would come freely, so it meets nothing",
                    came / free)};
}

double squared_phase(const PortableScene& scene, long steps) {
  const Eigen::VectorXd stiffness = edge_stiffness(scene);
  PerParticle rows = PerParticle::Zero(scene.mass.size());
  for (size_t e = 0; e < scene.mesh.edges.size(); ++e) {
    rows[scene.mesh.edges[e].a] += 2 * stiffness[Eigen::Index(e)];
    rows[scene.mesh.edges[e].b] += 2 * stiffness[Eigen::Index(e)];
  }
  const double time = double(steps) * scene.dt;
  return time * time * (rows.array() / scene.mass.array()).maxCoeff();
}

void require_softness(const PortableScene& scene, long steps) {
  if (!(squared_phase(scene, steps) < 0.02))  // twice: it bounds the frequencies from above
    throw std::logic_error("a sheet that is not soft: " + scene.name);
}

double rounding_error(const PortableScene& scene, long steps, const Declaration& declared) {
  constexpr double roundings_a_step = 8;
  const double roundings = roundings_a_step * double(steps + 1) *
                           (1 + squared_phase(scene, steps)) * declared.rounding();
  return roundings + double(steps) * declared.solve_tolerance;
}

double narrow(double bound, const Declaration& declared) {
  if (bound < widest_bound) return bound;
  throw CannotTell(
      fmt::format("what the solver declares ({}, solve_tolerance {:g}) allows an error of {:.2g} "
                  "of what is measured; from {:g} on, a law that holds says nothing",
                  declared.is_single ? "f4" : "f8", declared.solve_tolerance, bound, widest_bound));
}

double narrow_rounding(Trial& trial, const PortableScene& scene, long steps) {
  const Declaration& declared = trial.declaration();
  return narrow(rounding_error(scene, steps, declared), declared);
}

}  // namespace foldproof::suite
