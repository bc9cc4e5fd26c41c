// The triangle membrane: forces from an energy, exact derivatives, and strips cut at an angle to
// the warp against the closed form.
#include "reference/beyond/membrane.h"

#include "reference/mesh/rigidity_map.h"
#include "reference/mesh/shapes.h"
#include "verification/oracles/dense_algebra.h"
#include "verification/specimens/check.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/trial_cases.h"
#include "verification/specimens/probe.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

// nu21 = .27 * 310/830 = .10: nothing is symmetric by accident
const MembraneMaterial cloth{830, 310, 47, 0.27, 0.03, 0.4};

/// Crumpled sheets whose rest shape is flat, with a membrane instead of any other force.
std::vector<Specimen> sheets_of(const MembraneMaterial& material) {
  std::vector<Specimen> sheets;
  for (Specimen& sheet : crumpled_sheets()) {
    RestPlane plane;
    if (!is_flat(sheet.scene.mesh, plane) || sheets.size() == 4) continue;
    sheet.scene.membrane = material;
    sheets.push_back(sheet);
  }
  return sheets;
}

PerParticle3 elastic_at(const System& system, const State& s) {
  Work work;
  return elastic_forces(system.forces, s, work);
}

Finding gradient_finding() {
  Table errors{{"sheet", "1"}, {"error", "of the largest force"}};
  for (const Specimen& sheet : sheets_of(cloth)) {
    const System system = build_system(sheet.scene);
    const PerParticle3 force = elastic_at(system, sheet.state);
    Worst worst;
    for (const Eigen::Index i : {Eigen::Index(3), force.size() / 2, force.size() - 2}) {
      const auto slope = [&](double step) {
        State plus = sheet.state, minus = sheet.state;
        plus.x.reshaped()[i] += step;
        minus.x.reshaped()[i] -= step;
        return (energies(system, plus).stretch - energies(system, minus).stretch) / (2 * step);
      };
      const double h = 1e-3 * extent(sheet.state.x),
                   extrapolated = (4 * slope(h / 2) - slope(h)) / 3;
      worst.observe(std::abs(force.reshaped()[i] + extrapolated) / force.cwiseAbs().maxCoeff());
    }
    errors.row(sheet.name, worst.value());
  }
  return judge_worst(errors, 1e-9,
                     "the energy is of fourth degree in a place: extrapolated differences are "
                     "exact, and lose 1e-16 of it over 1e-3 of the extent");
}

Finding derivative_finding() {
  Table errors{{"sheet", "1"}, {"asymmetry", "of the largest entry"}, {"error", "the same"}};
  for (const Specimen& sheet : sheets_of(cloth)) {
    const System system = build_system(sheet.scene);
    Work work;
    const Eigen::MatrixXd K =
        matrix_of(elastic_differential_at(system.forces, sheet.state, Definiteness::exact, work),
                  sheet.state.x.cols());
    const auto slopes = [&](double step) {
      return central_differences([&](const State& s) { return elastic_at(system, s); }, sheet.state,
                                 step);
    };
    const double h = 1e-3 * extent(sheet.state.x);
    const Eigen::MatrixXd exact = (4 * slopes(h / 2) - slopes(h)) / 3;
    const double asymmetry = largest_entry(K - K.transpose()) / largest_entry(K);
    errors.row(sheet.name, asymmetry,
               asymmetry <= 1e-13 ? largest_entry(K - exact) / largest_entry(K) : nan);
  }
  return judge_worst(errors, 1e-9,
                     "forces are cubic in the places: extrapolated differences are exact, and lose "
                     "1e-16 over 1e-3 of the extent; asymmetry beyond 1e-13 fails outright");
}

