// Points moved out of objects: final positions, and points that must not move.
#include <numeric>

#include "verification/specimens/check.h"
#include "verification/specimens/differences.h"
#include "verification/specimens/projection_specimens.h"

namespace foldproof {

namespace {

const std::string tolerance_reason =
    "points arrive within the tolerance of 1e-12 m; the same again for roundings of distances "
    "below a metre, a few 1e-16 each";
constexpr double tolerance = 1e-12, twice = 2e-12;  // m

std::string with(const ProjectionCase& specimen, const DepthMap& map) {
  return specimen.name + ", " + std::string(map.name);
}

std::vector<ProjectionCase> unpinched_cases() {
  std::vector<ProjectionCase> cases = solids_with_points();
  cases.push_back(two_balls());
  return cases;
}

/// A case projected by a map.
struct Projected {
  const ProjectionCase& specimen;
  const DepthMap& map;
  FoldProjection projection;
  ProjectedCloth cloth;

  PerParticle before() const { return distances(specimen, specimen.x); }
  PerParticle after() const { return distances(specimen, cloth.x); }
};

/// A row for each unpinched case and each map.
Table over_maps(const Column& column, const std::function<double(const Projected&)>& measure,
                double eps = projection_by("plain").band.nearest) {
  Table measured{{"case", ""}, column};
  for (const ProjectionCase& specimen : unpinched_cases())
    for (const DepthMap& map : depth_maps()) {
      FoldProjection projection = projection_by(std::string(map.name));
      projection.band.nearest = eps;
      const ProjectedCloth cloth = project_specimen(specimen, projection);
      measured.row(with(specimen, map), measure({specimen, map, projection, cloth}));
    }
  return measured;
}

Finding lands_where_the_map_says() {
  const auto largest_miss = [](const Projected& of) {
    const PerParticle before = of.before(), after = of.after();
    Worst worst;
    for (Eigen::Index i = 0; i < before.size(); ++i)
      worst.observe(std::abs(after[i] - of.map.at(of.projection.band, before[i])));
    return worst.value();
  };
  return judge_worst(over_maps({"largest miss", "m"}, largest_miss), twice, tolerance_reason);
}

/// Largest distance outside [eps, tau] among the points that started below tau [m].
double outside_band(const PerParticle& before, const PerParticle& after, const DepthBand& band) {
  Worst worst;
  for (Eigen::Index i = 0; i < before.size(); ++i)
    if (before[i] <= band.reach)
      worst.observe(std::max(band.nearest - after[i], after[i] - band.reach));
  return worst.value();
}

Finding ends_in_the_band() {
  const auto outside = [](const Projected& of) {
    return outside_band(of.before(), of.after(), of.projection.band);
  };
  return judge_worst(over_maps({"distance outside [eps, tau]", "m"}, outside), twice,
                     tolerance_reason);
}

Finding no_point_is_left_inside() {
  const auto inside = [](const Projected& of) { return double((of.after().array() < 0).count()); };
  return judge_worst(over_maps({"points inside", "1"}, inside, 0), 0,
                     "with eps = 0 too: arrived points lie on the outer side of f, so that not "
                     "even a rounding leaves one inside");
}

/// Expected outcome for a point that was at phi and is now at `after` [m].
ProjectionOutcome expected_fate(const DepthMap& map, const FoldProjection& projection, double phi,
                                double after) {
  const double f = map.at(projection.band, phi);
  if (!(f > phi)) return ProjectionOutcome::untouched;
  return f <= after && after <= f + projection.tolerance ? ProjectionOutcome::moved
                                                         : ProjectionOutcome::unfinished;
}

Finding senseless_ones_are_rejected() {
  Table measured{{"case", ""}, {"projections that mean nothing and are not refused", "1"}};
  const ProjectionCase specimen = two_balls();
  const auto observe = [&](const std::string& name,
                           const std::function<void(FoldProjection&)>& spoil) {
    FoldProjection projection = projection_by("plain");
    spoil(projection);
    measured.row(
        name, rejection_message([&] { project_specimen(specimen, projection); }).empty() ? 1 : 0);
  };
  for (const double wrong : {0.0, -1e-9, double(NAN), double(INFINITY)})
    observe("tolerance " + std::to_string(wrong), [&](FoldProjection& p) { p.tolerance = wrong; });
  for (const int wrong : {0, -3})
    observe(std::to_string(wrong) + " moves", [&](FoldProjection& p) { p.max_moves = wrong; });
  observe("tau below eps", [](FoldProjection& p) { p.band.reach = 0.5 * p.band.nearest; });
  observe("tau NaN", [](FoldProjection& p) { p.band.reach = NAN; });
  observe("no such map", [](FoldProjection& p) { p.map = "flat"; });
  return judge_worst(measured, 0, "a tolerance and a cap above 0, a band and a map are needed");
}

Finding one_move_is_enough() {
  Table measured{{"case", ""}, {"points that do not arrive", "1"}};
  const ProjectionCase specimen = two_balls();
  for (const DepthMap& map : depth_maps()) {
    FoldProjection projection = projection_by(std::string(map.name));
    projection.max_moves = 1;
    projection.tolerance = 1e-9;
    const ProjectedCloth cloth = project_specimen(specimen, projection);
    measured.row(with(specimen, map), cloth.count(ProjectionOutcome::unfinished));
    measured.row(with(specimen, map) + ", questions",
                 std::abs(double(cloth.object_queries - cloth.x.cols() -
                                 cloth.count(ProjectionOutcome::moved))));
  }
  return judge_worst(
      measured, 0,
      "along the normal of an exact distance the first move arrives, and it is allowed");
}

Finding fates_are_true() {
  const auto wrong_outcomes = [](const Projected& of) {
    double wrong = of.cloth.count(ProjectionOutcome::unfinished);
    for (Eigen::Index i = 0; i < of.cloth.before.size(); ++i)
      wrong += of.cloth.outcomes[size_t(i)] !=
               expected_fate(of.map, of.projection, of.cloth.before[i], of.cloth.after[i]);
    return wrong;
  };
  return judge_worst(
      over_maps(
          {"points with another outcome than their distances imply, or not moved to the end", "1"},
          wrong_outcomes),
      0, "where there is room every point is moved to the end, and its reported outcome is true");
}

/// Pairs of neighbours in depth whose order is reversed by more than the tolerance.
double disorder(const PerParticle& before, const PerParticle& after) {
  std::vector<Eigen::Index> order(size_t(before.size()));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return before[a] < before[b]; });
  double wrong = 0;
  for (size_t k = 1; k < order.size(); ++k)
    wrong += !(after[order[k]] >= after[order[k - 1]] - tolerance);
  return wrong;
}

