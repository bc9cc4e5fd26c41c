#include "convergence/validation/strip_ladder.h"

#include <algorithm>
#include <cmath>

#include "convergence/ranges.h"
#include "convergence/bending/row_strip.h"

namespace foldproof {

namespace {

// strain under the largest load that the springs are made for [1]
constexpr double stretch_share = 1e-8;

/// The force that a clamp may have to bear, for strips without weight, too [B/L^2].
constexpr double clamp_force = 50;

RowStrip row_strip(const Subject& subject, const StripTest& test, int panels) {
  const double unit = strip_D / std::pow(strip_length, 2);  // of forces [N/m]
  const double gravity = test.strip.gamma * unit / (strip_density * strip_length);
  const double largest = (test.strip.gamma + clamp_force) * unit;
  StripHold hold{test.strip.first_slope, {}};
  if (test.strip.last)
    hold.last = {
        test.strip.last->slope,
        strip_length * Eigen::Vector2d(test.strip.last->across, test.strip.last->up),
        test.strip.last->hold == oracles::EndHold::clamped ? RowHold::clamped : RowHold::pinned};
  return {subject, strip_patterns()[0], panels, {gravity, 0, largest / stretch_share}, hold};
}

/// Arc lengths over L of the middles of the panels, the held first one included, and of the
/// rows from row 1 on.
struct Stations {
  std::vector<double> middles, rows;

  explicit Stations(const RowStrip& strip) {
    const double h = strip.spacing() / strip_length;
    for (int k = 0; k <= strip.panels(); ++k) middles.push_back(std::min(k * h, 1.0));
    for (int k = 0; k <= strip.panels(); ++k) rows.push_back((k + 0.5) * h);
  }
};

StripAtRest rest_of(const RowStrip& strip, const oracles::HeavyStrip& elastica,
                    const Stations& stations) {
  StripAtRest start = level(strip);
  const oracles::StripShape shape = oracles::strip_by_collocation(elastica, stations.middles);
  for (Eigen::Index k = 0; k < start.slopes.size(); ++k)
    start.slopes[k] = shape.points[std::size_t(k) + 1].slope;
  return at_rest(strip, start);
}

/// Rows from row 1 on, from the middle of the first panel, over L.
std::vector<oracles::StripPoint> rows_over_length(const RowStrip& strip, const StripAtRest& rest) {
  const Eigen::Matrix2Xd rows = strip.rows(rest.slopes, rest.lengths);
  std::vector<oracles::StripPoint> points;
  for (Eigen::Index i = 1; i < rows.cols(); ++i) {
    const Eigen::Vector2d place = (rows.col(i) - rows.col(1) / 2) / strip_length;
    points.push_back({i > 1 ? rest.slopes[i - 2] : strip.hold().slope, place.x(), place.y()});
  }
  return points;
}

/// Where a polyline through rows is at an arc length over L.
oracles::StripPoint point_at(const std::vector<oracles::StripPoint>& points,
                             const Stations& stations, double s) {
  const auto after = std::lower_bound(stations.rows.begin(), stations.rows.end(), s - 1e-12);
  const std::size_t i =
      std::clamp<std::size_t>(std::size_t(after - stations.rows.begin()), 1, points.size() - 1);
  const double part = (s - stations.rows[i - 1]) / (stations.rows[i] - stations.rows[i - 1]);
  const auto between = [&](double a, double b) { return a + part * (b - a); };
  return {points[i].slope, between(points[i - 1].across, points[i].across),
          between(points[i - 1].up, points[i].up)};
}

double largest_distance(const std::vector<oracles::StripPoint>& one,
                        const std::vector<oracles::StripPoint>& two) {
  Worst worst;
  for (std::size_t i = 0; i < one.size(); ++i)
    worst.observe(std::hypot(one[i].across - two[i].across, one[i].up - two[i].up));
  return worst.value();
}

}  // namespace

Ladder ladder_of(const StripLadder& levels, const char* column) {
  Ladder ladder;
  ladder.values = levels.levels.numbers(column);
  ladder.floor = levels.floor;
  return ladder;
}

Finding shape_verdict(const StripLadder& levels, double bound, std::string why, std::string note) {
  return {{levels.levels.numbers(distance_column).back(), bound, levels.floor, "1", std::move(why)},
          levels.levels,
          std::move(note)};
}

void show(const StripLadder& levels, std::size_t rows, const std::array<std::string, 2>& labels,
          Figure& figure) {
  Curve elastica{labels[0]}, simulated{labels[1]};
  for (const oracles::StripPoint& point : levels.elastica.points)
    elastica.point(point.across, point.up);
  for (std::size_t i = 0; i < rows; i += 4)
    simulated.point(levels.points[i].across, levels.points[i].up);
  figure.curves.insert(figure.curves.end(), {elastica, simulated});
}

double highest_row(const std::vector<oracles::StripPoint>& points) {
  std::size_t top = 1;
  for (std::size_t i = 1; i + 1 < points.size(); ++i)
    if (points[i].up > points[top].up) top = i;
  const double before = points[top - 1].up, after = points[top + 1].up;
  const double bend = before - 2 * points[top].up + after;
  return points[top].up - std::pow((after - before) / 2, 2) / (2 * bend);
}

StripOnMesh strip_on_mesh(const Subject& subject, const StripTest& test, int panels) {
  const RowStrip strip = row_strip(subject, test, panels);
  StripOnMesh mesh;
  mesh.rest = rest_of(strip, test.strip, Stations(strip));
  mesh.points = rows_over_length(strip, mesh.rest);
  mesh.spacing = strip.spacing() / strip_length;
  mesh.unit_of_force = strip_D / std::pow(strip_length, 2) * strip.width();
  mesh.force_on_row_1 =
      strip.forces(strip.rows(mesh.rest.slopes, mesh.rest.lengths))(1, 1) / mesh.unit_of_force;
  return mesh;
}

StripLadder strip_ladder(const Subject& subject, const StripTest& test,
                         const std::vector<int>& panels) {
  StripLadder ladder;
  ladder.elastica = oracles::strip_by_collocation(test.strip, linear_range(0, 1, 201));
  const oracles::StripPoint should =
      ladder.elastica.points[std::size_t(std::lround(200 * test.measured_at))];
  ladder.height = {should.up, ladder.elastica.uncertainty};
  ladder.reach = {should.across, ladder.elastica.uncertainty};

  const auto run = [&](int count) {
    const RowStrip strip = row_strip(subject, test, count);
    const Stations stations(strip);
    const StripAtRest rest = rest_of(strip, test.strip, stations);
    ladder.points = rows_over_length(strip, rest);
    std::vector<double> inside = stations.rows;  // a held last panel ends behind the clamp
    if (test.strip.last && test.strip.last->hold == oracles::EndHold::clamped) inside.pop_back();
    inside.back() = std::min(inside.back(), 1.0);
    const oracles::StripShape elastica = oracles::strip_by_collocation(test.strip, inside);
    update_worst(ladder.floor, rest.strain + rest.last_step + elastica.uncertainty);
    const oracles::StripPoint measured = point_at(ladder.points, stations, test.measured_at);
    return std::tuple{strip.spacing() / strip_length, measured.up, measured.across,
                      largest_distance(elastica.points, ladder.points)};
  };
  ladder.levels = refine({{"spacing of the rows over L", "1"},
                          {height_column, "1"},
                          {reach_column, "1"},
                          {distance_column, "1"}},
                         panels, run);
  return ladder;
}

}  // namespace foldproof