Finding definite_finding() {
  Table worst{{"sheet", "1"},
              {"largest eigenvalue", "of the size"},
              {"of the damping", "of the size"},
              {"over the bound", "1"},
              {"judged", "1"}};
  for (const Specimen& sheet : sheets_of(cloth)) {
    const System system = build_system(sheet.scene);
    const Eigen::Index n = sheet.state.x.cols();
    Work work;
    const auto eigenvalues = [&](Definiteness definiteness) {
      return oracles::symmetric_eigenvalues(
          matrix_of(elastic_differential_at(system.forces, sheet.state, definiteness, work), n));
    };
    const Eigen::VectorXd kept = eigenvalues(Definiteness::semidefinite),
                          exact = eigenvalues(Definiteness::exact);
    const auto damping = damping_at(system.forces, sheet.state, work);
    const Eigen::MatrixXd D = matrix_of(n, [&](const PerParticle3& v) {
      PerParticle3 f = PerParticle3::Zero(3, n);
      damping->add_product(v, f);
      return f;
    });
    const Eigen::VectorXd damped = oracles::symmetric_eigenvalues(D);
    const double size = kept.cwiseAbs().maxCoeff();
    const double over =
        exact.cwiseAbs().maxCoeff() /
        stiffness_row_bounds(system.forces, sheet.state, StickingPart::all).maxCoeff();
    const double largest = kept.maxCoeff() / size,
                 of_damping = damped.maxCoeff() / damped.cwiseAbs().maxCoeff();
    worst.row(sheet.name, largest, of_damping, over,
              over > 0.3 && over <= 1 ? std::max(largest, of_damping) : nan);
  }
  return judge_worst(worst, 1e-12,
                     "eigenvalues of a matrix of some hundred rows carry a few hundred roundings; "
                     "a bound that the largest eigenvalue exceeds, or that is three times as "
                     "large, fails outright");
}

Finding rigid_finding() {
  Table errors{{"sheet", "1"}, {"force", "epsilon"}, {"sums", "epsilon"}};
  for (const Specimen& sheet : sheets_of(cloth)) {
    const System system = build_system(sheet.scene);
    State turned = sheet.state;
    turned.x = Eigen::AngleAxisd(1.1, Vector3(1, 2, -3).normalized()).toRotationMatrix() *
               sheet.scene.mesh.rest;
    const PerParticle3 at_rest = elastic_at(system, turned),
                       force = elastic_at(system, sheet.state);
    Vector3 torque = Vector3::Zero();
    double size = 0;
    for (Eigen::Index i = 0; i < force.cols(); ++i) {
      torque += Vector3(sheet.state.x.col(i)).cross(Vector3(force.col(i)));
      size += sheet.state.x.col(i).norm() * force.col(i).norm();
    }
    const double unit = epsilon * cloth.warp * extent(turned.x);
    errors.row(sheet.name, at_rest.cwiseAbs().maxCoeff() / unit,
               std::max(force.rowwise().sum().norm() / (epsilon * force.colwise().norm().sum()),
                        torque.norm() / (epsilon * size)));
  }
  const double still = errors.worst("force");
  return judge_worst(
      errors, "sums", still <= 64 ? 16.0 : 0.0,
      "a triangle's three forces cancel to a rounding, and many are added; a turned "
      "rest shape with forces beyond 64 roundings of E1 times the extent has no bound");
}

/// A flat strip along x, its warp at `angle` to x, and its stiffness matrix at rest [N/m].
struct Strip {
  System system;
  State rest;
  Eigen::MatrixXd K;
};

Strip strip_at(const TriangleMesh& mesh, double angle) {
  Scene scene = scene_at_rest(mesh, 1);
  scene.membrane = cloth;
  scene.membrane->direction = angle;
  Strip strip{build_system(scene), start_state(scene), {}};
  Work work;
  const auto derivative =
      elastic_differential_at(strip.system.forces, strip.rest, Definiteness::exact, work);
  strip.K = -matrix_of(derivative, strip.rest.x.cols());
  return strip;
}

/// The force over width and strain of a flat strip of length L along x, its warp at `angle` to x,
/// whose ends slide on walls: one particle is held across. Solved with the matrix at rest.
double modulus_of_strip(const TriangleMesh& mesh, double angle) {
  const auto [system, rest, K] = strip_at(mesh, angle);
  const double length = rest.x.row(0).maxCoeff(), width = rest.x.row(1).maxCoeff(), strain = 1e-3;
  Eigen::VectorXd u = Eigen::VectorXd::Zero(K.rows());
  std::vector<Eigen::Index> free, right;
  for (Eigen::Index i = 0; i < rest.x.cols(); ++i) {
    const bool is_left = rest.x(0, i) == 0, is_right = rest.x(0, i) == length;
    if (is_right) u[3 * i] = strain * length, right.push_back(3 * i);
    if (!is_left && !is_right) free.push_back(3 * i);
    if (i > 0) free.push_back(3 * i + 1);  // particle 0 is a corner
  }
  const Eigen::VectorXd loads = -(K * u)(free);
  u(free) = oracles::solve_linear(K(free, free), loads);
  return (K * u)(right).sum() / (width * strain);
}