Finding order_of_depths_is_kept() {
  const auto out_of_order = [](const Projected& of) { return disorder(of.before(), of.after()); };
  return judge_worst(over_maps({"neighbours in depth out of order", "1"}, out_of_order), 0,
                     "the deeper of two points stays the deeper, or comes to lie as far out, "
                     "within the tolerance of 1e-12 m");
}

Finding moves_along_the_normal() {
  Table measured{{"case", ""}, {"distance off the exact place", "m"}};
  for (const ProjectionCase& specimen : solids_with_points()) {
    if (specimen.name != "sphere" && specimen.name != "half space") continue;
    const RigidObject& body = std::get<RigidObject>(specimen.objects[0].body);
    const Pose pose = after(pose_at(body.motion, specimen.time), body.place);
    const ProjectedCloth cloth = project_specimen(specimen, projection_by("blend"));
    Worst worst;
    for (Eigen::Index i = 0; i < cloth.x.cols(); ++i) {
      const Vector3 p = to_body(pose, specimen.x.col(i)), q = to_body(pose, cloth.x.col(i));
      const bool is_ball = specimen.name == "sphere";
      const double phi = is_ball ? p.norm() - 0.41 : p.z();
      const double move = depth_map_named("blend").at(projection_by("blend").band, phi) - phi;
      worst.observe((q - p - move * (is_ball ? Vector3(p.normalized()) : Vector3(0, 0, 1))).norm());
    }
    measured.row(specimen.name, worst.value());
  }
  return judge_worst(measured, twice,
                     "a point goes straight out by f - phi, nowhere else; " + tolerance_reason);
}

Finding far_points_are_untouched() {
  const auto changed_far_away = [](const Projected& of) {
    const PerParticle before = of.before();
    double changed = 0;
    for (Eigen::Index i = 0; i < before.size(); ++i)
      if (before[i] >= of.projection.band.reach)
        changed += count_differing_entries(of.cloth.x.col(i), of.specimen.x.col(i)) +
                   (of.cloth.outcomes[size_t(i)] != ProjectionOutcome::untouched);
    return changed;
  };
  return judge_worst(
      over_maps({"numbers changed", "1"}, changed_far_away), 0,
      "no bit of a point at tau or farther out may change, and it is reported as untouched");
}

Finding pinched_points_are_left_alone() {
  Table measured{{"case", ""}, {"numbers changed", "1"}};
  const ProjectionCase specimen = overlapping_balls();
  for (const DepthMap& map : depth_maps()) {
    const ProjectedCloth cloth = project_specimen(specimen, projection_by(std::string(map.name)));
    double changed = 0;
    int pinched = 0;
    for (Eigen::Index i = 0; i < cloth.x.cols(); ++i) {
      const bool is_pinched = (specimen.x.col(i) - Vector3(-0.19, 0.03, 0.02)).norm() < 0.31 &&
                              (specimen.x.col(i) - Vector3(0.17, -0.02, 0.05)).norm() < 0.27;
      pinched += is_pinched;
      changed += (cloth.outcomes[size_t(i)] == ProjectionOutcome::pinched) != is_pinched;
      if (is_pinched) changed += count_differing_entries(cloth.x.col(i), specimen.x.col(i));
    }
    measured.row(std::string(map.name) + ", " + std::to_string(pinched) + " pinched",
                 pinched > 0 ? changed : NAN);
  }
  return judge_worst(
      measured, 0,
      "no bit of a point inside both balls may change, and exactly those are reported as pinched");
}

