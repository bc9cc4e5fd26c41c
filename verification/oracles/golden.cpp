#include "verification/oracles/golden.h"

#include <array>
#include <cmath>
#include <random>

#include "reference/types.h"
#include "verification/oracles/definitions.h"
#include "verification/oracles/depth_maps.h"
#include "verification/oracles/exact_solutions.h"
#include "verification/oracles/forecast.h"
#include "verification/oracles/sticking.h"

namespace foldproof {

namespace {

/// Random numbers that do not depend on the standard library's distributions.
class Draw {
 public:
  explicit Draw(unsigned seed) : engine_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * double(engine_() >> 11) * 0x1p-53;
  }
  Vector3 vector(double size) {
    const double x = between(-size, size), y = between(-size, size), z = between(-size, size);
    return {x, y, z};
  }
  Vector3 direction() {
    for (;;) {
      const Vector3 v = vector(1);
      if (v.norm() > 0.1 && v.norm() < 1) return v.normalized();
    }
  }

 private:
  std::mt19937_64 engine_;
};

/// A row in progress: each value with the name of its column.
class RowMaker {
 public:
  explicit RowMaker(GoldenTable& table) : table_(table), is_first_(table.rows.empty()) {
    table.rows.emplace_back();
  }

  void input(const std::string& name, const std::string& unit, double value) {
    put(name, unit, true, value);
  }
  void output(const std::string& name, const std::string& unit, double value) {
    put(name, unit, false, value);
  }
  void input(const std::string& name, const std::string& unit, const Vector3& v) {
    put(name, unit, true, v);
  }
  void output(const std::string& name, const std::string& unit, const Vector3& v) {
    put(name, unit, false, v);
  }

 private:
  void put(const std::string& name, const std::string& unit, bool is_input, double value) {
    if (is_first_) table_.columns.push_back({name, unit, is_input});
    table_.rows.back().push_back(value);
  }
  void put(const std::string& name, const std::string& unit, bool is_input, const Vector3& v) {
    for (int k = 0; k < 3; ++k) put(name + "_" + "xyz"[k], unit, is_input, v[k]);
  }