Finding strip_finding() {
  Table errors{{"mesh", "1"},
               {"angle", "degrees"},
               {"modulus", "N/m"},
               {"closed form", "N/m"},
               {"error", "1"}};
  const std::vector<std::pair<std::string, Sheet>> sheets = {
      {"squares", {SheetPattern::one_diagonal, 0.3, 0.1, 9, 3}},
      {"jittered", {SheetPattern::jittered, 0.3, 0.1, 9, 3, 0.3, 5}},
      {"random", {SheetPattern::random_delaunay, 0.3, 0.1, 9, 3, 0, 5}}};
  for (const auto& [name, sheet] : sheets) {
    const TriangleMesh mesh = make_sheet(sheet);
    for (const double degrees : {0.0, 22.5, 45.0, 67.5, 90.0}) {
      const double angle = degrees * pi / 180, measured = modulus_of_strip(mesh, angle);
      // by the compliances, rather than by the stiffness that the code turns into forces
      const double c = std::cos(angle), s = std::sin(angle);
      const double compliance = std::pow(c, 4) / cloth.warp + std::pow(s, 4) / cloth.weft +
                                c * c * s * s * (1 / cloth.shear - 2 * cloth.poisson / cloth.warp);
      errors.row(name, degrees, measured, 1 / compliance, std::abs(measured * compliance - 1));
    }
  }
  return judge_worst(
      errors, 1e-9,
      "between ends that slide along walls the strain is uniform, which triangles of "
      "any shape can follow: what is left is the rounding of the linear solve");
}

/// The deflection along it of the lower end of a strip that hangs by its upper edge, free to narrow
/// and to shear, under its weight of sigma g [N/m^2]; linear, with the matrix at rest.
double lengthening_of_strip(const TriangleMesh& mesh, double angle, double weight) {
  const auto [system, rest, K] = strip_at(mesh, angle);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(K.rows()), load = u;
  std::vector<Eigen::Index> free;
  const double length = rest.x.row(0).maxCoeff();
  for (Eigen::Index i = 0; i < rest.x.cols(); ++i) {
    load[3 * i] = system.mass[i] * weight;
    if (rest.x(0, i) > 0) free.push_back(3 * i);
    if (i > 0) free.push_back(3 * i + 1);  // particle 0 is a corner of the held edge
  }
  u(free) = oracles::solve_linear(K(free, free), Eigen::VectorXd(load(free)));
  double sum = 0, ends = 0;
  for (Eigen::Index i = 0; i < rest.x.cols(); ++i)
    if (rest.x(0, i) == length) sum += u[3 * i], ++ends;
  return sum / ends;
}

Finding hanging_finding() {
  Table errors{{"angle", "degrees"},
               {"rows", "1"},
               {"lengthening", "m"},
               {"closed form", "m"},
               {"error", "1"}};
  const double L = 0.6, weight = 2.3;
  for (const double degrees : {0.0, 45.0, 67.5})
    for (const int rows : {2, 4}) {
      const TriangleMesh mesh =
          make_sheet({SheetPattern::random_delaunay, L, L / 8, 8 * rows, rows, 0, 5});
      const double angle = degrees * pi / 180, c = std::cos(angle), s = std::sin(angle),
                   compliance = std::pow(c, 4) / cloth.warp + std::pow(s, 4) / cloth.weft +
                                c * c * s * s * (1 / cloth.shear - 2 * cloth.poisson / cloth.warp),
                   exact = weight * L * L / 2 * compliance,
                   measured = lengthening_of_strip(mesh, angle, weight);
      errors.row(degrees, rows, measured, exact, std::abs(measured / exact - 1));
    }
  return judge_worst(errors, 2e-3,
                     "triangles follow the linear strain to the square of their size over the "
                     "length, 1/32^2");
}

