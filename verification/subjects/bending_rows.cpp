#include "verification/subjects/bending_rows.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <sstream>
#include <vector>

#include "reference/forces/bending.h"
#include "reference/forces/degenerate.h"
#include "reference/mesh/text_file.h"

namespace foldproof {

namespace {

constexpr size_t most_rows = 1'000'000;  // of 27 numbers: half a gigabyte of memory

struct Row {
  std::string where;  // file:line
  std::vector<double> values;
};

double parse_number(const std::string& field, const std::string& where) {
  const size_t first = field.find_first_not_of(" \t\r"), last = field.find_last_not_of(" \t\r");
  const std::string trimmed =
      first == std::string::npos ? "" : field.substr(first, last - first + 1);
  const char* begin = trimmed.c_str() + (trimmed.starts_with('+') ? 1 : 0);
  double value = 0;
  const auto [end, error] = std::from_chars(begin, trimmed.c_str() + trimmed.size(), value);
  if (error != std::errc() || end != trimmed.c_str() + trimmed.size() || !std::isfinite(value))
    throw InputError(where + ": '" + trimmed + "' is not a finite number");
  return value;
}

/// Rows of `columns` comma-separated numbers; lines that start with '#' or a letter (a heading)
/// are passed over.
std::vector<Row> read_rows(const NamedText& named, size_t columns) {
  const std::string& file = named.name;
  std::istringstream in(named.text);
  std::vector<Row> rows;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    const size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') continue;
    if (rows.empty() && std::isalpha(static_cast<unsigned char>(line[first])) &&
        line.find(',') != std::string::npos && !line.substr(first).starts_with("nan") &&
        !line.substr(first).starts_with("inf"))
      continue;  // a heading
    Row row{file + ":" + std::to_string(number), {}};
    if (rows.size() == most_rows)
      throw InputError(
          fmt::format("{}: more than {} rows, the most that is read", row.where, most_rows));
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');)
      row.values.push_back(parse_number(field, row.where));
    if (row.values.size() != columns)
      throw InputError(
          fmt::format("{}: {} values, but a row has {}", row.where, row.values.size(), columns));
    rows.push_back(std::move(row));
  }
  if (rows.empty()) throw InputError(file + ": there is no row of numbers in it");
  return rows;
}

PerParticle3 four_columns(const std::vector<double>& values, size_t from) {
  return Eigen::Map<const PerParticle3>(values.data() + from, 3, 4);
}

std::string row_text(const PerParticle3& elastic, const PerParticle3& damping) {
  if (!elastic.allFinite() || !damping.allFinite())
    throw InputError("a force is more than a double holds; give smaller numbers");
  std::string line;
  for (const PerParticle3* part : {&elastic, &damping})
    for (Eigen::Index k = 0; k < 12; ++k)
      line += fmt::format("{}{:.17g}", line.empty() ? "" : ",", part->data()[k]);
  return line + "\n";
}

std::string evaluate_row(const Row& row, const PerParticle3& rest, Weighting weighting) {
  BendingMaterial material;
  material.stiffness = row.values[24];
  material.damping = row.values[25];
  material.weighting = weighting;
  TriangleMesh mesh{rest, {}, {}, {Hinge{{0, 1, 2, 3}, 0}}};
  State s{0, four_columns(row.values, 0), four_columns(row.values, 12)};
  try {
    const Bending bending = make_bending(mesh, material, {row.values[26]});
    PerParticle3 elastic = PerParticle3::Zero(3, 4), damping = PerParticle3::Zero(3, 4);
    const HingeShapes shapes = bending.shapes_at(s.x);
    bending.add_elastic(s, shapes, elastic);
    DampingOperator terms;
    bending.prepare_damping(s, shapes, terms);
    terms.add_product(s.v, damping);
    return row_text(elastic, damping);
  } catch (const DegenerateElement& error) {
    throw InputError(row.where + ": " + error.what());
  } catch (const InputError& error) {
    throw InputError(row.where + ": " + error.what());
  }
}

}  // namespace

std::string bending_of_rows(const NamedText& named, const NamedText& rest_named) {
  const std::vector<Row> rows = read_rows(named, 27);
  std::vector<Row> rest_rows;
  if (!rest_named.text.empty()) {
    rest_rows = read_rows(rest_named, 12);
    if (rest_rows.size() != rows.size())
      throw InputError(fmt::format("{}: {} rows, but {} has {}", rest_named.name, rest_rows.size(),
                                   named.name, rows.size()));
  }
  std::string output;
  for (const char* kind : {"elastic", "damping"})
    for (int particle = 1; particle <= 4; ++particle)
      for (const char* axis : {"x", "y", "z"})
        output += fmt::format("{}{}_{}{}", output.empty() ? "" : ",", kind, axis, particle);
  output += "\n";
  for (size_t k = 0; k < rows.size(); ++k) {
    const PerParticle3 rest =
        four_columns(rest_rows.empty() ? rows[k].values : rest_rows[k].values, 0);
    output += evaluate_row(rows[k], rest, rest_rows.empty() ? Weighting::current : Weighting::rest);
  }
  return output;
}

void evaluate_bending(const std::string& file, const std::string& rest_file) {
  const NamedText rest = rest_file.empty()
                             ? NamedText{}
                             : NamedText{read_text_file(rest_file, table_text_limits), rest_file};
  fmt::print("{}", bending_of_rows({read_text_file(file, table_text_limits), file}, rest));
}

}  // namespace foldproof
