#include "scripts/program/any_case/settings_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "convergence/any_case/level_run.h"
#include "reference/mesh/mesh_frames.h"
#include "verification/subjects/suite/scenes.h"

namespace foldproof {

namespace {

struct TableRow {
  size_t line;
  std::vector<std::string> cells;
};

struct TypedTable {
  std::string file;
  std::vector<std::string> names;
  std::vector<TableRow> rows;

  size_t column(const std::string& name) const {  // names.size(): there is none
    return size_t(std::ranges::find(names, name) - names.begin());
  }
  InputError refuse(size_t line, const std::string& why) const {
    return InputError(fmt::format("{}:{}: {}", file, line, why));
  }
};

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  for (const std::string& cell : suite::split(line, ",")) {
    const size_t from = cell.find_first_not_of(" \t\r"), to = cell.find_last_not_of(" \t\r");
    cells.push_back(from == std::string::npos ? "" : cell.substr(from, to - from + 1));
  }
  return cells;
}

TypedTable read_table(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw InputError("cannot read " + file);
  TypedTable table{file, {}, {}};
  size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    if (table.names.empty()) {
      table.names = cells_of(line);
      continue;
    }
    table.rows.push_back({number, cells_of(line)});
    if (table.rows.back().cells.size() != table.names.size())
      throw table.refuse(number, fmt::format("it has {} cells, the heading {}",
                                             table.rows.back().cells.size(), table.names.size()));
  }
  if (table.rows.empty()) throw InputError(file + ": it has no rows of runs");
  if (table.column("frames") == table.names.size())
    throw table.refuse(1, "there is no column 'frames'");
  return table;
}

TunableKind kind_of(const std::string& name) {
  if (name.find("iter") != std::string::npos) return TunableKind::iterations;
  return name.find("tol") != std::string::npos ? TunableKind::tolerance : TunableKind::substeps;
}

/// Columns of tunables; iterations and tolerances last.
std::vector<size_t> tunable_columns(const TypedTable& table) {
  std::vector<size_t> columns;
  for (size_t k = 0; k < table.names.size(); ++k)
    if (table.names[k] != "frames" && table.names[k] != "seconds") columns.push_back(k);
  if (columns.empty() || columns.size() > 2)
    throw table.refuse(1, "beside 'frames' and 'seconds' there must be one tunable, or two");
  std::ranges::stable_partition(
      columns, [&](size_t k) { return kind_of(table.names[k]) == TunableKind::substeps; });
  return columns;
}

double number_in(const TypedTable& table, const TableRow& row, size_t column) {
  try {
    const double value = std::stod(row.cells[column]);
    if (value > 0) return value;
  } catch (const std::exception&) {
  }
  throw table.refuse(row.line, fmt::format("'{}' is no positive number of {}", row.cells[column],
                                           table.names[column]));
}

std::vector<MeshFrame> frames_of(const TypedTable& table, const TableRow& row) {
  const std::filesystem::path folder = std::filesystem::path(table.file).parent_path();
  return read_mesh_frames({(folder / row.cells[table.column("frames")]).string()});
}

/// By areas of the first frame; without faces particles count alike.
SettingsCloth cloth_of(const MeshFrame& first) {
  if (first.triangles.empty()) return {PerParticle::Ones(first.x.cols()), {}, {}};
  const TriangleMesh mesh = make_triangle_mesh(first.x, first.triangles);
  return {lumped_masses(mesh, 1), mesh.edges, rest_lengths(mesh)};
}

SettingsRun run_of(const TypedTable& table, const TableRow& row, const SettingsPair& at,
                   const SettingsCloth& cloth) {
  std::vector<PerParticle3> x;
  for (MeshFrame& frame : frames_of(table, row)) {
    if (frame.x.cols() != cloth.mass.size())
      throw table.refuse(row.line, fmt::format("{} has {} vertices, those of the first row {}",
                                               frame.file, frame.x.cols(), cloth.mass.size()));
    x.push_back(std::move(frame.x));
  }
  return measured_run(at, x, cloth);
}

}  // namespace

SettingsAnswer settings_answer_of_table(const std::string& file, const std::vector<double>& at,
                                        const std::vector<double>& wanted) {
  const TypedTable table = read_table(file);
  const std::vector<size_t> columns = tunable_columns(table);
  const MeshFrame first = frames_of(table, table.rows[0]).front();
  const SettingsCloth cloth = cloth_of(first);
  SettingsMap map{{}, settings_quantities(cloth, 0)};
  // files keep single precision
  for (SettingsQuantity& q : map.quantities)
    q.floor = 4 * 6e-8 * longest_side(first.x) / (q.unit == "m" ? 1 : cloth.lengths.minCoeff());
  for (const size_t column : columns)
    map.axes.push_back({table.names[column], kind_of(table.names[column])});
  const size_t seconds = table.column("seconds");
  for (const TableRow& row : table.rows) {
    if (row.cells[0] == "truth") {
      const SettingsRun truth = run_of(table, row, {1, 1}, cloth);
      for (size_t q = 0; q < map.quantities.size(); ++q) map.quantities[q].truth = truth.seen[q];
      continue;
    }
    SettingsPair pair{1, 1};
    for (size_t k = 0; k < columns.size(); ++k) pair[k] = number_in(table, row, columns[k]);
    SettingsRun run = run_of(table, row, pair, cloth);
    run.cost = pair[0] * pair[1];
    if (seconds < table.names.size()) run.cost = run.seconds = number_in(table, row, seconds);
    map.runs.push_back(std::move(run));
  }
  SettingsPair in_use = map.runs.front().at;
  for (size_t k = 0; k < columns.size() && !at.empty(); ++k)
    in_use[k] = at[std::min(at.size() - 1, size_t(std::ranges::count_if(columns, [&](size_t c) {
                              return c < columns[k];
                            })))];
  SettingsAnswer answer = settings_answer(std::move(map), in_use, wanted);
  answer.scene = std::filesystem::path(file).stem().string(), answer.solver = "runs of a table";
  return answer;
}

}  // namespace foldproof