/// All places follow F = (1 gamma; 0 1): the stress on the frame is F S at every border.
Finding frame_finding() {
  Table errors{{"mesh", "1"}, {"gamma", "1"}, {"force along", "epsilon"}, {"energy", "epsilon"}};
  const MembraneMaterial aligned{830, 310, 47, 0.27, 0, 0};
  const double width = 0.3, height = 0.2, c22 = 310 / (1 - 0.27 * 0.27 * 310 / 830);
  for (const auto pattern : {SheetPattern::one_diagonal, SheetPattern::random_delaunay})
    for (const double gamma : {1e-3, 0.4}) {
      Scene scene = scene_at_rest(make_sheet({pattern, width, height, 5, 4, 0, 3}), 0.1);
      scene.membrane = aligned;
      const System system = build_system(scene);
      State s = start_state(scene);
      s.x.row(0) += gamma * scene.x.row(1);
      const PerParticle3 force = elastic_at(system, s);
      double top = 0;  // that the frame pulls the top edge along with [N]
      for (Eigen::Index i = 0; i < s.x.cols(); ++i)
        if (scene.x(1, i) == scene.x.row(1).maxCoeff()) top -= force(0, i);
      // E22 = gamma^2/2, 2 E12 = gamma: P12 = S12 + gamma S22
      const double wanted = width * (47 * gamma + gamma * c22 * gamma * gamma / 2),
                   energy =
                       width * height / 2 * (47 * gamma * gamma + c22 * std::pow(gamma, 4) / 4);
      errors.row(pattern == SheetPattern::one_diagonal ? "squares" : "random", gamma,
                 std::abs(top / wanted - 1) * gamma / epsilon,
                 std::abs(energies(system, s).stretch / energy - 1) * gamma / epsilon);
    }
  const double of_energy = errors.worst("energy");
  return judge_worst(errors, "force along", of_energy <= 64 ? 64 : 0,
                     "strains of gamma are differences of places of size 1, and some twenty "
                     "triangles add up");
}

Finding rejected_finding() {
  Differences differences;
  const TriangleMesh flat = make_sheet({SheetPattern::one_diagonal, 1, 1, 2, 2});
  const auto refuses = [&](const TriangleMesh& mesh, const MembraneMaterial& material,
                           const std::string& words) {
    return is_rejected([&] { make_membrane(mesh, {material}); }, words);
  };
  differences.is("a negative modulus", refuses(flat, {-1, 1, 1, 0, 0, 0}, "membrane: moduli"));
  differences.is("a Poisson ratio that would gain energy",
                 refuses(flat, {100, 400, 10, 0.6, 0, 0}, "nu12^2 E2/E1"));
  differences.is("a rest shape that is not flat, without a pattern",
                 refuses(make_icosphere(1, 1), cloth, "give [cloth] pattern"));
  return differences.judged(0, "each is tried");
}

}  // namespace

std::vector<Check> membrane_checks() {
  const std::string source = "reference/beyond/membrane.h";
  return {
      {"membrane.force-is-minus-the-gradient",
       "The membrane's forces are minus the gradient of its energy.", source, gradient_finding},
      {"membrane.differential-is-exact",
       "The membrane's differential is the derivative of its forces, and symmetric.", source,
       derivative_finding},
      {"membrane.semidefinite-differential",
       "Its semidefinite differential and its damping take energy away, and its stiffness stays "
       "below its bound.",
       source, definite_finding},
      {"membrane.rigid-motion-is-free",
       "A turned rest shape has no forces, and forces of a crumpled one have no sum and no torque.",
       source, rigid_finding},
      {"membrane.strips-have-the-orthotropic-modulus",
       "Strips at five angles to the warp, on three meshes, have the modulus of the closed form.",
       source, strip_finding},
      {"membrane.strips-hang-by-their-modulus",
       "Strips along the warp and on the bias lengthen under their weight as the closed form says.",
       source, hanging_finding},
      {"membrane.shear-frame",
       "A sheared frame is held by the shear modulus, at small and at large angles.", source,
       frame_finding},
      {"membrane.bad-materials-are-refused", "Materials and meshes that cannot be are refused.",
       source, rejected_finding},
  };
}

}  // namespace foldproof
