#include <array>
#include <cmath>
#include <numbers>

#include "convergence/bending/bending_rigidity.h"
#include "reference/mesh/shapes.h"
#include "verification/oracles/homogenised_bending.h"
#include "verification/seeds.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

constexpr double gentle_ke = 0.0037;  // J

Scene bending_scene(TriangleMesh mesh) {
  Scene scene = scene_at_rest(std::move(mesh), 0.17);
  add_flat_hinges(scene, gentle_ke, 0);
  return scene;
}

/// Distance of a point from the border of the sheet [m].
double depth(const Vector3& p, const Vector3& far_corner) {
  const double x = p.x() < far_corner.x() / 2 ? p.x() : far_corner.x() - p.x();
  const double y = p.y() < far_corner.y() / 2 ? p.y() : far_corner.y() - p.y();
  return x < y ? x : y;
}

/// theta by the definition's formula in doubles [rad].
double angle_of(const Hinge& hinge, const PerParticle3& x) {
  oracles::Quad<double> corners;
  for (size_t k = 0; k < 4; ++k) {
    const Vector3 corner = x.col(hinge.particles[k]);
    corners[k] = {corner.x(), corner.y(), corner.z()};
  }
  return oracles::hinge_angle(corners);
}

// Of the gentle sheets: a flat sheet of any mesh, curved so gently that heights over the plane say
// all.
constexpr double gentle_side = 0.53;                     // m
constexpr double gentle_curvature = 1e-3 / gentle_side;  // [1/m]
// the square of the largest slope, 1e-3 times the diagonal over the side, twice [1]
constexpr double gentle_bound = 4e-6;

/// Its bending energy at small curvature. Hinges near the border do not count; vertices near it are
/// held when the others settle.
class GentleSheet {
 public:
  /// width: of a cell [m].
  GentleSheet(const Subject& subject, TriangleMesh mesh, double width)
      : subject_(subject),
        scene_(bending_scene(std::move(mesh))),
        probe_(subject, scene_),
        width_(width) {
    const PerParticle3& rest = scene_.mesh.rest;
    const Vector3 far_corner = rest.rowwise().maxCoeff();
    flat_.points = rest.topRows<2>();
    for (Eigen::Index i = 0; i < rest.cols(); ++i)
      flat_.held.push_back(depth(rest.col(i), far_corner) < 1.2 * width);
    for (const Hinge& hinge : scene_.mesh.hinges) {
      flat_.hinges.push_back(hinge.particles);
      bool inside = true;
      for (const int i : hinge.particles)
        inside = inside && !(depth(rest.col(i), far_corner) < 2.2 * width);
      flat_.counted.push_back(inside);
      const Edge& edge = scene_.mesh.edges[size_t(hinge.edge)];
      if (!inside) continue;
      for (const int t : edge.triangles) {
        const Triangle& corners = scene_.mesh.triangles[size_t(t)];
        const Vector3 side = rest.col(corners[1]) - rest.col(corners[0]),
                      other = rest.col(corners[2]) - rest.col(corners[0]);
        area_ += (side.x() * other.y() - side.y() * other.x()) / 6;
      }
    }
  }

  /// D/ke of a cylinder curved along `angle` [rad] [1]: with all vertices on it, or with those
  /// inside where the subject's forces vanish.
  double forced(double angle) const { return rigidity(cylinder(angle)); }
  double relaxed(double angle) const {
    // conjugate gradients: over the plane, forces are linear in heights as far as the square of the
    // slopes
    constexpr double tolerance = 1e-9;  // of the forces, to those at the start
    // sum of the heights tried [m]
    const double probing = 1e-4 * width_ * double(scene_.mesh.particles());
    Eigen::VectorXd heights = cylinder(angle), residual = pull(heights), direction = residual;
    double squared = residual.squaredNorm();
    const double goal = tolerance * tolerance * squared;
    for (Eigen::Index i = 0; i < 20 * heights.size() && squared > goal; ++i) {
      const double reach = probing / direction.cwiseAbs().sum();
      const Eigen::VectorXd product = -pull(reach * direction) / reach;
      const double step = squared / direction.dot(product);
      heights += step * direction;
      residual -= step * product;
      const double before = squared;
      squared = residual.squaredNorm();
      direction = residual + squared / before * direction;
    }
    return rigidity(heights);
  }

  /// The same sheet in the oracle's words.
  const oracles::PlaneSheet& flat() const { return flat_; }