Finding plain_is_idempotent() {
  Table measured{{"case", ""}, {"numbers changed by the second projection", "1"}};
  for (ProjectionCase specimen : unpinched_cases()) {
    const FoldProjection projection = projection_by("plain");
    specimen.x = project_specimen(specimen, projection).x;
    const ProjectedCloth again = project_specimen(specimen, projection);
    measured.row(specimen.name, count_differing_entries(again.x, specimen.x));
  }
  return judge_worst(measured, 0,
                     "a point at eps or beyond is where plain projection wants it: no bit changes");
}

Finding projecting_twice_compresses() {
  Table measured{{"case", ""},
                 {"room between -t^/2 and 0 after two projections, over that after one", "1"}};
  ProjectionCase specimen = solids_with_points()[1];
  for (const char* map : {"power", "blend"}) {
    const FoldProjection projection = projection_by(map);
    ProjectionCase line = specimen;
    const RigidObject& body = std::get<RigidObject>(line.objects[0].body);
    const Pose pose = after(pose_at(body.motion, line.time), body.place);
    line.x.resize(3, 2);
    line.x.col(0) = to_world(pose, Vector3(0.41 - projection.band.deepest / 2, 0, 0));
    line.x.col(1) = to_world(pose, Vector3(0.41, 0, 0));
    double room[2];
    for (double& here : room) {
      line.x = project_specimen(line, projection).x;
      const PerParticle phi = distances(line, line.x);
      here = phi[1] - phi[0];
    }
    measured.row(map, room[1] / room[0]);
  }
  return judge_worst(measured, 0.95,
                     "f(phi) = phi at tau alone, so a second projection compresses the result of "
                     "the first: by at least a twentieth, or the map would hardly move anything");
}

Finding gaps_without_room_are_reported() {
  ProjectionCase specimen = two_balls();  // a gap of 0.17 m
  const Vector3 left(-0.4, 0.03, 0.02), right(0.35, -0.02, 0.05);
  const double apart = (right - left).norm(), gap = apart - 0.31 - 0.27;
  specimen.x = PerParticle3(left + (right - left) * ((0.31 + gap / 2) / apart));
  FoldProjection projection = projection_by("plain");
  projection.band = {0.12, 0.2, 0.1};
  const ProjectedCloth cloth = project_specimen(specimen, projection);
  const double before = distances(specimen, specimen.x)[0],
               reached = distances(specimen, cloth.x)[0];
  return {{cloth.outcomes[0] == ProjectionOutcome::unfinished ? before - reached : NAN, tolerance,
           0, "m",
           "a point that cannot get where the map wants it is reported, and is no deeper than it "
           "was, within 1e-12 m"},
          Table("gap [m]; least distance asked for [m]; distance before [m]; distance reached [m]")
              .with_row(gap, projection.band.nearest, before, reached),
          "measured is by how much the point came to lie deeper"};
}

}  // namespace

std::vector<Check> projection_checks() {
  const std::string source = "BMF03 section 5.3";
  return {
      {"projection.points-land-where-the-map-says",
       "A projected point has the signed distance that the map gives it.", source,
       lands_where_the_map_says},
      {"projection.points-end-in-the-band", "Points that began short of tau end in [eps, tau].",
       source, ends_in_the_band},
      {"projection.no-point-is-left-inside",
       "No point that is not pinched is inside after the projection.", source,
       no_point_is_left_inside},
      {"projection.meaningless-settings-are-rejected",
       "A projection without a tolerance, a move, a band or a map is refused with the reason.",
       "a rule of this suite: bad input is refused in words", senseless_ones_are_rejected},
      {"projection.one-move-is-enough",
       "Where distances are exact a point needs one move; the allowed number of moves is never "
       "exceeded.",
       source, one_move_is_enough},
      {"projection.reported-outcomes-are-true",
       "Each point is reported as untouched or as moved to the map's depth, exactly as its "
       "distances imply; none is left half way.",
       "the promise of the reference's header", fates_are_true},
      {"projection.order-of-depths-is-preserved", "Of two points the deeper one stays the deeper.",
       source, order_of_depths_is_kept},
      {"projection.points-move-along-the-normal",
       "Points go straight out along the object's normal.", source, moves_along_the_normal},
      {"projection.far-points-are-untouched", "Points from tau up keep every bit.", source,
       far_points_are_untouched},
      {"projection.pinched-points-are-left-alone", "Points inside two objects keep every bit.",
       source, pinched_points_are_left_alone},
      {"projection.plain-projection-is-idempotent",
       "Plain projection done twice is plain projection.", source, plain_is_idempotent},
      {"projection.projecting-twice-compresses-more",
       "The other maps, applied twice, compress more: they are not idempotent.", source,
       projecting_twice_compresses},
      {"projection.narrow-gaps-are-reported",
       "A point between objects that are closer than the map needs is reported and not made worse.",
       source, gaps_without_room_are_reported}};
}

}  // namespace foldproof
