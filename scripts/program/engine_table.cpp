#include "scripts/program/engine_table.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "reference/scene/key_file.h"
#include "reference/scene/key_values.h"

namespace foldproof {

namespace {

constexpr double isotropic = 1.0 / 3;  // Poisson's ratio for which Y = 8/3 G

Product product_of(const KeyTable& keys) {
  Product product;
  for (const auto& [name, value] : keys.entries)
    (name == "factor" ? product.factor : product.powers[name]) = keys.number(name);
  return product;
}

EngineNumber number_of(const KeyTable& keys) {
  return {keys.text("name"), keys.text("unit"), product_of(*keys.table("value")),
          keys.text("depends"), keys.text("from")};
}

Engine engine_of(const KeyTable& keys) {
  Engine engine{keys.text("name"),
                keys.text("words"),
                "",
                "",
                0,
                0,
                keys.number_or("poisson", isotropic),
                {},
                {},
                keys.texts("cannot"),
                keys.text_or("snippet", "")};
  const std::vector<std::string> marks = keys.texts("comment");
  if (marks.size() != 2) throw InputError(keys.where("comment") + ": two texts are needed");
  engine.comment = marks[0], engine.end_of_comment = marks[1];
  if (keys.has("pair")) {
    const std::vector<long> pair = keys.integers("pair");
    if (pair.size() != 2) throw InputError(keys.where("pair") + ": two numbers are needed");
    engine.substeps = pair[0], engine.iterations = pair[1];
  }
  if (keys.has("relation")) engine.relation = product_of(*keys.table("relation"));
  for (const auto& number : keys.tables("number")) engine.numbers.push_back(number_of(*number));
  return engine;
}

/// The product of what has a value, and the powers of what has none.
std::pair<double, std::map<std::string, double>> known_part(const Product& product,
                                                            const Values& values) {
  double known = product.factor;
  std::map<std::string, double> rest;
  for (const auto& [name, power] : product.powers) {
    const auto found = values.find(name);
    if (found == values.end())
      rest[name] = power;
    else
      known *= std::pow(found->second, power);
  }
  return {known, rest};
}

}  // namespace

std::vector<Engine> read_engines(const std::string& path) {
  const auto root = parse_keys(read_text(path), path);
  std::vector<Engine> engines;
  for (const auto& keys : root->tables("engine")) engines.push_back(engine_of(*keys));
  root->reject_unused();
  return engines;
}

const Engine& engine_named(const std::vector<Engine>& engines, const std::string& name) {
  std::string known;
  for (const Engine& engine : engines) {
    if (engine.name == name) return engine;
    known += (known.empty() ? "" : ", ") + engine.name;
  }
  throw InputError("unknown engine '" + name + "'; known: " + known);
}

void add_poisson(Values& values, double poisson) {
  values["poisson"] = poisson;
  values["plate"] = 12 * (1 - poisson * poisson);
  values["stretch"] = 2 * (1 + poisson);
  values["lame"] = 2 * poisson / (1 - poisson);
  values["oblique"] = 2 * poisson / (1 - 2 * poisson);
}

double value_of(const Product& product, const Values& values) {
  const auto [known, rest] = known_part(product, values);
  return rest.empty() ? known : std::numeric_limits<double>::quiet_NaN();
}

std::string code_of(const Product& product, const Values& values) {
  const auto [known, rest] = known_part(product, values);
  std::string code = fmt::format("{:.6g}", known);
  for (const double sign : {1.0, -1.0})
    for (const auto& [name, power] : rest)
      for (double left = sign * power; left > 0; --left) code += (sign > 0 ? " * " : " / ") + name;
  return code;
}

bool solve(const Product& product, double number, Values& values) {
  const auto [known, rest] = known_part(product, values);
  if (rest.size() != 1 || !(known > 0) || !(number > 0)) return false;
  const auto& [name, power] = *rest.begin();
  values[name] = std::pow(number / known, 1 / power);
  return true;
}

}  // namespace foldproof