 private:
  /// Heights of all vertices [m].
  Eigen::VectorXd cylinder(double angle) const {
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    return 0.5 * gentle_curvature *
           (along.transpose() * flat_.points).array().square().matrix().transpose();
  }
  PerParticle3 positions_at(const Eigen::VectorXd& heights) const {
    PerParticle3 x = scene_.mesh.rest;
    x.row(2) = heights.transpose();
    return x;
  }
  /// D/ke of the counted hinges [1].
  double rigidity(const Eigen::VectorXd& heights) const {
    // hinges that do not count are at rest in this shape, and store nothing
    const PerParticle3 x = positions_at(heights);
    Scene scene = scene_;
    for (size_t h = 0; h < flat_.hinges.size(); ++h)
      scene.rest_angles[h] = flat_.counted[h] ? 0 : angle_of(scene.mesh.hinges[h], x);
    return 2 * Probe(subject_, scene).energy(resting_state(x)) /
           (gentle_ke * area_ * gentle_curvature * gentle_curvature);
  }
  /// Force across the sheet, 0 where held [N].
  Eigen::VectorXd pull(const Eigen::VectorXd& heights) const {
    Eigen::VectorXd force = probe_.elastic(resting_state(positions_at(heights))).row(2).transpose();
    for (Eigen::Index i = 0; i < force.size(); ++i)
      if (flat_.held[size_t(i)]) force[i] = 0;
    return force;
  }

  const Subject& subject_;
  Scene scene_;
  Probe probe_;
  oracles::PlaneSheet flat_;
  double width_;     // of a cell [m]
  double area_ = 0;  // a third of the counted hinges' triangles [m^2]
};

constexpr double equilateral = 0.25;  // D/ke without disorder: the homogenised cell says so

/// How a mesh is made irregular.
struct Disorder {
  std::string name, words;
  SheetPattern pattern;
  double jitter;  // [1]
};

std::vector<Disorder> disorders() {
  return {{"jittered-10", "equilateral, jittered by 10 %", SheetPattern::jittered, 0.1},
          {"jittered-20", "equilateral, jittered by 20 %", SheetPattern::jittered, 0.2},
          {"jittered-30", "equilateral, jittered by 30 %", SheetPattern::jittered, 0.3},
          {"random", "random vertices, Delaunay", SheetPattern::random_delaunay, 0}};
}

/// One rigidity from several meshes, each a mean over directions.
struct Mean {
  std::vector<double> values;

  double value() const {
    double sum = 0;
    for (const double v : values) sum += v;
    return sum / double(values.size());
  }

  /// Of the mean, from the scatter of the meshes.
  double standard_error() const {
    double squares = 0;
    for (const double v : values) squares += (v - value()) * (v - value());
    return std::sqrt(squares / (double(values.size()) * (double(values.size()) - 1)));
  }
};

/// D/ke of one kind of mesh at one size, and how far single sheets are from what the
/// oracle says of them.
struct Sample {
  Mean forced, relaxed;
  Worst forced_error, relaxed_error;  // relative
};

constexpr std::array directions = {11.0, 56.0, 101.0, 146.0};  // of the curvature [degree]

/// How many meshes of each size, and how many of them let their vertices settle, which
/// costs a solve each.
struct Effort {
  std::vector<int> sizes;  // cells along a side
  int meshes, settled;
};

TriangleMesh mesh_of(const Disorder& disorder, int cells, unsigned seed) {
  Sheet sheet{disorder.pattern, gentle_side,       gentle_side, cells, cells,
              disorder.jitter,  shifted_seed(seed)};
  if (disorder.pattern == SheetPattern::jittered) {
    sheet.rows = int(std::lround(cells * 2 / std::numbers::sqrt3));
    sheet.height = 0;
  }
  return make_sheet(sheet);
}

Sample sample_of(const Subject& subject, const Disorder& disorder, int cells,
                 const Effort& effort) {
  Sample sample;
  for (int seed = 1; seed <= effort.meshes; ++seed) {
    const GentleSheet sheet(subject, mesh_of(disorder, cells, unsigned(seed)), gentle_side / cells);
    double forced = 0, relaxed = 0;
    for (const double degrees : directions) {
      const double angle = degrees * pi / 180, own = sheet.forced(angle);
      forced += own / directions.size();
      sample.forced_error.observe(
          std::abs(own / oracles::forced_cylinder_rigidity(sheet.flat(), angle) - 1));
      if (seed > effort.settled) continue;
      const double settled = sheet.relaxed(angle);
      relaxed += settled / directions.size();
      sample.relaxed_error.observe(
          std::abs(settled / oracles::relaxed_cylinder_rigidity(sheet.flat(), angle) - 1));
    }
    sample.forced.values.push_back(forced);
    if (seed <= effort.settled) sample.relaxed.values.push_back(relaxed);
  }
  return sample;
}

/// All sizes of one kind of mesh: D/ke as means over meshes and directions; settled: of
/// the first meshes.
struct Row {
  Disorder disorder;
  Table samples;

