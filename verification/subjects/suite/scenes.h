// The plain scenes of the portable suite, what several laws measure in them, and the error that
// rounding may make.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "verification/subjects/suite/trial.h"

namespace foldproof::suite {

constexpr double weight = 9.81;  // of the earth [m/s^2]

/// A number in this interval: the same for the same words and the same seed (`--seed`; official
/// results use 0), so that no solver can be tuned to a scene's values.
double drawn(std::string_view what, double least, double most);

/// In its rest shape, at rest and free, with the masses of its density.
PortableScene resting(std::string name, TriangleMesh mesh, const PortableMaterial& material = {});

/// Its rest shape and its start moved by a vector [m].
PortableScene shifted(PortableScene scene, const Vector3& by);

/// Sheets in one scene that share no particle; what is no particle's or triangle's is the first's.
PortableScene together(std::string name, const std::vector<PortableScene>& sheets);

/// A flat jittered sheet of n x n cells of 0.1 m, 0.2 kg/m^2, Y = 5 N/m, in its rest shape, free.
PortableScene sheet_of_cells(int n);

/// A flat jittered sheet of 0.6 m x 0.52 m, 0.2 kg/m^2, Y = 5 N/m, in its rest shape, free.
PortableScene sheet_at_rest();

/// Sheets in their rest shape of every pattern, and one whose rest shape is curved.
std::vector<PortableScene> sheets_at_rest();

/// Of 4 x 4 cells at rest, without gravity, of Y = 1e-4 N/m: omega is 1.5/s at most.
PortableScene soft_sheet(std::string name);

/// Throws std::logic_error unless (omega t)^2 of the motion is below 0.01.
void require_softness(const PortableScene& scene, long steps);

/// The same as sheet_at_rest, of 2 x 2 cells.
PortableScene small_sheet();

/// It falls from rest.
PortableScene falling_sheet();

/// It drifts without any force.
PortableScene drifting_sheet();

/// Stretched by 4 % and 6 %, curved, with a smooth velocity that spins and shears it: under tension
/// for longer than the 0.04 s that the laws ask.
PortableScene moving_sheet();

/// The moving sheet with dampers along its edges, a third of critical damping for the highest
/// frequency, and steps of half the explicit limit.
PortableScene damped_moving_sheet();

/// The moving sheet, its masses multiplied by factors between 0.6 and 1.7.
PortableScene moving_sheet_of_unequal_masses();

/// Two corners held, under gravity.
PortableScene hanging_sheet();

/// How gravity is tilted against a plane: from its normal, and where to [rad].
struct Tilt {
  double slope, heading;
};

/// A sheet at rest that lies on a plane. The plane is oblique to every axis and the origin is off
/// it, so that its point and its normal matter. Gravity is tilted against it.
PortableScene sheet_on_a_plane(const Tilt& tilt, double friction);

/// Positions as seen from that plane: along it, where headings count from the first axis towards
/// the second, and above it [m].
PerParticle3 seen_from_the_plane(const PerParticle3& x);

/// The parts of a text between separators; none of an empty one.
std::vector<std::string> split(std::string_view text, std::string_view separator);

/// A table without rows, of columns "name [unit] | ...": numbers, or texts where there is no unit.
Table table_of(std::string_view columns);

/// The largest length of the vectors; of positions, their extent or distance from the origin [m].
double largest(const PerParticle3& vectors);

/// Halfway between the least and the largest coordinates [m].
Vector3 middle_of(const PerParticle3& x);

/// stride, 2 stride, ..., count stride
std::vector<long> multiples(long stride, long count);

/// Velocities with which the scene's masses have the momenta that the solver's mass matrix gives
/// each particle [m/s]: v, or M v over the masses. A consistent M, of linear triangles of the
/// scene's density, has density area/12 for each triangle of i and j, twice that for i = j.
PerParticle3 momentum_velocities(const PortableScene& scene, const PerParticle3& v,
                                 const Declaration& declared);

/// The least number of parts of a step [s] that are not longer than the longest internal step that
/// the solver declares: from there on, halving the step changes something.
long parts_of_step(double dt, const Declaration& declared);

double kinetic_energy(const PortableScene& scene, const PerParticle3& v);  // J

/// The kinetic energy beyond what gravity has done since the positions `from` [J].
double gained_energy(const PortableScene& scene, const PerParticle3& from, const Snapshot& now);

/// About the origin [N m].
Vector3 torque_of(const PerParticle3& x, const PerParticle3& f);

Vector3 momentum_of(const PortableScene& scene, const PerParticle3& v);  // kg m/s

/// About the middle of its start [N m s].
Vector3 spin_of(const PortableScene& scene, const Snapshot& now);

using Interval = std::array<double, 2>;

/// The interval, halved until it is no wider than that: `is_beyond` begins to be true in it.
Interval bisected(Interval tried, double width, const std::function<bool(double)>& is_beyond);

double middle(const Interval& interval);

/// What a bisection found: "0.235", or ">= 0.299" if it ended where it began.
std::string found_text(const Interval& found, const Interval& tried);

/// Throws NotOffered unless the sheet, before any contact, has moved at least half as far as
/// its start's velocities would carry it (a mean weighted by momentum). A sheet that stands
/// still meets nothing.
void require_start_velocity(const PortableScene& scene, const PerParticle3& x, long steps);

/// (time of the motion)^2 times a bound on the squared elastic frequencies [1]: twice the stiffness
/// of all springs at a particle, over its mass.
double squared_phase(const PortableScene& scene, long steps);

/// Bound on the position error of rounding after the steps, over the largest position [1]: each
/// step rounds position and velocity by a few roundings, and elastic forces, of a few more, enlarge
/// this by the squared phase at most. Solvers of linear systems may add their tolerance a step.
double rounding_error(const PortableScene& scene, long steps, const Declaration& declared);

/// The bound, a share of what the law is about, which an answer of 0 misses by 1. Throws CannotTell
/// if the declaration makes it `widest_bound` or more.
constexpr double widest_bound = 0.2;
double narrow(double bound, const Declaration& declared);

/// The rounding error, if it is narrow.
double narrow_rounding(Trial& trial, const PortableScene& scene, long steps);

}  // namespace foldproof::suite
