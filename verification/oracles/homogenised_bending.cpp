#include "verification/oracles/homogenised_bending.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include "reference/types.h"
#include "verification/oracles/dense_algebra.h"

namespace foldproof::oracles {

namespace {

//      x1            a, b: feet of x1 and x2 along x3-x4, in units of its length l
//     /  \           h1, h2: their heights over it
//   x3 -- x4         slope of the triangle above, across the edge: (w1 - (1 - a) w3 - a w4)/h1
//     \  /           below, away from the edge:                    (w2 - (1 - b) w3 - b w4)/h2
//      x2            theta, to first order in w: the sum of both slopes

/// One hinge in the plane: theta = sum of turn[i] w_i for small heights w [1/m], its factor c and a
/// third of the area of its triangles [m^2].
struct FlatHinge {
  std::array<double, 4> turn;
  double factor, area_third;
};

FlatHinge flat_hinge(const std::array<Eigen::Vector2d, 4>& x) {
  const Eigen::Vector2d edge = x[3] - x[2], above = x[0] - x[2], below = x[1] - x[2];
  const double l = edge.norm();
  const Eigen::Vector2d along = edge / l, across(-along.y(), along.x());
  const double h1 = across.dot(above), h2 = -across.dot(below);
  if (!(h1 > 0 && h2 > 0))
    throw InputError("oracle homogenised_bending: a triangle has no area or is turned over");
  const double a = along.dot(above) / l, b = along.dot(below) / l;
  return {{1 / h1, 1 / h2, -(1 - a) / h1 - (1 - b) / h2, -a / h1 - b / h2},
          l / (h1 + h2),
          l * (h1 + h2) / 6};
}

/// w of the three unit curvatures k at p [m^2].
Eigen::Vector3d unit_heights(const Eigen::Vector2d& p) {
  return 0.5 * Eigen::Vector3d(p.x() * p.x(), p.y() * p.y(), p.x() * p.y());
}

/// (n.n) of the direction: as a row that maps k to the curvature along it, and as the k of a unit
/// cylinder.
Eigen::Vector3d curvature_along(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * c, s * s, c * s};
}
Eigen::Vector3d unit_cylinder(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * c, s * s, 2 * c * s};
}

// --- periodic meshes ---

/// A directed edge modulo periods: sites at its ends and the periods between them.
using EdgeKey = std::tuple<int, int, int, int>;

/// A triangle seen from one of its edges: from, to, and the third corner.
struct Side {
  PeriodicCorner from, to, opposite;
};

std::map<EdgeKey, Side> sides_of(const PeriodicMesh& mesh) {
  std::map<EdgeKey, Side> sides;
  for (const std::array<PeriodicCorner, 3>& triangle : mesh.triangles) {
    for (size_t k = 0; k < 3; ++k) {
      const Side side{triangle[k], triangle[(k + 1) % 3], triangle[(k + 2) % 3]};
      const EdgeKey key{side.from.site, side.to.site, side.to.along_a - side.from.along_a,
                        side.to.along_b - side.from.along_b};
      if (!sides.emplace(key, side).second)
        throw InputError("oracle homogenised_bending: an edge has two triangles on one side");
    }
  }
  return sides;
}

Eigen::Vector2d place(const PeriodicMesh& mesh, const PeriodicCorner& corner) {
  return mesh.sites[size_t(corner.site)] + corner.along_a * mesh.period_a +
         corner.along_b * mesh.period_b;
}

/// Whether an edge may have only one triangle: a free edge, which has no hinge.
enum class Borders { none, free };

/// The quadratic form of a cell's energy in units of ke/2, in k and the displacements of its sites.
Eigen::MatrixXd whole_cell_energy(const PeriodicMesh& mesh, Borders borders) {
  const std::map<EdgeKey, Side> sides = sides_of(mesh);
  const Eigen::Index size = 3 + Eigen::Index(mesh.sites.size());
  Eigen::MatrixXd energy = Eigen::MatrixXd::Zero(size, size);
  for (const auto& [key, side] : sides) {
    const auto [from, to, along_a, along_b] = key;
    const EdgeKey back{to, from, -along_a, -along_b};
    if (sides.count(back) == 0) {
      if (borders == Borders::free) continue;
      throw InputError("oracle homogenised_bending: an edge has one triangle");
    }
    if (back < key) continue;  // each hinge once
    const Side& other = sides.at(back);
    PeriodicCorner x2 = other.opposite;  // moved by whole periods to where the two edges meet
    x2.along_a += side.to.along_a - other.from.along_a;
    x2.along_b += side.to.along_b - other.from.along_b;
    const std::array<PeriodicCorner, 4> corners{side.opposite, x2, side.from, side.to};
    const FlatHinge hinge = flat_hinge({place(mesh, corners[0]), place(mesh, corners[1]),
                                        place(mesh, corners[2]), place(mesh, corners[3])});
    Eigen::VectorXd theta = Eigen::VectorXd::Zero(size);
    for (size_t i = 0; i < 4; ++i) {
      theta.head<3>() += hinge.turn[i] * unit_heights(place(mesh, corners[i]));
      theta[3 + corners[i].site] += hinge.turn[i];
    }
    energy += hinge.factor / 2 * theta * theta.transpose();
  }
  return energy;
}

