#include "verification/subjects/crossing_queries.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <sstream>
#include <vector>

#include "reference/filters/approach.h"
#include "reference/mesh/text_file.h"
#include "verification/oracles/exact_crossing_times.h"

namespace foldproof {

namespace {

using oracles::Fraction;
using oracles::Whole;

// of six long whole numbers: a gigabyte of memory
constexpr std::size_t most_query_rows = 4'000'000;
// Of a number: exact arithmetic takes the time of their square, and a double has a numerator and a
// denominator of at most 309 and 324.
constexpr std::size_t most_digits = 1000;

struct FileQuery {
  std::array<std::array<Fraction, 3>, 8> points;
  bool meets;         // as the file says
  std::string where;  // its first row
};

Whole parse_whole(const std::string& field, const std::string& where) {
  const std::size_t first = field.find_first_not_of(" \t\r"),
                    last = field.find_last_not_of(" \t\r");
  const std::string text = first == std::string::npos ? "" : field.substr(first, last - first + 1);
  const std::string digits = text.starts_with('-') ? text.substr(1) : text;
  if (digits.empty() || digits.find_first_not_of("0123456789") != std::string::npos)
    throw InputError(where + ": '" + text + "' is not a whole number");
  if (digits.size() > most_digits)
    throw InputError(fmt::format("{}: a number has more than {} digits", where, most_digits));
  // 012 would be octal
  const std::size_t nonzero = std::min(digits.find_first_not_of('0'), digits.size() - 1);
  const Whole size(digits.substr(nonzero));
  return text.starts_with('-') ? Whole(-size) : size;
}

std::array<Whole, 7> parsed_row(const std::string& line, const std::string& where) {
  std::array<Whole, 7> row;
  std::istringstream fields(line);
  std::size_t count = 0;
  for (std::string field; std::getline(fields, field, ','); ++count)
    if (count < row.size()) row[count] = parse_whole(field, where);
  if (count != row.size())
    throw InputError(fmt::format("{}: {} values, but a row has 7", where, count));
  if (row[1] == 0 || row[3] == 0 || row[5] == 0) throw InputError(where + ": a denominator is 0");
  if (row[6] != 0 && row[6] != 1) throw InputError(where + ": the last value must be 0 or 1");
  return row;
}

std::vector<FileQuery> read_queries(const std::string& text, const std::string& file) {
  std::istringstream in(text);
  std::vector<FileQuery> queries;
  std::size_t rows = 0, number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const std::string where = fmt::format("{}:{}", file, number);
    const auto row = parsed_row(line, where);
    if (rows == most_query_rows)
      throw InputError(
          fmt::format("{}: more than {} rows, the most that is read", where, most_query_rows));
    if (rows % 8 == 0) queries.push_back({{}, row[6] == 1, where});
    if (queries.back().meets != (row[6] == 1))
      throw InputError(where + ": the rows of a query disagree on its truth");
    queries.back().points[rows % 8] = {Fraction{row[0], row[1]}, Fraction{row[2], row[3]},
                                       Fraction{row[4], row[5]}};
    ++rows;
  }
  if (rows == 0 || rows % 8 != 0)
    throw InputError(fmt::format("{}: {} rows, but a query has 8", file, rows));
  return queries;
}

double nearest_double(const Fraction& f) {
  const oracles::Digits50 quotient =
      oracles::Digits50(f.numerator) / oracles::Digits50(f.denominator);
  return quotient.convert_to<double>();
}

/// The four points at the start (from = 0) or at the end (from = 4), finite.
Corners4 corners_at(const FileQuery& query, std::size_t from) {
  Corners4 x;
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t axis = 0; axis < 3; ++axis)
      x(Eigen::Index(axis), Eigen::Index(k)) = nearest_double(query.points[from + k][axis]);
  if (!x.allFinite()) throw InputError(query.where + ": a coordinate does not fit a double");
  return x;
}

/// Kind of the queries of a file: as given, or from its path.
std::string kind_of(const std::string& file, const std::string& given) {
  if (!given.empty()) return given;
  for (const char* kind : {"vertex-face", "edge-edge"})
    if (file.find(kind) != std::string::npos) return kind;
  throw InputError(file + ": say --kind vertex-face or --kind edge-edge, or have it in the path");
}

bool evaluate_file(const std::string& file, const std::string& given, double keep) {
  const auto [queries, meetings, reference, exact] =
      judge_queries(read_text_file(file, table_text_limits), file, given, keep);
  fmt::print("{}: {} queries; meeting, by the file: {}\n", file, queries, meetings);
  fmt::print("reference, keeping {:g} m: {} missed, {} told though apart\n", keep, reference.misses,
             reference.alarms);
  fmt::print("exact judge: {} missed, {} told though apart\n", exact.misses, exact.alarms);
  return reference.misses == 0 && exact.misses == 0 && exact.alarms == 0;
}

}  // namespace

JudgedQueries judge_queries(const std::string& text, const std::string& name,
                            const std::string& kind, double keep) {
  const bool is_vertex = kind_of(name, kind) == "vertex-face";
  const PairKind pair = is_vertex ? PairKind::vertex_triangle : PairKind::edge_edge;
  const auto features =
      is_vertex ? oracles::Features::vertex_and_triangle : oracles::Features::edge_and_edge;
  const std::vector<FileQuery> queries = read_queries(text, name);
  JudgedQueries judged;
  judged.queries = queries.size();
  for (const FileQuery& query : queries) {
    judged.meetings += query.meets;
    const Corners4 start = corners_at(query, 0);
    judged.reference.record(
        query.meets, first_approach(pair, start, corners_at(query, 4) - start, keep).has_value());
    judged.exact.record(query.meets,
                        oracles::ever_meet(features, oracles::motion_between(query.points)));
  }
  return judged;
}

bool evaluate_crossings(const std::string& path, const std::string& kind, double keep) {
  if (!(keep > 0)) throw InputError("--keep must be a distance > 0");
  if (!std::filesystem::is_directory(path)) return evaluate_file(path, kind, keep);
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(path))
    if (entry.path().extension() == ".csv") files.push_back(entry.path().string());
  if (files.empty()) throw InputError(path + ": there is no .csv file in this folder");
  std::sort(files.begin(), files.end());
  bool all = true;
  for (const std::string& file : files) all = evaluate_file(file, kind, keep) && all;
  return all;
}

}  // namespace foldproof
