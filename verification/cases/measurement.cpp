#include "verification/cases/measurement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reference/forces/bending.h"
#include "reference/scene/key_values.h"
#include "reference/scene/read_region.h"
#include "verification/cases/repetition.h"

namespace foldproof {

namespace {

constexpr double in_degrees = 180 / pi;  // a radian

std::vector<double> heights(const FrameView& frame, const std::vector<int>& of) {
  std::vector<double> all;
  for (const int i : of) all.push_back(up_in(frame.scene).dot(frame.state.x.col(i)));
  return all;
}

/// Weighted with the particles' masses, so that it means the same on a finer mesh.
Vector3 mean_position(const FrameView& frame, const std::vector<int>& of) {
  Vector3 sum = Vector3::Zero();
  double mass = 0;
  for (const int i : of) {
    sum += frame.system.mass[i] * frame.state.x.col(i);
    mass += frame.system.mass[i];
  }
  return sum / mass;
}

double mean_height(const FrameView& frame, const Measurement&, const std::vector<int>& of) {
  return up_in(frame.scene).dot(mean_position(frame, of));
}

double lowest(const FrameView& frame, const Measurement&, const std::vector<int>& of) {
  return std::ranges::min(heights(frame, of));
}

double highest(const FrameView& frame, const Measurement&, const std::vector<int>& of) {
  return std::ranges::max(heights(frame, of));
}

double position_along(const FrameView& frame, const Measurement& m, const std::vector<int>& of) {
  const Vector3 along = m.along.norm() > 0 ? Vector3(m.along.normalized()) : up_in(frame.scene);
  return along.dot(mean_position(frame, of));
}

double distance(const FrameView& frame, const Measurement&, const std::vector<int>& of) {
  return (frame.state.x.col(of[1]) - frame.state.x.col(of[0])).norm();
}

/// At the second of three particles.
double angle(const FrameView& frame, const Measurement&, const std::vector<int>& of) {
  const Vector3 a = frame.state.x.col(of[0]) - frame.state.x.col(of[1]);
  const Vector3 b = frame.state.x.col(of[2]) - frame.state.x.col(of[1]);
  return std::atan2(a.cross(b).norm(), a.dot(b)) * in_degrees;
}

/// Of a surface bent along lines, curvature k across them: the angles of its hinges times their
/// lengths sum up to k times its area, and |H| = k/2.
double mean_curvature(const FrameView& frame, const Measurement&, const std::vector<int>&) {
  const PerParticle3& x = frame.state.x;
  const TriangleMesh& mesh = frame.scene.mesh;
  const std::vector<double> angles = hinge_angles(mesh, x);
  double turned = 0, area = 0;  // m, m^2
  for (size_t h = 0; h < angles.size(); ++h) {
    const Hinge& hinge = mesh.hinges[h];
    turned += std::abs(angles[h]) * (x.col(hinge.particles[3]) - x.col(hinge.particles[2])).norm();
  }
  for (const Triangle& t : mesh.triangles)
    area +=
        0.5 * Vector3(x.col(t[1]) - x.col(t[0])).cross(Vector3(x.col(t[2]) - x.col(t[0]))).norm();
  return turned / (2 * area);
}

double fastest(const FrameView& frame, const Measurement&, const std::vector<int>& of) {
  Worst worst;
  for (const int i : of) worst.observe(frame.state.v.col(i).norm());
  return worst.value();
}

/// Root mean square of how far the particles are from where they started, by mass.
double displacement(const FrameView& frame, const Measurement&, const std::vector<int>& of) {
  double squares = 0, mass = 0;
  for (const int i : of) {
    squares += frame.system.mass[i] * (frame.state.x.col(i) - frame.scene.x.col(i)).squaredNorm();
    mass += frame.system.mass[i];
  }
  return std::sqrt(squares / mass);
}

double depth(const FrameView& frame, const Measurement&, const std::vector<int>&) {
  return frame.objects.empty()
             ? 0
             : value_at(*find_quantity("stays_outside"), frame.scene, frame.objects, frame.state);
}

const Measurable* find_measurable(std::string_view what) {
  for (const Measurable& row : measurable())
    if (what == row.what) return &row;
  return nullptr;
}

std::string known_measurements() {
  std::string known;
  for (const Measurable& row : measurable())
    known += (known.empty() ? "" : ", ") + std::string(row.what);
  return known + ", and the keys of [expect]";
}

ParticleRegion read_region(const KeyTable& keys, const Scene& scene) {
  if (keys.is_text("of")) {
    if (keys.text("of") != "all")
      throw InputError(
          keys.where("of") +
          ": 'of' must be \"all\", { particles = [...] } or { box = [[x, y, z], [x, y, z]] }");
    return {};
  }
  const auto of = keys.table("of");
  if (!of) return {};
  ParticleRegion region;
  if (of->has("box")) {
    select_in_box(*of, scene.x);  // refuses what is no box
    region.box = {of->vectors("box")[0], of->vectors("box")[1]};
  } else {
    region.particles = with_copies(numbered(*of, "particles", scene.x.cols()), scene.copy_of);
  }
  if (particles_in(region, scene).empty())
    throw InputError(keys.where("of") + ": 'of' names no particle of the cloth's start");
  return region;
}

void read_instant(const KeyTable& keys, const Scene& scene, Measurement& m) {
  if (!keys.has("when")) return;
  if (!keys.is_text("when")) {
    m.when = Instant::at_time;
    m.time = keys.number("when");
    if (!(m.time >= 0 && m.time <= scene.schedule.end))
      throw InputError(keys.where("when") + ": 'when' is a time outside the run [s]");
    return;
  }
  m.when = choice<Instant>(
      keys, "when",
      {{"end", Instant::end}, {"maximum", Instant::maximum}, {"minimum", Instant::minimum}});
}

void reject_key(const KeyTable& keys, const std::string& key, const std::string& why) {
  if (keys.has(key)) throw InputError(keys.where(key) + ": " + why);
}

/// A quantity of [expect], which takes nothing but its name.
void require_expected(const KeyTable& keys, const std::string& what, const Scene& scene) {
  const Quantity* quantity = find_quantity(what);
  if (!quantity)
    throw InputError(keys.where("what") + ": unknown quantity '" + what +
                     "'; known: " + known_measurements());
  if (what == "is_reproducible")
    throw InputError(
        keys.where("what") +
        ": 'is_reproducible' repeats steps, so it is not a number of one run; use [expect]");
  for (const char* key : {"of", "when"})
    reject_key(keys, key, "'" + what + "' is measured as [expect] does; leave out '" + key + "'");
  const std::string rejection = quantity->rejection ? quantity->rejection(scene) : "";
  if (!rejection.empty())
    throw InputError(keys.where("what") + ": '" + what + "' makes no sense here: " + rejection);
}

}  // namespace

std::vector<int> particles_in(const ParticleRegion& region, const Scene& scene) {
  if (!region.particles.empty()) return region.particles;
  std::vector<int> all;
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    const auto x = scene.x.col(i).array();
    if (!region.box ||
        ((x >= region.box->first.array()).all() && (x <= region.box->second.array()).all()))
      all.push_back(int(i));
  }
  return all;
}

