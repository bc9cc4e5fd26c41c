#include "verification/checks/oracles/agreement.h"
#include "verification/oracles/definitions.h"
#include "verification/oracles/exact_solutions.h"
#include "verification/oracles/force_derivatives.h"
#include "verification/oracles/scalars.h"
#include "verification/oracles/sticking.h"
#include "verification/specimens/random.h"
#include "verification/specimens/specimens.h"

namespace foldproof {

namespace {

using oracles::Estimate;
using oracles::HingeInput;

/// Hinges of sizes from a millimetre to a metre, folded by angles of both signs; all constants
/// differ.
std::vector<HingeInput> random_hinge_inputs() {
  Random random(811);
  std::vector<HingeInput> list;
  for (const double angle : {-2.9, -1.3, -.02, .4, 1.7, 3.05}) {
    const double size = random.log_uniform(1e-3, 1);
    HingeInput hinge;
    hinge.x = random_corners(random, angle);
    hinge.rest = random_corners(random, random.uniform(-1, 1));
    for (std::size_t corner = 0; corner < 4; ++corner) {
      hinge.x[corner] *= size;
      hinge.rest[corner] *= size;
      hinge.v[corner] = random.vectors(1, 1.5).col(0);
    }
    hinge.ke = random.log_uniform(1e-6, 1e-2);
    hinge.kd = random.log_uniform(1e-7, 1e-3);
    hinge.theta0 = random.uniform(-1.2, 1.2);
    list.push_back(hinge);
  }
  return list;
}

std::string numbered(const std::string& what, std::size_t number) {
  return what + " " + std::to_string(number + 1);
}

/// Corresponding components of vectors, each with its vector's uncertainty; `sign` reverses the
/// second.
template <int N>
Pairs pair_up(const oracles::VectorsEstimate<N>& one, const oracles::VectorsEstimate<N>& other,
              double sign) {
  Pairs pairs;
  for (std::size_t k = 0; k < std::size_t(N); ++k)
    for (int axis = 0; axis < 3; ++axis)
      pairs.push_back({{one.value[k][axis], one.uncertainty},
                       {sign * other.value[k][axis], other.uncertainty}});
  return pairs;
}

Pairs pair_up(const oracles::MatrixEstimate& one, const oracles::MatrixEstimate& other) {
  Pairs pairs;
  for (Eigen::Index i = 0; i < one.value.size(); ++i)
    pairs.push_back({{one.value.reshaped()[i], one.uncertainty},
                     {other.value.reshaped()[i], other.uncertainty}});
  return pairs;
}

/// f'(0) by central differences over `step` and half of it, extrapolated. The error is below the
/// difference of the two, plus the rounding of values of size `scale`.
Estimate slope(const std::function<double(double)>& f, double step, double scale) {
  const double wide = (f(step) - f(-step)) / (2 * step),
               narrow = (f(step / 2) - f(-step / 2)) / step;
  return {(4 * narrow - wide) / 3, std::abs(narrow - wide) + 8 * epsilon * scale / step};
}

/// The damping force of a hinge from its power -kd factor (d theta/dt)^2: -kd factor (d theta/dt)
/// grad theta [N].
oracles::VectorsEstimate<4> damping_from_power(const HingeInput& hinge) {
  const double rate = oracles::theta_rate_autodiff(hinge.x, hinge.v).value;
  const double edge = (hinge.x[3] - hinge.x[2]).norm();
  oracles::VectorsEstimate<4> force = oracles::theta_gradient_autodiff(hinge.x);
  double largest = 0;
  for (Vector3& f : force.value) {
    f *= -hinge.kd * edge * rate;
    largest = std::max(largest, f.cwiseAbs().maxCoeff());
  }
  force.uncertainty = 8 * epsilon * largest;  // four products and the rate's own rounding
  return force;
}

std::vector<oracles::SpringInput> springs() {
  Random random(821);
  std::vector<oracles::SpringInput> list;
  for (int i = 0; i < 5; ++i) {
    const double size = random.log_uniform(1e-3, 3);
    const PerParticle3 x = random.vectors(2, size), v = random.vectors(2, 2.5);
    list.push_back({{x.col(0), x.col(1)},
                    {v.col(0), v.col(1)},
                    {random.log_uniform(3, 1e4), random.log_uniform(1e-3, 2),
                     random.log_uniform(1e-6, 1), size * random.uniform(.4, 1.9)}});
  }
  return list;
}

/// A particle on one triangle, and one on two; at two sizes.
std::vector<oracles::StuckParticle> stuck_particles() {
  Random random(823);
  std::vector<oracles::StuckParticle> list;
  for (const std::size_t triangles : {1, 2, 1, 2}) {
    const double size = random.log_uniform(5e-3, 1);
    oracles::StuckParticle stuck;
    for (std::size_t t = 0; t < triangles; ++t) {
      const PerParticle3 jitter = random.vectors(3, .2 * size);
      stuck.corners.push_back({jitter.col(0), Vector3(size, 0, 0) + jitter.col(1),
                               Vector3(0, size, 0) + jitter.col(2)});
      stuck.places.push_back({random.uniform(.1, .5), random.uniform(.1, .4), .05 * size});
    }
    stuck.x = Vector3(.3, .25, .2) * size + random.vectors(1, .05 * size).col(0);
    stuck.stiffness = random.log_uniform(1, 1e3);
    stuck.far = 1.3 * size;
    list.push_back(stuck);
  }
  return list;
}

/// The stuck particle with coordinate k (the particle's, then the corners') moved by
/// `displacement` [m].
oracles::StuckParticle displace(oracles::StuckParticle stuck, Eigen::Index k, double displacement) {
  if (k < 3)
    stuck.x[k] += displacement;
  else
    stuck.corners[std::size_t(k - 3) / 9][std::size_t(k - 3) % 9 / 3][(k - 3) % 3] += displacement;
  return stuck;
}

/// Energy [J] of a cell's three springs, spun by .2 rad, when the sheet is deformed by F.
double energy_of_cell(double young, double side, const Eigen::Matrix2d& F) {
  const double cell = std::sqrt(3.) / 2 * side * side;
  double sum = 0;
  for (const double turn : {.2, .2 + pi / 3, .2 + 2 * pi / 3}) {
    const Eigen::Vector2d d = F * side * Eigen::Vector2d(std::cos(turn), std::sin(turn));
    sum += oracles::spring_energy<double>({}, {d.x(), d.y(), 0}, {young, 0, cell, side});
  }
  return sum / cell;
}

/// Twice the energy per area over the strain squared, by two strains of both signs [N/m].
Estimate modulus(double young, double side, const Eigen::Vector2d& strain) {
  const auto curvature = [&](double size) {
    double sum = 0;
    for (const double e : {size, -size})
      sum += energy_of_cell(
          young, side,
          Eigen::Matrix2d(Eigen::Vector2d(1 + e * strain[0], 1 + e * strain[1]).asDiagonal()));
    return sum / (size * size);
  };
  const double wide = curvature(2e-3), narrow = curvature(1e-3);
  return {(4 * narrow - wide) / 3, std::abs(narrow - wide) + 16 * epsilon / 1e-6 * young};
}

void hinge_angles_agree(Answers& answers) {
  const std::vector<HingeInput> hinges = random_hinge_inputs();
  for (std::size_t i = 0; i < hinges.size(); ++i) {
    const Estimate theta = oracles::hinge_angle_50(hinges[i].x);
    const double sine = std::sin(theta.value / 2);
    answers.compare(numbered("hinge", i), oracles::sin_half_angle_50(hinges[i].x),
                    {sine, theta.uncertainty / 2 + 2 * oracles::one_rounding(sine)});
  }
}

void bending_modes_agree(Answers& answers) {
  const std::vector<HingeInput> hinges = random_hinge_inputs();
  for (std::size_t i = 0; i < hinges.size(); ++i) {
    const auto u = oracles::bending_mode_50(hinges[i].x);
    const auto autodiff = oracles::theta_gradient_autodiff(hinges[i].x);
    const auto differences = oracles::theta_gradient_differences(hinges[i].x);
    answers.compare_worst(numbered("as printed and by autodiff, hinge", i),
                          pair_up(u, autodiff, -1));
    answers.compare_worst(numbered("by autodiff and by differences, hinge", i),
                          pair_up(autodiff, differences, 1));
  }
}

void bending_forces_agree(Answers& answers) {
  const std::vector<HingeInput> hinges = random_hinge_inputs();
  for (std::size_t i = 0; i < hinges.size(); ++i) {
    const auto force = oracles::bending_elastic_50(hinges[i]),
               gradient = oracles::energy_gradient_autodiff(hinges[i]);
    const auto damping = oracles::bending_damping_50(hinges[i]),
               from_power = damping_from_power(hinges[i]);
    answers.compare_worst(numbered("elastic, hinge", i), pair_up(force, gradient, -1));
    answers.compare_worst(numbered("damping, hinge", i), pair_up(damping, from_power, 1));
  }
}

void bending_derivatives_agree(Answers& answers) {
  const std::vector<HingeInput> hinges = random_hinge_inputs();
  for (std::size_t i = 0; i < hinges.size(); ++i) {
    const auto elastic = oracles::bending_elastic_derivative_autodiff(hinges[i]),
               by_differences = oracles::bending_elastic_derivative_differences(hinges[i]);
    const auto all = oracles::bending_force_derivative_autodiff(hinges[i]),
               all_by_differences = oracles::bending_force_derivative_differences(hinges[i]);
    answers.compare_worst(numbered("elastic, hinge", i), pair_up(elastic, by_differences));
    answers.compare_worst(numbered("elastic and damping, hinge", i),
                          pair_up(all, all_by_differences));
  }
}

void spring_forces_agree(Answers& answers) {
  const std::vector<oracles::SpringInput> list = springs();
  for (std::size_t i = 0; i < list.size(); ++i) {
    const auto force = oracles::spring_elastic_50(list[i]),
               gradient = oracles::spring_energy_gradient_autodiff(list[i]);
    answers.compare_worst(numbered("force and gradient of the energy, spring", i),
                          pair_up(force, gradient, -1));
    const auto derivative = oracles::spring_force_derivative_autodiff(list[i]);
    Pairs pairs;
    for (Eigen::Index row = 0; row < 6; ++row)
      for (Eigen::Index column = 0; column < 6; ++column) {
        const auto component = [&](double displacement) {
          oracles::SpringInput spring = list[i];
          spring.x[std::size_t(column / 3)][column % 3] += displacement;
          const std::size_t end = std::size_t(row / 3);
          return oracles::spring_elastic_50(spring).value[end][row % 3] +
                 oracles::spring_damping_50(spring).value[end][row % 3];
        };
        const double length = (list[i].x[1] - list[i].x[0]).norm();
        pairs.push_back({{derivative.value(row, column), derivative.uncertainty},
                         slope(component, 1e-3 * length, derivative.value.norm() * length)});
      }
    answers.compare_worst(numbered("derivative by autodiff and by differences, spring", i), pairs);
  }
}

void sticking_forces_agree(Answers& answers) {
  const std::vector<oracles::StuckParticle> list = stuck_particles();
  for (std::size_t i = 0; i < list.size(); ++i) {
    const oracles::StickingAnswer answer = oracles::sticking_answer(list[i]);
    Pairs pairs;
    for (Eigen::Index k = 0; k < answer.force.size(); ++k) {
      const auto energy = [&](double displacement) {
        return -oracles::sticking_answer(displace(list[i], k, displacement)).energy;
      };
      pairs.push_back({{answer.force[k], oracles::one_rounding(answer.force.norm())},
                       slope(energy, 1e-3 * list[i].far, answer.energy)});
    }
    answers.compare_worst(numbered("force and energy, particle", i), pairs);
  }
}

void sheet_moduli_agree(Answers& answers) {
  for (const auto& [young, side] : {std::pair{7.9, .31}, std::pair{430., 1.7}}) {
    const oracles::SheetModuli moduli = oracles::equilateral_sheet_moduli(young);
    const double nu = moduli.poisson.value;
    const std::string name = "Y " + std::to_string(young);
    answers.compare(name + ", pulled one way", moduli.young, modulus(young, side, {1, -nu}));
    // equal strains both ways store E/(1 - nu) e^2
    const Estimate both = modulus(young, side, {1, 1});
    answers.compare(name + ", pulled both ways", moduli.young,
                    {both.value * (1 - nu) / 2, both.uncertainty});
  }
}

}  // namespace

std::vector<Comparison> force_comparisons() {
  return {
      {"oracle.hinge-angles-agree",
       "The oracle's angle by atan2 and its printed sin(theta/2) agree, both in 50 digits.",
       hinge_angles_agree},
      {"oracle.bending-modes-agree",
       "The oracle's bending mode as printed is minus the gradient of theta by automatic "
       "differentiation, which is that by differences.",
       bending_modes_agree},
      {"oracle.bending-forces-agree",
       "The oracle's elastic force as printed is minus the gradient of the energy, its damping "
       "force "
       "follows from the power that it takes.",
       bending_forces_agree},
      {"oracle.bending-derivatives-agree",
       "The oracle's derivatives of bending forces by automatic differentiation are those by "
       "differences in 50 digits.",
       bending_derivatives_agree},
      {"oracle.spring-forces-agree",
       "The oracle's spring force is minus the gradient of its energy, and its derivative is that "
       "by "
       "differences.",
       spring_forces_agree},
      {"oracle.sticking-forces-agree",
       "The oracle's sticking force, by automatic differentiation, is minus the slope of its "
       "energy "
       "by differences.",
       sticking_forces_agree},
      {"oracle.sheet-moduli-agree",
       "The oracle's closed-form moduli of a sheet of springs follow from the energy of one cell's "
       "springs.",
       sheet_moduli_agree}};
}

}  // namespace foldproof
