// A sheet and a fixed ball: it falls on it, comes to rest, slides down.

#include "verification/subjects/suite/laws.h"
#include "verification/subjects/suite/relaxation.h"

namespace foldproof {

namespace {

using namespace suite;

constexpr double radius = 0.3;  // m
constexpr double gap = 0.2;     // m, that the sheet falls before it meets the ball

/// A level sheet of 8 x 8 cells, its middle above the ball's.
PortableScene sheet_over_a_ball() {
  PortableScene scene = sheet_of_cells(8);
  scene.name = "sheet over a ball";
  scene.gravity = Vector3(0, 0, -weight);
  scene.spheres = {{middle_of(scene.x) - Vector3(0, 0, gap + radius), radius, 0.5}};
  return scene;
}

/// Of each particle to the ball, negative inside [m].
Eigen::RowVectorXd distances(const PortableScene& scene, const PerParticle3& x) {
  return (x.colwise() - scene.spheres[0].centre).colwise().norm().array() - radius;
}

/// How near a sheet that lies on the ball must come [m]: a tenth of an edge is left for
/// a thickness, and a solver that keeps triangles of edge L out holds their corners
/// L^2/(6 radius) above.
double allowed_clearance(const PortableScene& scene) {
  const double edge = rest_lengths(scene.mesh).mean();
  return edge / 10 + edge * edge / (6 * radius);
}

constexpr long fall_steps = 250;

Finding falling_sheet_stays_outside(Trial& trial) {
  const PortableScene scene = sheet_over_a_ball();
  double fastest = 0, deepest = 0, ratio = 0, nearest = std::numeric_limits<double>::infinity();
  for (const Snapshot& now : trial.motion(scene, multiples(1, fall_steps))) {
    const double least = distances(scene, now.x).minCoeff();
    fastest = std::max(fastest, largest(now.v));
    deepest = std::max(deepest, -least), nearest = std::min(nearest, std::abs(least));
    ratio = std::max(ratio, -least / (fastest * scene.dt));
  }
  const double allowed = allowed_clearance(scene);
  Table measured("of; measured [m]; largest part of what is allowed [1]");
  measured.row("deepest particle", deepest, ratio);
  measured.row("nearest approach", nearest, nearest / allowed);
  return judge_worst(
      measured, 1,
      "a contact that is found after the step lets a particle in by at most what it travels in a "
      "step, at the largest speed so far; above the ball, a tenth of an edge is allowed for a "
      "thickness, and L^2/(6 r) for triangles that stay outside");
}

Finding comes_to_rest(Trial& trial) {
  const PortableScene scene = sheet_over_a_ball();
  const double edge = rest_lengths(scene.mesh).mean(), size = largest(scene.x);
  constexpr double enough = 1e-3;
  const Relaxed end = relaxed(trial, scene, {scene.x, size, enough, 0.01});
  const Eigen::RowVectorXd apart = distances(scene, end.x);
  const double deepest = std::max(0.0, -apart.minCoeff()), nearest = std::abs(apart.minCoeff());
  Table measured("of; measured [m]; allowed [m]; ratio [1]");
  measured.row("last two rounds of motion", end.last_move, enough * size,
               end.last_move / (enough * size));
  measured.row("deepest particle", deepest, 0.01 * edge, deepest / (0.01 * edge));
  measured.row("nearest particle", nearest, allowed_clearance(scene),
               nearest / allowed_clearance(scene));
  return judge_worst(
      measured, 1,
      "empirical: a thousandth of the size does not count as motion, and a depth of a hundredth of "
      "an edge cannot be seen in a picture; above the ball, a tenth of an edge is allowed for a "
      "thickness, and L^2/(6 r) for triangles that stay outside");
}

//        .  phi      a point that slides down a ball of radius r, way r phi:
//      .  |/
//     .   o          N/m = g cos(phi) - r phi'^2         the ball pushes, as long as N > 0
//     .              r phi'' = g sin(phi) - mu N/m
//
/// The way of a point from rest at phi0 [m]; none where tan(phi0) <= mu.
double way_of_a_point(double phi0, double mu, double ball_radius, double time) {
  if (std::tan(phi0) <= mu) return 0;
  constexpr int steps = 20000;
  const double dt = time / steps;
  double phi = phi0, rate = 0;
  for (int k = 0; k < steps; ++k) {  // leapfrog; it errs by dt^2, far below the bound
    const double middle = phi + dt / 2 * rate;
    const double push = std::max(0.0, weight * std::cos(middle) - ball_radius * rate * rate);
    rate += dt * (weight * std::sin(middle) - mu * push) / ball_radius;
    phi = middle + dt / 2 * rate;
  }
  return ball_radius * (phi - phi0);
}

constexpr double large = 2;  // m, the radius of a ball on which a sheet of 0.4 m is hardly bent
constexpr long slide_steps = 300;

/// A sheet that lies on a large ball, its middle at the angle phi from the top, towards x. Each
/// particle keeps its distance from the middle and its direction.
PortableScene sheet_on_a_ball(double phi, double friction) {
  PortableScene scene = sheet_of_cells(4);
  scene.name = "sheet on a large ball";
  scene.gravity = Vector3(0, 0, -weight);
  const Vector3 middle = middle_of(scene.x);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(phi, Vector3::UnitY()).toRotationMatrix();
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const Vector3 out = scene.mesh.rest.col(i) - middle;
    const double r = out.norm(), angle = r / large;
    const Vector3 along = r > 0 ? Vector3(out / r) : Vector3::UnitX();
    scene.x.col(i) =
        large * (turn * (std::sin(angle) * along + std::cos(angle) * Vector3::UnitZ()));
  }
  scene.spheres = {{Vector3::Zero(), large, friction}};
  return scene;
}

double angle_from_the_top(const PerParticle3& x) {
  const Vector3 mean = x.rowwise().mean();
  return std::atan2(mean.x(), mean.z());
}

Finding slides_as_coulomb_says(Trial& trial) {
  Table measured = table_of(
      "angle from the top [degrees] | mu [1] | distance down [m] | by Coulomb's law [m] | "
      "difference [of the frictionless distance]");
  struct Slide {
    double degrees, friction;
  };
  for (const auto& [degrees, friction] :
       {Slide{15, 0.5}, {30, 0.9}, {20, 0.07}, {25, 0.21}, {40, 0.32}, {50, 0.63}}) {
    const double start = degrees * pi / 180;
    const PortableScene scene = sheet_on_a_ball(start, friction);
    const double time = double(slide_steps) * scene.dt;
    const double way = large * (angle_from_the_top(trial.after(scene, slide_steps).x) - start);
    const double expected = way_of_a_point(start, friction, large, time);
    const double without = way_of_a_point(start, 0, large, time);
    measured.row(degrees, friction, way, expected, std::abs(way - expected) / without);
  }
  return judge_worst(measured, 0.03,
                     "the step in which contact begins is 1 % of the way; 300 steps of a first "
                     "order method err by 0.3 %, and the sheet's own waves by 1 %; that the sheet "
                     "is not a point adds (0.2/2)^2/2 = 0.5 %");
}

}  // namespace

std::vector<Law> ball_laws() {
  return {
      {"ball.falling-sheet-stays-outside",
       "A sheet that falls on a ball meets it, and sinks in by no more than it travels in a step.",
       "impenetrability", falling_sheet_stays_outside, "spheres"},
      {"ball.sheet-comes-to-rest", "A sheet comes to rest on a ball that has friction.",
       "equilibrium", comes_to_rest, "spheres"},
      {"ball.slides-as-coulomb-says",
       "On a large ball, a sheet sticks, or slides as a point does by Coulomb's law.", "Coulomb",
       slides_as_coulomb_says, "spheres", "mu | distance down | by Coulomb's law"},
  };
}

}  // namespace foldproof
