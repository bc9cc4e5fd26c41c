#include "reference/beyond/membrane.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <memory>

#include "reference/beyond/directions.h"

namespace foldproof {

namespace {

using Eigen::Matrix2d, Eigen::Matrix3d, Eigen::SelfAdjointEigenSolver, Eigen::Vector3d;
using Matrix32 = Eigen::Matrix<double, 3, 2>;
using Matrix23 = Eigen::Matrix<double, 2, 3>;

/// C of the header, and tau.
struct Stiffness {
  double c11, c12, c22, shear;  // N/m
  double damping;               // s

  /// S of a symmetric E.
  Matrix2d stress(const Matrix2d& E) const {
    Matrix2d S;
    S << c11 * E(0, 0) + c12 * E(1, 1), 2 * shear * E(0, 1),  //
        2 * shear * E(0, 1), c12 * E(0, 0) + c22 * E(1, 1);
    return S;
  }
  /// The root of C as a matrix for (E11, E22, sqrt(2) E12) [sqrt(N/m)].
  Matrix3d root() const {
    Matrix3d C;
    C << c11, c12, 0, c12, c22, 0, 0, 0, 2 * shear;
    return SelfAdjointEigenSolver<Matrix3d>(C).operatorSqrt();
  }
};

template <class Matrix>
auto eigenvalues_of(const Matrix& symmetric) {
  SelfAdjointEigenSolver<Matrix> modes;
  return modes.computeDirect(symmetric, Eigen::EigenvaluesOnly).eigenvalues().eval();
}

/// A triangle at rest. Column k of `gradients` is the gradient of corner k's share [1/m]:
/// F = sum of x_k gradients_k^T.
struct RestTriangle {
  Triangle corners;
  Matrix23 gradients;
  double area;  // m^2
  Stiffness material;

  Matrix32 gradient_of(const PerParticle3& x) const {
    Matrix32 F = Matrix32::Zero();
    for (int k = 0; k < 3; ++k) F += x.col(corners[size_t(k)]) * gradients.col(k).transpose();
    return F;
  }
  void push(const Matrix32& P, PerParticle3& f) const {
    for (int k = 0; k < 3; ++k) f.col(corners[size_t(k)]) -= area * (P * gradients.col(k));
  }
};

Matrix2d symmetric(const Matrix2d& A) { return (A + A.transpose()) / 2; }

/// F times the stress of the strain that changes by sym(F^T dF).
Matrix32 changed(const Stiffness& material, const Matrix32& F, const Matrix32& dF) {
  return F * material.stress(symmetric(F.transpose() * dF));
}

Matrix2d strain_of(const Matrix32& F) { return (F.transpose() * F - Matrix2d::Identity()) / 2; }

/// The symmetric matrix with its negative eigenvalues set to zero.
Matrix2d positive_part(const Matrix2d& S) {
  const SelfAdjointEigenSolver<Matrix2d> modes(S);
  return modes.eigenvectors() * modes.eigenvalues().cwiseMax(0).asDiagonal() *
         modes.eigenvectors().transpose();
}

/// A bound on the stiffness matrix of a triangle: A size on the corners' parts a_k. For any dx
/// A dE:C:dE <= A size sum a_k |dx_k|^2, dE = sym(F^T dF). The least such size is the largest
/// eigenvalue of C^1/2 (sum B_k B_k^T/a_k) C^1/2, B_k the derivative of dE by dx_k.
struct TriangleBound {
  Vector3d parts;   // times A [m^2]
  Matrix2d spread;  // sum of g_k g_k^T/a_k [1/m^2]
  Matrix3d root;    // of C [sqrt(N/m)]

  explicit TriangleBound(const RestTriangle& t) : root(t.material.root()) {
    const Vector3d norms = t.gradients.colwise().norm(), shares = norms / norms.sum();
    parts = t.area * shares;
    spread = t.gradients * shares.cwiseInverse().asDiagonal() * t.gradients.transpose();
  }

  /// Of the material, with FF = F^T F [N/m^3].
  double size_of_material(const Matrix2d& FF) const {
    const Matrix2d& G = spread;
    Matrix3d N;
    N << FF(0, 0) * G(0, 0), FF(0, 1) * G(0, 1),
        (FF(0, 0) * G(0, 1) + FF(0, 1) * G(0, 0)) * M_SQRT1_2,                         //
        0, FF(1, 1) * G(1, 1), (FF(0, 1) * G(1, 1) + FF(1, 1) * G(0, 1)) * M_SQRT1_2,  //
        0, 0, (FF(0, 0) * G(1, 1) + FF(1, 1) * G(0, 0)) / 2 + FF(0, 1) * G(0, 1);
    return eigenvalues_of(Matrix3d(root * N.selfadjointView<Eigen::Upper>() * root)).maxCoeff();
  }
  /// Of A dF S : dF, with either sign of S [N/m^3].
  double size_of_stress(const Matrix2d& S) const {
    return eigenvalues_of(S).cwiseAbs().maxCoeff() * eigenvalues_of(spread).maxCoeff();
  }
  void add_rows(const Triangle& corners, double size, PerParticle& rows) const {
    for (int k = 0; k < 3; ++k) rows[corners[size_t(k)]] += size * parts[k];
  }
};

struct Membrane {
  std::vector<RestTriangle> triangles;
  std::vector<TriangleBound> bounds;  // of each

  void add_elastic(const PerParticle3& x, PerParticle3& f) const {
    for (const RestTriangle& t : triangles) {
      const Matrix32 F = t.gradient_of(x);
      t.push(F * t.material.stress(strain_of(F)), f);
    }
  }