/// Per area.
Eigen::MatrixXd cell_energy(const PeriodicMesh& mesh) {
  const double cell =
      std::abs(mesh.period_a.x() * mesh.period_b.y() - mesh.period_a.y() * mesh.period_b.x());
  return whole_cell_energy(mesh, Borders::none) / cell;
}

// --- finite meshes ---

FlatHinge flat_hinge_of(const PlaneSheet& sheet, const std::array<int, 4>& corners) {
  return flat_hinge({sheet.points.col(corners[0]), sheet.points.col(corners[1]),
                     sheet.points.col(corners[2]), sheet.points.col(corners[3])});
}

/// D/ke of heights w [m^2 for unit curvature].
double rigidity_of(const PlaneSheet& sheet, const Eigen::VectorXd& w) {
  double energy = 0, area = 0;
  for (size_t h = 0; h < sheet.hinges.size(); ++h) {
    if (!sheet.counted[h]) continue;
    const FlatHinge hinge = flat_hinge_of(sheet, sheet.hinges[h]);
    double theta = 0;
    for (size_t i = 0; i < 4; ++i) theta += hinge.turn[i] * w[sheet.hinges[h][i]];
    energy += hinge.factor / 2 * theta * theta;
    area += hinge.area_third;
  }
  return energy / area;
}

Eigen::VectorXd cylinder_heights(const PlaneSheet& sheet, double angle) {
  Eigen::VectorXd w(sheet.points.cols());
  for (Eigen::Index i = 0; i < w.size(); ++i)
    w[i] = unit_cylinder(angle).dot(unit_heights(sheet.points.col(i)));
  return w;
}