  GoldenTable& table_;
  bool is_first_;
};

using Corners = std::array<Vector3, 4>;

void put_corners(RowMaker& row, const std::string& name, const std::string& unit, bool is_input,
                 const Corners& x) {
  for (size_t k = 0; k < 4; ++k) {
    const std::string numbered = name + std::to_string(k + 1);
    is_input ? row.input(numbered, unit, x[k]) : row.output(numbered, unit, x[k]);
  }
}

/// A hinge with edges of a few centimetres: x1 and x2 on either side of the edge from x3 to x4,
/// folded by any angle.
Corners hinge_corners(Draw& draw) {
  const double angle = draw.between(-2.9, 2.9), length = draw.between(0.01, 0.05);
  const double width1 = draw.between(0.005, 0.05), foot1 = draw.between(-0.01, 0.06);
  const double width2 = draw.between(0.005, 0.05), foot2 = draw.between(-0.01, 0.06);
  const Vector3 along(0, length, 0), out(width1, foot1, 0);
  const Vector3 other(-width2 * std::cos(angle), foot2, width2 * std::sin(angle));
  const Vector3 place = draw.vector(0.3), noise = draw.vector(0.001);
  return {place + out + noise, place + other, place, place + along};
}

void bending_row(Draw& draw, RowMaker& row) {
  oracles::HingeInput hinge;
  hinge.x = hinge_corners(draw);
  for (Vector3& v : hinge.v) v = draw.vector(1);
  hinge.rest = hinge_corners(draw);
  hinge.ke = std::pow(10, draw.between(-6, -1));
  hinge.kd = hinge.ke * draw.between(0.001, 0.1);
  hinge.theta0 = draw.between(-3, 3);
  put_corners(row, "x", "m", true, hinge.x);
  put_corners(row, "v", "m/s", true, hinge.v);
  row.input("ke", "J", hinge.ke);
  row.input("kd", "N s", hinge.kd);
  row.input("theta0", "rad", hinge.theta0);
  put_corners(row, "rest", "m", true, hinge.rest);
  row.output("theta", "rad", oracles::hinge_angle_50(hinge.x).value);
  put_corners(row, "u", "1/m", false, oracles::bending_mode_50(hinge.x).value);
  put_corners(row, "elastic_rest_weighted", "N", false, oracles::bending_elastic_50(hinge).value);
  hinge.elastic_geometry = oracles::Geometry::current;
  put_corners(row, "elastic_current_weighted", "N", false,
              oracles::bending_elastic_50(hinge).value);
  put_corners(row, "damping", "N", false, oracles::bending_damping_50(hinge).value);
  row.output("energy_rest_weighted", "J", oracles::bending_energy_50(hinge).value);
}

void spring_row(Draw& draw, RowMaker& row) {
  oracles::SpringInput spring;
  for (Vector3& x : spring.x) x = draw.vector(0.05);
  for (Vector3& v : spring.v) v = draw.vector(1);
  spring.law = {draw.between(1, 1000), draw.between(0.001, 1), draw.between(1e-5, 1e-3),
                draw.between(0.01, 0.1)};
  row.input("xa", "m", spring.x[0]);
  row.input("xb", "m", spring.x[1]);
  row.input("va", "m/s", spring.v[0]);
  row.input("vb", "m/s", spring.v[1]);
  row.input("Y", "N/m", spring.law.young);
  row.input("kd", "N s/m", spring.law.damping);
  row.input("A", "m^2", spring.law.area);
  row.input("L0", "m", spring.law.rest_length);
  row.output("elastic_a", "N", oracles::spring_elastic_50(spring).value[0]);
  row.output("damping_a", "N", oracles::spring_damping_50(spring).value[0]);
  row.output("energy", "J", oracles::spring_energy_50(spring).value);
}

void integrator_row(Draw& draw, RowMaker& row) {
  using oracles::Scheme;
  oracles::Oscillator oscillator;
  const double omega = std::pow(10, draw.between(-1, 3)), zeta = std::pow(10, draw.between(-3, 2));
  oscillator.stiffness = omega * omega;
  oscillator.damping = 2 * zeta * omega;
  oscillator.x0 = draw.between(-1, 1);
  oscillator.v0 = omega * draw.between(-1, 1);
  const double h = draw.between(0.01, 1.9) / omega;
  row.input("k", "1/s^2", oscillator.stiffness);
  row.input("c", "1/s", oscillator.damping);
  row.input("x", "m", oscillator.x0);
  row.input("v", "m/s", oscillator.v0);
  row.input("h", "s", h);
  const std::array<std::pair<const char*, Scheme>, 3> schemes{
      {{"A", Scheme::mixed}, {"B", Scheme::central_newmark}, {"C", Scheme::variable_step_newmark}}};
  for (const auto& [name, scheme] : schemes) {
    const oracles::OscillatorEstimate after = oracles::stepped_oscillator(scheme, oscillator, h);
    row.output(std::string("x_") + name, "m", after.x.value);
    row.output(std::string("v_") + name, "m/s", after.v.value);
  }
  const oracles::OscillatorEstimate truth = oracles::oscillator_at(oscillator, h);
  row.output("x_exact", "m", truth.x.value);
  row.output("v_exact", "m/s", truth.v.value);
}

/// A particle that enters the object or stays outside, about equally often.
void contact_row(Draw& draw, RowMaker& row, bool has_friction) {
  oracles::ForecastInput at;
  at.phi = draw.between(-0.01, 0.02);
  at.normal = draw.direction();
  at.v_object = draw.vector(1);
  at.v = draw.vector(2);
  at.tau = draw.between(0.001, 0.02);
  at.friction = has_friction ? draw.between(0, 1.5) : 0;
  row.input("phi", "m", at.phi);
  row.input("N", "1", at.normal);
  row.input("v_object", "m/s", at.v_object);
  row.input("v", "m/s", at.v);
  row.input("tau", "s", at.tau);
  if (has_friction) row.input("mu", "1", at.friction);
  const oracles::ForecastAnswer answer = oracles::forecast_answer(at);
  row.output("phi_new", "m", answer.phi_new);
  row.output("v_new", "m/s", answer.v);
}

void forecast_row(Draw& draw, RowMaker& row) { contact_row(draw, row, false); }
void friction_row(Draw& draw, RowMaker& row) { contact_row(draw, row, true); }

void projection_row(Draw& draw, RowMaker& row) {
  oracles::Band band{};
  band.reach = draw.between(0.002, 0.02);
  band.nearest = band.reach * draw.between(0.01, 0.5);
  band.deepest = band.reach * draw.between(0.5, 6);
  const double phi = draw.between(-band.deepest, band.reach);
  row.input("eps", "m", band.nearest);
  row.input("tau", "m", band.reach);
  row.input("deepest", "m", band.deepest);
  row.input("phi", "m", phi);
  row.output("phi_plain", "m", std::max(phi, band.nearest));
  row.output("phi_power", "m", oracles::power_map(band, phi).value);
  row.output("phi_blend", "m", oracles::blend_map(band, phi).value);
}

void sticking_row(Draw& draw, RowMaker& row) {
  oracles::StuckParticle stuck;
  const Vector3 a = draw.vector(0.3), ab = draw.vector(0.03), ac = draw.vector(0.03);
  const double weight_b = draw.between(0, 0.5), weight_c = draw.between(0, 0.5),
               height = draw.between(0, 0.01);
  stuck.corners = {{a, a + ab, a + ac}};
  stuck.places = {{weight_b, weight_c, height}};
  stuck.stiffness = draw.between(1, 1000);
  stuck.far = draw.between(0.01, 0.05);
  // within the distance at which bonds break
  const Vector3 aside = draw.direction();
  const double distance = stuck.far * draw.between(0.01, 0.95);
  stuck.x =
      a + weight_b * ab + weight_c * ac + height * ab.cross(ac).normalized() + distance * aside;
  const oracles::StickingAnswer answer = oracles::sticking_answer(stuck);
  row.input("x", "m", stuck.x);
  row.input("a", "m", stuck.corners[0][0]);
  row.input("b", "m", stuck.corners[0][1]);
  row.input("c", "m", stuck.corners[0][2]);
  row.input("weight_b", "1", stuck.places[0][0]);
  row.input("weight_c", "1", stuck.places[0][1]);
  row.input("height", "m", stuck.places[0][2]);
  row.input("k0", "N/m", stuck.stiffness);
  row.input("far", "m", stuck.far);
  row.output("target", "m", answer.target);
  row.output("k", "N/m", answer.stiffness);
  row.output("energy", "J", answer.energy);
  row.output("force", "N", Vector3(answer.force.head<3>()));
  row.output("force_a", "N", Vector3(answer.force.segment<3>(3)));
  row.output("force_b", "N", Vector3(answer.force.segment<3>(6)));
  row.output("force_c", "N", Vector3(answer.force.segment<3>(9)));
}

struct Maker {
  const char *name, *about;
  void (*add_row)(Draw&, RowMaker&);
};

constexpr std::array<Maker, 7> makers{{
    {"bending",
     "Forces of a hinge, BMF03 section 4: ke |E|^2/(|N1| + |N2|) (sin(theta/2) - sin(theta0/2)) u, "
     "the factor at rest or now; -kd |E| (u.v) u; the energy of the rest-weighted force. Corners "
     "x1, x2 opposite, x3 to x4 the edge.",
     bending_row},
    {"springs",
     "Force of a spring on its end a, BMF03 section 3: Y A/L0 (|d|/L0 - 1) d^, kd A/L0^2 ((vb - "
     "va).d^) d^, d = xb - xa, and Y A/2 (|d|/L0 - 1)^2. A: rest area of the edge's triangles.",
     spring_row},
    {"integrator",
     "One step h of schemes A, B, C of BMF03 section 3 on x'' = -k x - c v (elastic part explicit, "
     "damping implicit), and the exact motion.",
     integrator_row},
    {"forecast",
     "Interface forecasting without friction, BMF03 section 5.2: phi_new = phi + tau (v - "
     "v_object).N; if it is negative, v_new = v - (phi_new/tau) N. N counts as it stands.",
     forecast_row},
    {"friction",
     "The same with Coulomb friction: the tangential relative velocity is multiplied by max(0, 1 - "
     "mu (-phi_new/tau)/|v_T|).",
     friction_row},
    {"projection",
     "Maps of signed distance of the fold-preserving projection, BMF03 section 5.3: max(phi, eps); "
     "eps + (tau - eps) ((phi + deepest)/(tau + deepest))^((tau + deepest)/(tau - eps)); and "
     "linear up to w = (tau - eps)/2 before tau, its slope rising evenly to 1 from there.",
     projection_row},
    {"sticking",
     "A particle bound to a triangle, BMF03 section 6: target = a + weight_b (b - a) + weight_c (c "
     "- a) + height n, k = k0 (1 - d^2/far^2)^2, and minus the gradient of k0 (d^2/2 - d^4/(2 "
     "far^2) + d^6/(6 far^4)) by x, a, b, c.",
     sticking_row},
}};

}  // namespace

std::vector<std::string> golden_names() {
  std::vector<std::string> names;
  for (const Maker& maker : makers) names.push_back(maker.name);
  return names;
}

GoldenTable golden_values(const std::string& name, int count, unsigned seed) {
  if (count < 1) throw InputError("golden values: count must be at least 1");
  for (const Maker& maker : makers) {
    if (name != maker.name) continue;
    GoldenTable table{maker.name, maker.about, {}, {}};
    Draw draw(seed);
    for (int k = 0; k < count; ++k) {
      RowMaker row(table);
      maker.add_row(draw, row);
    }
    return table;
  }
  std::string known;
  for (const std::string& one : golden_names()) known += (known.empty() ? "" : ", ") + one;
  throw InputError("there are no golden values of '" + name + "'; known: " + known);
}

}  // namespace foldproof