  double energy(const PerParticle3& x) const {
    double sum = 0;
    for (const RestTriangle& t : triangles) {
      const Matrix2d E = strain_of(t.gradient_of(x));
      sum += t.area / 2 * t.material.stress(E).cwiseProduct(E).sum();
    }
    return sum;
  }

  /// F and S of each triangle.
  struct Shape {
    Matrix32 F;
    Matrix2d S;
  };
  std::vector<Shape> shapes_at(const PerParticle3& x) const {
    std::vector<Shape> shapes;
    shapes.reserve(triangles.size());
    for (const RestTriangle& t : triangles) {
      const Matrix32 F = t.gradient_of(x);
      shapes.push_back({F, t.material.stress(strain_of(F))});
    }
    return shapes;
  }

  void add_stiffness_bound(const PerParticle3& x, PerParticle& rows) const {
    for (size_t k = 0; k < triangles.size(); ++k) {
      const RestTriangle& t = triangles[k];
      const Matrix32 F = t.gradient_of(x);
      const double size = bounds[k].size_of_material(F.transpose() * F) +
                          bounds[k].size_of_stress(t.material.stress(strain_of(F)));
      bounds[k].add_rows(t.corners, size, rows);
    }
  }
};

Stiffness stiffness_of(const MembraneMaterial& m) {
  for (const double number : {m.warp, m.weft, m.shear, m.poisson, m.damping})
    if (!(number >= 0) || !std::isfinite(number))
      throw InputError("membrane: moduli, Poisson's ratio and damping must be finite and >= 0");
  const double other = m.warp > 0 ? m.poisson * m.weft / m.warp : 0, left = 1 - m.poisson * other;
  if (!(left > 0))
    throw InputError("membrane: nu12^2 E2/E1 must be below 1; such a sheet would gain energy");
  const double c22 = m.weft / left;
  return {m.warp / left, m.poisson * c22, c22, m.shear, m.damping};
}

RestTriangle rest_triangle(const Triangle& corners, const FlatTriangle& flat,
                           const MembraneMaterial& material) {
  const Matrix2d turn = Eigen::Rotation2Dd(-material.direction).toRotationMatrix();
  Matrix2d sides;
  sides << turn * (flat[1] - flat[0]), turn * (flat[2] - flat[0]);
  const Matrix2d inverse = sides.inverse();
  Matrix23 gradients;
  gradients.col(1) = inverse.row(0).transpose();
  gradients.col(2) = inverse.row(1).transpose();
  gradients.col(0) = -(gradients.col(1) + gradients.col(2));
  return {corners, gradients, std::abs(sides.determinant()) / 2, stiffness_of(material)};
}

}  // namespace

CustomForce make_membrane(const TriangleMesh& mesh, const std::vector<MembraneMaterial>& materials,
                          const std::vector<int>& of_triangle) {
  const auto all = std::make_shared<Membrane>();
  const std::vector<FlatTriangle> corners = flat_corners(mesh, "membrane");
  for (size_t t = 0; t < corners.size(); ++t)
    all->triangles.push_back(rest_triangle(mesh.triangles[t], corners[t],
                                           materials[of_triangle.empty() ? 0 : of_triangle[t]]));
  for (const RestTriangle& t : all->triangles) all->bounds.emplace_back(t);

  CustomForce force;
  force.energy_term = &Energies::stretch;
  force.needs_velocity = false;
  force.elastic = [all](const State& s, PerParticle3& f) { all->add_elastic(s.x, f); };
  force.potential = [all](const State& s) { return all->energy(s.x); };
  force.stiffness_bound = [all](const State& s, PerParticle& rows) {
    all->add_stiffness_bound(s.x, rows);
  };
  force.differential = [all](const State& s, Definiteness definiteness) -> CustomForce::Product {
    std::vector<Membrane::Shape> shapes = all->shapes_at(s.x);
    if (definiteness == Definiteness::semidefinite)
      for (Membrane::Shape& shape : shapes) shape.S = positive_part(shape.S);
    return [all, shapes = std::move(shapes)](const PerParticle3& dx, PerParticle3& df) {
      for (size_t k = 0; k < shapes.size(); ++k) {
        const RestTriangle& t = all->triangles[k];
        const Matrix32 dF = t.gradient_of(dx);
        t.push(dF * shapes[k].S + changed(t.material, shapes[k].F, dF), df);
      }
    };
  };
  if (std::ranges::any_of(materials, [](const auto& of) { return of.damping > 0; }))
    force.damping = [all](const State& s) -> DampingOperator::Custom {
      const auto shapes = std::make_shared<const std::vector<Membrane::Shape>>(all->shapes_at(s.x));
      return {[all, shapes](const PerParticle3& v, PerParticle3& f) {
                for (size_t k = 0; k < shapes->size(); ++k) {
                  const RestTriangle& t = all->triangles[k];
                  const Matrix32 stress = changed(t.material, (*shapes)[k].F, t.gradient_of(v));
                  t.push(t.material.damping * stress, f);
                }
              },
              [all, shapes](PerParticle& rows) {
                for (size_t k = 0; k < shapes->size(); ++k) {
                  const RestTriangle& t = all->triangles[k];
                  const Matrix32& F = (*shapes)[k].F;
                  const TriangleBound& bound = all->bounds[k];
                  bound.add_rows(t.corners,
                                 t.material.damping * bound.size_of_material(F.transpose() * F),
                                 rows);
                }
              }};
    };
  return force;
}

}  // namespace foldproof
