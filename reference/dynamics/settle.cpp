#include "reference/dynamics/settle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "reference/dynamics/events.h"
#include "reference/forces/degenerate.h"

namespace foldproof {

namespace {

constexpr double standard_gravity = 9.80665;  // m/s^2

constexpr double first_step = 0.005;  // s
constexpr double in_flight = 1e-6;    // clearance over the longest step [1]
constexpr int most_landings = 4;      // rounds of a step in which points reach objects
constexpr double saddle = 1e-6;       // eigenvalue over the neutral scale below which one falls [1]
constexpr double nudge = 0.05;        // off a saddle, over the longest step [1]

// A touching point is held by a stiffness that much larger than the cloth's [1].
constexpr double held_over_elastic = 1e5;

/// Of the system's weight, or the standard one [m/s^2].
double gravity_of(const System& system) {
  for (const Force& force : system.forces)
    if (const auto* gravity = std::get_if<Gravity>(&force))
      if (gravity->acceleration.norm() > 0) return gravity->acceleration.norm();
  return standard_gravity;
}

/// unbalanced_forces of these elastic ones.
PerParticle3 left_by_filters(const System& system, const State& s, const PerParticle3& elastic,
                             double h, Work& work) {
  PerParticle3 v = h * elastic * system.inverse_mass.asDiagonal();
  correct(system.filters, {s.time, s.time + h, h}, s, v, work);
  return v * (system.mass / h).asDiagonal();
}

/// Displacements by one step of backward Euler, with the part of the derivative that is definite
/// where the exact one is not [m].
Eigen::VectorXd displacements(const Settling& settling, SparseFactors& factors,
                              const PerParticle3& x, const Eigen::VectorXd& force, double step) {
  const double mass_over = 1 / (step * step);
  factors.factorize(settling.stiffness(x, Definiteness::exact, mass_over));
  if (!positive_pivots(factors))
    factors.factorize(settling.stiffness(x, Definiteness::semidefinite, mass_over));
  return factors.solve(force);
}

/// A point of the cloth on an object.
struct Touch {
  CollisionPoint point;
  Vector3 normal;
  double phi;            // m
  double mu;             // 1
  bool sticks;           // held by friction
  double used;           // |F_T| over mu |F_N| [1]
  double load;           // force on the object, over the point's mass [m/s^2]
  Eigen::Matrix3d turn;  // derivative of the normal by the place [1/m]
};

/// The derivative of an object's normal by the place, along the surface, by differences.
Eigen::Matrix3d turn_of_normal(ObjectsOverSpan& objects, std::size_t part, const Vector3& p,
                               const Vector3& N, double by) {
  const Vector3 first = N.unitOrthogonal(), second = N.cross(first);
  Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
  for (const Vector3& along : {first, second}) {
    const Vector3 change =
        (objects.at(p + by * along)[part].normal - objects.at(p - by * along)[part].normal) /
        (2 * by);
    turn += (change - change.dot(N) * N) * along.transpose();
  }
  return (turn + turn.transpose()) / 2;
}

/// A system on its way to rest.
class Search {
 public:
  Search(const System& system, const State& start, const RestSearch& search)
      : system_(system),
        search_(search),
        freedoms_(freedoms_of(system)),
        hessian_(system, freedoms_),
        state_(start) {
    state_.v.setZero();
    const PerParticle rows = stiffness_row_bounds(system.forces, state_, StickingPart::all);
    hold_ = held_over_elastic * rows.maxCoeff();
  }

  Rest rest();

 private:
  Mode slowest(const PerParticle3& x);
  Settled settled_from(const PerParticle3& x);
  Push push(const PerParticle3& x);
  void find_touches(const PerParticle3& v);
  std::vector<AddedStiffness> holds(Definiteness definiteness) const;
  SparseMatrix stiffness(const PerParticle3& x, Definiteness definiteness, double mass_over) {
    state_.x = x;
    ++rest_.factorisations;
    return hessian_.at(state_, definiteness, mass_over, holds(definiteness));
  }
  PerParticle3 moved(const PerParticle3& x, const Eigen::VectorXd& by);
  Eigen::VectorXd landing(const PerParticle3& x, const Eigen::VectorXd& by);
  bool rises(const PerParticle3& from, const PerParticle3& to) const;