const std::vector<Measurable>& measurable() {
  static const std::vector<Measurable> table = {
      {"height", "m", "mean height of the particles, by mass, against gravity", any_region,
       mean_height},
      {"lowest", "m", "height of the lowest particle", any_region, lowest},
      {"highest", "m", "height of the highest particle", any_region, highest},
      {"position", "m", "mean position along a direction, by mass", any_region, position_along},
      {"displacement", "m", "root mean square distance from the start, by mass", any_region,
       displacement},
      {"distance", "m", "between two particles", 2, distance},
      {"angle", "degrees", "at the second of three particles", 3, angle},
      {"mean_curvature", "1/m", "mean of |H| over the cloth", whole_cloth, mean_curvature},
      {"speed", "m/s", "of the fastest particle", any_region, fastest},
      {"kinetic_energy", "J", "of the cloth", whole_cloth,
       [](const FrameView& f, auto&, auto&) { return energies(f.system, f.state).kinetic; }},
      {"elastic_energy", "J", "of stretching and bending", whole_cloth,
       [](const FrameView& f, auto&, auto&) {
         const Energies e = energies(f.system, f.state);
         return e.stretch + e.bending;
       }},
      {"gravitational_energy", "J", "of the cloth", whole_cloth,
       [](const FrameView& f, auto&, auto&) { return energies(f.system, f.state).gravity; }},
      {"energy", "J", "kinetic, elastic and gravitational", whole_cloth,
       [](const FrameView& f, auto&, auto&) { return energies(f.system, f.state).total(); }},
      {"momentum", "kg m/s", "size of the linear momentum", whole_cloth,
       [](const FrameView& f, auto&, auto&) { return linear_momentum(f.system, f.state).norm(); }},
      {"angular_momentum", "kg m^2/s", "size, about the origin", whole_cloth,
       [](const FrameView& f, auto&, auto&) { return angular_momentum(f.system, f.state).norm(); }},
      {"contact_points", "1", "points that objects corrected in the step before", whole_cloth,
       [](const FrameView& f, auto&, auto&) { return double(f.contacts); }},
      {"depth", "m", "of the deepest free particle inside an object", whole_cloth, depth},
  };
  return table;
}

std::string unit_of(const Measurement& m) {
  if (const Measurable* row = find_measurable(m.what)) return row->unit;
  const Quantity* quantity = find_quantity(m.what);
  return quantity ? quantity->unit : "1";
}