  std::pair<double, double> last_two(std::string_view column) const {
    const std::vector<double>& values = samples.numbers(column);
    return {values[values.size() - 2], values.back()};
  }
};

Row row_of(const Subject& subject, const Disorder& disorder, const Effort& effort) {
  return {disorder, refine({{"width of a cell", "m"},
                            {"forced", "1"},
                            {"standard error", "1"},
                            {"settled", "1"},
                            {"worst error, forced", "1"},
                            {"worst error, relaxed", "1"}},
                           effort.sizes, [&](int cells) {
                             const Sample sample = sample_of(subject, disorder, cells, effort);
                             return std::tuple{gentle_side / cells,
                                               sample.forced.value(),
                                               sample.forced.standard_error(),
                                               sample.relaxed.value(),
                                               sample.forced_error.value(),
                                               sample.relaxed_error.value()};
                           })};
}

/// All kinds of meshes, one below the other.
Table all_meshes(const std::vector<Row>& rows) {
  std::vector<std::pair<std::string, Table>> meshes;
  for (const Row& row : rows) meshes.emplace_back(row.disorder.words, row.samples);
  return stacked({"mesh", ""}, meshes);
}

NamedFinding as_the_oracle(const std::vector<Row>& rows) {
  const Table all = all_meshes(rows);
  Worst worst;
  worst.observe(all.worst("worst error, forced"));
  worst.observe(all.worst("worst error, relaxed"));
  const Verdict verdict{worst.value(), gentle_bound, 0, "1",
                        "the surfaces' slopes change angles by their square, relatively"};
  return {"bending-rigidity.irregular.matches-homogenisation",
          "On jittered and random meshes too, the energy is what the hinges' definition gives, "
          "with all vertices on the surface and with those inside settled.",
          {verdict,
           with_columns(all,
                        {"mesh", "width of a cell", "worst error, forced", "worst error, relaxed"}),
           "settled: conjugate gradients on the subject's forces; the oracle solves its own sparse "
           "system"}};
}

NamedFinding excess_stays(const Row& row) {
  const auto [coarse, fine] = row.last_two("forced");
  const auto [coarse_error, fine_error] = row.last_two("standard error");
  const double excess = fine - equilateral, change = std::abs(fine - coarse);
  const double uncertainty = std::hypot(coarse_error, fine_error);
  Table means = with_columns(row.samples, {"width of a cell"});
  means.add({"D/ke, forced, mean", "1", row.samples.numbers("forced")});
  means.add(row.samples.column("standard error"));
  const Verdict verdict{excess > 0 ? change / excess : nan, 0.5, uncertainty / excess, "1",
                        "an excess proportional to the width would change by its own size when the "
                        "cells are halved; half of that separates the two"};
  return {"bending-rigidity.irregular.excess-persists-under-refinement." + row.disorder.name,
          "The excess of D over that of equilateral triangles stays when the cells are halved: " +
              row.disorder.words + ".",
          {verdict, means,
           "measured is the last change over the excess, NaN without one; the uncertainty is the "
           "standard error of the means over meshes"}};
}

void show(const std::vector<Row>& rows, StudyResult& result) {
  Figure figure{"irregular",
                "Flexural rigidity of irregular meshes",
                {"width of a cell", "m", Scale::log},
                {"D/ke", "1"},
                "Means over meshes and directions. Forced: all vertices on the cylinder; settled: "
                "those inside leave it. Equilateral triangles have 0.25."};
  for (const Row& row : rows)
    for (const char* kind : {"forced", "settled"})
      figure.curves.push_back(
          curve_of(row.disorder.words + ", " + kind, row.samples, "width of a cell", kind));
  result.figures.push_back(std::move(figure));
  result.tables.push_back({"irregular",
                           "D/ke of irregular meshes: means over meshes and directions; "
                           "settled: of the first mesh",
                           with_columns(all_meshes(rows), {"mesh", "width of a cell", "forced",
                                                           "standard error", "settled"})});
}

}  // namespace

void add_irregular_rigidity(const Subject& subject, Tier tier, const Progress& progress,
                            StudyResult& result) {
  const Effort effort = tier == Tier::quick ? Effort{{14, 28}, 10, 1} : Effort{{14, 28, 56}, 24, 1};
  std::vector<Row> rows;
  for (const Disorder& disorder : disorders()) {
    rows.push_back(row_of(subject, disorder, effort));
    progress(0.5 + 0.5 * double(rows.size()) / double(disorders().size()));
  }
  result.findings.push_back(as_the_oracle(rows));
  for (const Row& row : rows) result.findings.push_back(excess_stays(row));
  show(rows, result);
}

}  // namespace foldproof
