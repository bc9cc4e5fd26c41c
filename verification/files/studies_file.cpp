#include "verification/files/studies_file.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "verification/files/findings_file.h"
#include "verification/files/hdf5_file.h"

namespace foldproof {

namespace {

std::string scale_name(Scale scale) { return scale == Scale::log ? "log" : "linear"; }

/// The names of the marks, one a point.
std::vector<std::string> names_of(const Curve& curve) {
  if (curve.marks.size() != curve.x.size())
    throw std::logic_error(
        fmt::format("curve '{}': {} marks for {} points; give one for each, or none", curve.label,
                    curve.marks.size(), curve.x.size()));
  std::vector<std::string> names;
  for (const Mark mark : curve.marks) names.emplace_back(name_of(mark));
  return names;
}

void write_curve(const Hdf5& parent, const Curve& curve, int order) {
  const Hdf5 here = parent.group(fmt::format("curve-{:02}", order));
  here.attribute("order", order);
  here.attribute("label", curve.label);
  here.attribute("floor", curve.floor);
  here.dataset("x", curve.x);
  here.dataset("y", curve.y);
  if (!curve.pair_orders.empty()) here.dataset("pair_orders", curve.pair_orders);
  if (!std::isnan(curve.slope)) here.attribute("slope", curve.slope);
  if (!curve.marks.empty()) here.dataset("marks", names_of(curve));
}

void write_curves(const Hdf5& parent, const std::vector<Curve>& curves) {
  const Hdf5 here = parent.group("curves");
  for (size_t k = 0; k < curves.size(); ++k) write_curve(here, curves[k], int(k));
}

/// Attributes x_label, x_unit, x_scale of an object whose axis is named "x".
void write_axis(const Hdf5& object, const std::string& name, const Axis& axis) {
  object.attribute(name + "_label", axis.label);
  object.attribute(name + "_unit", axis.unit);
  object.attribute(name + "_scale", scale_name(axis.scale));
}

void write_figure(const Hdf5& parent, const Figure& figure, int order) {
  const Hdf5 here = parent.group(figure.name);
  here.attribute("order", order);
  here.attribute("title", figure.title);
  write_axis(here, "x", figure.x);
  write_axis(here, "y", figure.y);
  here.attribute("slope", figure.slope);
  here.attribute("caption", figure.caption);
  write_curves(here, figure.curves);
}

void reject_misshapen(const Map& map) {
  if (map.values.size() != map.x_values.size() * map.y_values.size())
    throw std::logic_error(
        fmt::format("map '{}': {} values for {} x {} points; give one for each, row by row",
                    map.name, map.values.size(), map.x_values.size(), map.y_values.size()));
}

void write_map(const Hdf5& parent, const Map& map, int order) {
  reject_misshapen(map);
  const Hdf5 here = parent.group(map.name);
  here.attribute("order", order);
  here.attribute("title", map.title);
  write_axis(here, "x", map.x);
  write_axis(here, "y", map.y);
  here.attribute("quantity", map.quantity);
  here.attribute("unit", map.unit);
  here.attribute("scale", scale_name(map.scale));
  here.attribute("caption", map.caption);
  here.dataset("x", map.x_values).attribute("unit", map.x.unit);
  here.dataset("y", map.y_values).attribute("unit", map.y.unit);
  here.array("values", {map.y_values.size(), map.x_values.size()}, map.values.data())
      .attribute("unit", map.unit);
  write_curves(here, map.curves);
}

void write_table(const Hdf5& parent, const Table& table, int order) {
  const Hdf5 here = parent.group(table.name);
  here.attribute("order", order);
  here.attribute("title", table.title);
  write_columns(here, table.columns());
}

void write_study(const Hdf5& parent, const StudyRecord& study, int order) {
  const Hdf5 here = parent.group(study.name);
  here.attribute("order", order);
  here.attribute("claim", study.claim);
  here.attribute("source", study.source);
  here.attribute("about", study.about);
  here.attribute("seconds", study.seconds);
  const Hdf5 figures = here.group("figures");
  for (size_t k = 0; k < study.figures.size(); ++k) write_figure(figures, study.figures[k], int(k));
  const Hdf5 maps = here.group("maps");
  for (size_t k = 0; k < study.maps.size(); ++k) write_map(maps, study.maps[k], int(k));
  const Hdf5 tables = here.group("tables");
  for (size_t k = 0; k < study.tables.size(); ++k) write_table(tables, study.tables[k], int(k));
}

}  // namespace

void write_studies(const Hdf5& file, const std::vector<StudyRecord>& studies) {
  const Hdf5 here = file.group("studies");
  for (size_t k = 0; k < studies.size(); ++k) write_study(here, studies[k], int(k));
}

}  // namespace foldproof