Measurement read_measurement(const KeyTable& keys, const Scene& scene) {
  Measurement m{keys.text_or("name", ""), keys.text("what")};
  if (m.name.empty()) m.name = m.what;
  const Measurable* row = find_measurable(m.what);
  if (!row) {
    require_expected(keys, m.what, scene);
    return m;
  }
  if (row->particles == whole_cloth)
    reject_key(keys, "of", "'" + m.what + "' is measured on the whole cloth; leave out 'of'");
  else
    m.of = read_region(keys, scene);
  read_instant(keys, scene, m);
  if (row->particles > 0 && int(m.of.particles.size()) != row->particles)
    throw InputError(keys.where("what") +
                     fmt::format(": '{}' needs of = {{ particles = [...] }} with {} numbers",
                                 m.what, row->particles));
  if (m.what == "position" && keys.has("along")) {
    m.along = keys.vector("along");
    if (!(m.along.norm() > 0))
      throw InputError(keys.where("along") + ": 'along' is a direction and must not be zero");
  }
  return m;
}

std::vector<Measurement> read_measurements(const KeyTable& keys, const Scene& scene) {
  std::vector<Measurement> all;
  for (const auto& table : keys.tables("quantity")) {
    all.push_back(read_measurement(*table, scene));
    for (size_t k = 0; k + 1 < all.size(); ++k)
      if (all[k].name == all.back().name)
        throw InputError(table->where("what") + ": two quantities are called '" + all[k].name +
                         "'; give one of them another 'name'");
  }
  return all;
}

std::vector<Measurement> usual_measurements(const Scene& scene,
                                            const std::vector<std::string>& expected) {
  std::vector<Measurement> usual;
  for (const char* what : {"kinetic_energy", "elastic_energy"}) usual.push_back({what, what});
  if (scene.gravity)
    for (const char* what : {"height", "lowest"}) usual.push_back({what, what});
  for (const std::string& key : expected)
    if (key != "runs_to_its_end" && key != "is_reproducible" && key != "takes_steps" &&
        key != "solves_converge")
      usual.push_back({key, key});
  return usual;
}

Measurer::Measurer(const Scene& scene, const BuiltScene& built,
                   const std::vector<Measurement>& measurements)
    : scene_(scene),
      built_(built),
      measurements_(measurements),
      values_(measurements.size(), nan),
      nearest_(measurements.size(), std::numeric_limits<double>::infinity()),
      is_first_(measurements.size(), true) {
  for (const Measurement& m : measurements) particles_.push_back(particles_in(m.of, scene));
}

void Measurer::record(const Diagnostics& row) {
  summary_.record(row, scene_.schedule.end);
  contacts_ = row.work.object_contacts;
}

double Measurer::at_frame(size_t k, const State& frame) const {
  const Measurement& m = measurements_[k];
  if (const Measurable* row = find_measurable(m.what))
    return row->at({scene_, built_.system, built_.objects, frame, contacts_}, m, particles_[k]);
  const Quantity& quantity = *find_quantity(m.what);
  return quantity.of_run ? nan : value_at(quantity, scene_, built_.objects, frame);
}

void Measurer::record(const State& frame) {
  for (size_t k = 0; k < measurements_.size(); ++k) record(k, frame);
}

void Measurer::record(size_t k, const State& frame) {
  const Measurement& m = measurements_[k];
  // quantities of [expect]: the largest over all frames
  const Instant when = find_measurable(m.what) ? m.when : Instant::maximum;
  const double interval = scene_.schedule.frame_interval, close = 1e-9 * interval;
  if (when == Instant::at_time || when == Instant::end) {
    const double off = std::abs(frame.time - (when == Instant::end ? scene_.schedule.end : m.time));
    const double most = close + (when == Instant::end ? 0 : interval / 2);
    if (!(off <= most) || !(off < nearest_[k] - close)) return;  // of two as near, the earlier
    nearest_[k] = off;
    values_[k] = at_frame(k, frame);
    return;
  }
  const double value = at_frame(k, frame), before = values_[k];
  if (is_first_[k] || std::isnan(value))
    values_[k] = value;
  else if (!std::isnan(before))  // a NaN of an earlier frame stays
    values_[k] = when == Instant::minimum ? std::min(before, value) : std::max(before, value);
  is_first_[k] = false;
}

std::vector<double> Measurer::values(const RunResult& result) const {
  std::vector<double> all = values_;
  const Repetition never_asked(scene_, computing_provider());
  for (size_t k = 0; k < measurements_.size(); ++k) {
    const Quantity* quantity =
        find_measurable(measurements_[k].what) ? nullptr : find_quantity(measurements_[k].what);
    if (quantity && quantity->of_run)
      all[k] = quantity->of_run({scene_, summary_, result, never_asked, built_.objects});
  }
  return all;
}

}  // namespace foldproof