/// The second derivatives of the energy of all hinges, N x N.
Eigen::SparseMatrix<double> energy_matrix(const PlaneSheet& sheet) {
  std::vector<Eigen::Triplet<double>> entries;
  for (const std::array<int, 4>& corners : sheet.hinges) {
    const FlatHinge hinge = flat_hinge_of(sheet, corners);
    for (size_t i = 0; i < 4; ++i) {
      for (size_t j = 0; j < 4; ++j)
        entries.emplace_back(corners[i], corners[j], hinge.factor * hinge.turn[i] * hinge.turn[j]);
    }
  }
  Eigen::SparseMatrix<double> matrix(sheet.points.cols(), sheet.points.cols());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

PeriodicMesh split_rectangles(const SplitBlock& block) {
  PeriodicMesh mesh;
  mesh.period_a = Eigen::Vector2d(block.columns * block.width, 0);
  mesh.period_b = Eigen::Vector2d(0, block.rows * block.height);
  const auto corner = [&block](int i, int j) {
    const int a = i / block.columns, b = j / block.rows;
    return PeriodicCorner{(j - b * block.rows) * block.columns + i - a * block.columns, a, b};
  };
  for (int j = 0; j < block.rows; ++j) {
    for (int i = 0; i < block.columns; ++i) {
      mesh.sites.emplace_back(i * block.width, j * block.height);
      const PeriodicCorner low_left = corner(i, j), low_right = corner(i + 1, j),
                           left = corner(i, j + 1), right = corner(i + 1, j + 1);
      const bool rises = block.rises == nullptr || block.rises(i, j);
      mesh.triangles.push_back({low_left, low_right, rises ? right : left});
      mesh.triangles.push_back({rises ? low_left : low_right, right, left});
    }
  }
  return mesh;
}

PeriodicMesh crossed_squares(double side) {
  const PeriodicCorner a{0, 0, 0}, b{0, 1, 0}, c{0, 1, 1}, d{0, 0, 1}, centre{1, 0, 0};
  return {Eigen::Vector2d(side, 0),
          Eigen::Vector2d(0, side),
          {Eigen::Vector2d(0, 0), Eigen::Vector2d(side / 2, side / 2)},
          {{a, b, centre}, {b, c, centre}, {c, d, centre}, {d, a, centre}}};
}

PeriodicMesh equilateral_triangles(double edge) {
  const PeriodicCorner a{0, 0, 0}, b{0, 1, 0}, c{0, 1, 1}, d{0, 0, 1};
  return {Eigen::Vector2d(edge, 0),
          Eigen::Vector2d(edge / 2, edge * std::numbers::sqrt3 / 2),
          {Eigen::Vector2d(0, 0)},
          {{a, b, d}, {b, c, d}}};
}

Eigen::Matrix3d forced_rigidity(const PeriodicMesh& mesh) {
  return cell_energy(mesh).topLeftCorner<3, 3>();
}

Eigen::Matrix3d relaxed_rigidity(const PeriodicMesh& mesh) {
  const Eigen::MatrixXd energy = cell_energy(mesh);
  // the first site stays: a common shift of all sites changes nothing
  const Eigen::Index others = energy.rows() - 4;
  Eigen::Matrix3d R = energy.topLeftCorner<3, 3>();
  if (others == 0) return R;
  const Eigen::MatrixXd mixed = energy.bottomLeftCorner(others, 3);
  return R - mixed.transpose() * solve_symmetric(energy.bottomRightCorner(others, others), mixed);
}

double cylinder_rigidity(const Eigen::Matrix3d& R, double angle) {
  const Eigen::Vector3d k = unit_cylinder(angle);
  return k.dot(R * k);
}

double strip_rigidity(const Eigen::Matrix3d& R, double angle) {
  const Eigen::Vector3d along = curvature_along(angle);
  return 1 / along.dot(Eigen::Vector3d(solve_symmetric(R, along)));
}

RibbonRigidity equilateral_ribbon(double edge, int rows) {
  if (rows < 2) throw InputError("oracle homogenised_bending: a ribbon needs two rows");
  const double height = edge * std::numbers::sqrt3 / 2;
  // never reached: far enough away to keep the ribbon's edges free
  PeriodicMesh mesh{Eigen::Vector2d(edge, 0), Eigen::Vector2d(0, 2 * rows * height), {}, {}};
  for (int j = 0; j <= rows; ++j) mesh.sites.emplace_back(j % 2 == 0 ? 0 : edge / 2, j * height);
  for (int j = 0; j < rows; ++j) {
    // an odd row is half an edge ahead of an even one
    const int ahead = j % 2 == 0 ? 0 : 1;
    const PeriodicCorner low{j, 0, 0}, next{j, 1, 0}, high{j + 1, ahead, 0},
        before{j + 1, ahead - 1, 0};
    mesh.triangles.push_back({low, next, high});
    mesh.triangles.push_back({low, high, before});
  }
  const Eigen::MatrixXd energy = whole_cell_energy(mesh, Borders::free) / edge;
  // rows 0 and 1 stay: a shift and a tilt change nothing; curvature across is free
  const Eigen::Index others = rows - 1;
  const Eigen::MatrixXd mixed = energy.bottomLeftCorner(others, 3);
  const Eigen::Matrix3d R =
      energy.topLeftCorner<3, 3>() -
      mixed.transpose() * solve_symmetric(energy.bottomRightCorner(others, others), mixed);
  return {R(0, 0), 4 * R(2, 2)};  // k contains twice the twist
}

RigidityRange cylinder_range(const Eigen::Matrix3d& R) {
  // D is a trigonometric polynomial of degree 4: half a step away from an extremum it has changed
  // by at most 8 (pi/8000)^2 = 1.2e-6 of its swing
  constexpr int directions = 4000;
  RigidityRange range{cylinder_rigidity(R, 0), cylinder_rigidity(R, 0)};
  for (int i = 1; i < directions; ++i) {
    const double D = cylinder_rigidity(R, pi * i / directions);
    range = {std::min(range.least, D), std::max(range.greatest, D)};
  }
  return range;
}

double forced_cylinder_rigidity(const PlaneSheet& sheet, double angle) {
  return rigidity_of(sheet, cylinder_heights(sheet, angle));
}

double relaxed_cylinder_rigidity(const PlaneSheet& sheet, double angle) {
  Eigen::VectorXd w = cylinder_heights(sheet, angle);
  const Eigen::SparseMatrix<double> matrix = energy_matrix(sheet);
  std::vector<Eigen::Triplet<double>> picks;  // maps the free points' numbers to all points'
  for (Eigen::Index i = 0; i < w.size(); ++i)
    if (!sheet.held[size_t(i)]) picks.emplace_back(i, picks.size(), 1.0);
  Eigen::SparseMatrix<double> pick(w.size(), Eigen::Index(picks.size()));
  pick.setFromTriplets(picks.begin(), picks.end());
  const Eigen::SparseMatrix<double> free = pick.transpose() * matrix * pick;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(free);
  if (solver.info() != Eigen::Success)
    throw InputError("oracle homogenised_bending: too few points are held");
  const Eigen::VectorXd residual = pick.transpose() * (matrix * w), shift = solver.solve(residual);
  w -= pick * shift;
  return rigidity_of(sheet, w);
}

}  // namespace foldproof::oracles