  const System& system_;
  const RestSearch& search_;
  Freedoms freedoms_;
  Hessian hessian_;
  State state_;
  double hold_;  // stiffness by which touching points are held [N/m]
  std::vector<Touch> touches_;
  Rest rest_ = {};
};

/// The points that the filters keep out of the objects, when the forces alone would give the
/// velocity v in one step.
void Search::find_touches(const PerParticle3& v) {
  touches_.clear();
  const double h = search_.step;
  for (const Filter& filter : system_.filters) {
    const auto* collision = std::get_if<ObjectCollision>(&filter);
    if (!collision) continue;
    const double tau = collision->forecast_time > 0 ? collision->forecast_time : h;
    ObjectsOverSpan objects(collision->objects, {state_.time, state_.time + h, h});
    for (const CollisionPoint& point : collision->points) {
      const Vector3 p = point.mean(state_.x), u = point.mean(v);
      const std::span<ObjectPoint> answers = answers_at(objects, point, p);
      const std::vector<ObjectPoint> at(answers.begin(), answers.end());
      for (std::size_t part = 0; part < at.size(); ++part) {
        const Vector3& N = at[part].normal;
        const double push = -(at[part].phi + tau * u.dot(N)) / tau;  // m/s
        if (!(push > 0)) continue;
        const double slide = (u - u.dot(N) * N).norm(), most = at[part].friction * push;
        Touch touch{point,
                    N,
                    at[part].phi,
                    at[part].friction,
                    most > 0 && slide <= most,
                    most > 0 ? slide / most : 0,
                    push / h,
                    Eigen::Matrix3d::Zero()};
        if (!touch.sticks) touch.turn = turn_of_normal(objects, part, p, N, 1e-3 * search_.longest);
        touches_.push_back(touch);
      }
    }
  }
}

/// Of the touching points: along the normal, or all ways. A convex surface gives way below a
/// point that slides: its load times the turn of the normal is taken off.
std::vector<AddedStiffness> Search::holds(Definiteness definiteness) const {
  std::vector<AddedStiffness> added;
  for (const Touch& touch : touches_) {
    Eigen::Matrix3d block = touch.sticks ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
                                         : Eigen::Matrix3d(touch.normal * touch.normal.transpose());
    block *= hold_;
    const double weight = 1.0 / touch.point.count;
    for (int k = 0; k < touch.point.count; ++k)
      for (int l = 0; l < touch.point.count; ++l)
        added.push_back({touch.point.particles[std::size_t(k)],
                         touch.point.particles[std::size_t(l)], weight * weight * block});
    if (definiteness == Definiteness::exact && touch.point.count == 1 && !touch.sticks) {
      const int i = touch.point.particles[0];
      added.push_back({i, i, -touch.load * system_.mass[i] * touch.turn});
    }
  }
  return added;
}

Push Search::push(const PerParticle3& x) {
  state_.x = x;
  begin_step(system_, state_, rest_.work);
  const PerParticle3 elastic = elastic_forces(system_.forces, state_, rest_.work);
  PerParticle3 force = left_by_filters(system_, state_, elastic, search_.step, rest_.work);
  rest_.unbalanced = largest_unbalanced(system_, force);
  find_touches(search_.step * elastic * system_.inverse_mass.asDiagonal());
  for (const Touch& touch : touches_)
    for (int k = 0; k < touch.point.count; ++k)
      force.col(touch.point.particles[std::size_t(k)]) -=
          hold_ * touch.phi / touch.point.count * touch.normal;
  return {freedoms_.gather(force), rest_.unbalanced.over_weight};
}

/// The filters keep what moves out of objects and out of itself.
PerParticle3 Search::moved(const PerParticle3& x, const Eigen::VectorXd& by) {
  PerParticle3 move = freedoms_.moved(PerParticle3::Zero(3, x.cols()), by);
  state_.x = x;
  correct(system_.filters, {state_.time, state_.time + 1, 1}, state_, move, rest_.work);
  return x + move;
}

/// Points in flight that the displacement takes into an object are held on its surface, and touch
/// it from now on. One that has just left a surface is not: it must be free to leave.
Eigen::VectorXd Search::landing(const PerParticle3& x, const Eigen::VectorXd& by) {
  const PerParticle3 end = freedoms_.moved(x, by);
  PerParticle3 force = PerParticle3::Zero(3, x.cols());
  const std::size_t before = touches_.size();
  std::vector<char> touched(std::size_t(x.cols()), 0);
  for (const Touch& touch : touches_) touched[std::size_t(touch.point.particles[0])] = 1;
  for (const Filter& filter : system_.filters) {
    const auto* collision = std::get_if<ObjectCollision>(&filter);
    if (!collision) continue;
    ObjectsOverSpan objects(collision->objects, {state_.time, state_.time, search_.step});
    for (const CollisionPoint& point : collision->points) {
      if (point.count == 1 && touched[std::size_t(point.particles[0])]) continue;
      const Vector3 p = point.mean(end), move = p - point.mean(x);
      double clearance = std::numeric_limits<double>::infinity();
      for (const ObjectPoint& at : objects.at(point.mean(x)))
        clearance = std::min(clearance, at.phi);
      if (!(clearance > in_flight * search_.longest)) continue;
      for (const ObjectPoint& at : answers_at(objects, point, p)) {
        if (!(at.phi < 0)) continue;
        const double phi = at.phi - move.dot(at.normal);
        touches_.push_back(
            {point, at.normal, phi, at.friction, false, 0, 0, Eigen::Matrix3d::Zero()});
        for (int k = 0; k < point.count; ++k)
          force.col(point.particles[std::size_t(k)]) -= hold_ * phi / point.count * at.normal;
      }
    }
  }
  if (touches_.size() == before) return {};
  return freedoms_.gather(force);
}

/// Whether the cloth gains potential energy by a step while it touches something. Contact and
/// friction give it none.
bool Search::rises(const PerParticle3& from, const PerParticle3& to) const {
  if (touches_.empty()) return false;
  const auto potential = [&](const PerParticle3& x) {
    State s = state_;
    s.x = x;
    const Energies e = energies(system_, s);
    double sum = 0, size = 0;
    for (auto term : energy_terms) sum += e.*term, size += std::abs(e.*term);
    return std::pair{sum, size};
  };
  const auto [before, size] = potential(from);
  return potential(to).first > before + 1e-10 * size;
}

Mode Search::slowest(const PerParticle3& x) {
  if (freedoms_.count == 0) return {};
  const PerParticle3 masses = system_.mass.transpose().replicate(3, 1);
  return slowest_mode(stiffness(x, Definiteness::exact, 0), freedoms_.gather(masses),
                      neutral_scale(x));
}

Settled Search::settled_from(const PerParticle3& x) {
  return settle(
      {[this](const PerParticle3& x) { return push(x); },
       [this](const PerParticle3& x, Definiteness definiteness, double mass_over) {
         return stiffness(x, definiteness, mass_over);
       },
       [this](const PerParticle3& x, const Eigen::VectorXd& by) { return moved(x, by); },
       [this](const PerParticle3& x, const Eigen::VectorXd& by) { return landing(x, by); },
       [this](const PerParticle3& from, const PerParticle3& to) { return rises(from, to); },
       search_.tolerance, search_.longest, search_.most_steps - rest_.steps},
      x);
}

Rest Search::rest() {
  Settled settled{state_.x};
  for (int left = 0;; ++left) {
    settled = settled_from(settled.x);
    rest_.steps += settled.steps;
    push(settled.x);
    rest_.state = state_;
    const Mode mode = slowest(settled.x);
    rest_.smallest_eigenvalue = mode.eigenvalue;
    const bool falls = mode.eigenvalue < -saddle * neutral_scale(settled.x);
    if (!falls || left == search_.saddles || rest_.steps >= search_.most_steps) break;
    settled.x =
        moved(settled.x, nudge * search_.longest / mode.shape.cwiseAbs().maxCoeff() * mode.shape);
  }
  rest_.touching = int(touches_.size());
  for (const Touch& touch : touches_) {
    rest_.sticking += touch.sticks;
    rest_.used_friction = std::max(rest_.used_friction, touch.used);
  }
  return rest_;
}

}  // namespace

Settled settle(const Settling& settling, PerParticle3 x) {
  SparseFactors factors;
  factors.analyzePattern(settling.stiffness(x, Definiteness::exact, 1));
  Settled rest{std::move(x), 0, 0};
  double step = first_step;
  for (; rest.steps < settling.most_steps; ++rest.steps) {
    Push push = settling.push(rest.x);
    rest.unbalanced = push.unbalanced;
    if (rest.unbalanced < settling.tolerance) break;
    Eigen::VectorXd by = displacements(settling, factors, rest.x, push.force, step);
    for (int k = 0; k < most_landings && settling.landing; ++k) {
      const Eigen::VectorXd held = settling.landing(rest.x, by);
      if (held.size() == 0) break;
      push.force += held;
      by = displacements(settling, factors, rest.x, push.force, step);
    }
    const double far = by.cwiseAbs().maxCoeff();
    if (!(far <= settling.longest)) {
      step /= 2;
      continue;
    }
    PerParticle3 next = settling.moved(rest.x, by);
    if (settling.rises && settling.rises(rest.x, next)) {
      step /= 4;
      continue;
    }
    rest.x = std::move(next);
    if (far < settling.longest / 4) step *= 1.5;
    // an active set that no longer changes anything, and is not the right one
    if (settling.landing && far < 1e-12 * settling.longest) step = first_step;
  }
  return rest;
}

PerParticle3 unbalanced_forces(const System& system, const State& s, double h, Work& work) {
  return left_by_filters(system, s, elastic_forces(system.forces, s, work), h, work);
}

Unbalanced largest_unbalanced(const System& system, const PerParticle3& forces) {
  const double g = gravity_of(system);
  Unbalanced largest;
  for (Eigen::Index i = 0; i < forces.cols(); ++i) {
    const double over_weight = forces.col(i).norm() / (system.mass[i] * g);
    if (!(over_weight <= largest.over_weight)) largest = {over_weight, int(i)};
    if (std::isnan(over_weight)) break;
  }
  return largest;
}

double rounding_over_weight(const System& system, const State& s) {
  const PerParticle rows = stiffness_row_bounds(system.forces, s, StickingPart::all);
  const double rounding = std::numeric_limits<double>::epsilon() * s.x.cwiseAbs().maxCoeff();
  return rounding * rows.cwiseProduct(system.inverse_mass).maxCoeff() / gravity_of(system);
}

double neutral_scale(const PerParticle3& x) {
  return standard_gravity / (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).norm();
}

std::string what_moves(const System& system, double t) {
  for (const KnownVelocity& known : velocities_at(system.prescribed, t))
    if (!known.velocity.isZero(0)) return "a prescribed particle";
  if (!event_times(system.prescribed, t).empty()) return "a prescribed particle";
  if (!object_event_times(system, t).empty()) return "an object";
  for (const Filter& filter : system.filters)
    if (const auto* collision = std::get_if<ObjectCollision>(&filter))
      for (const Object& object : collision->objects)
        if (const auto* rigid = std::get_if<RigidObject>(&object.body)) {
          const RigidOverSpan over = rigid->over({t, t, 1});
          if (!over.drift.isZero(0) || !over.spin.isZero(0)) return "object '" + object.name + "'";
        }
  return "";
}

Rest settle(const System& system, const State& start, const RestSearch& search) {
  if (const std::string moves = what_moves(system, start.time); !moves.empty())
    throw InputError(moves +
                     " moves; a rest needs what holds and touches the cloth to stand still");
  for (const Filter& filter : system.filters)
    if (std::holds_alternative<StrainLimiter>(filter))
      throw InputError(
          "strain limits are kept to a tolerance, by sweeps that end before forces balance; unset "
          "them to find the rest of the springs");
  return Search(system, start, search).rest();
}

}  // namespace foldproof
