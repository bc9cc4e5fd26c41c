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

Engine engine_of(const KeyTable& keys) {
  Engine engine{.name = keys.text("name"),
                .words = keys.text("words"),
                .comment = keys.text("comment"),
                .comment_end = keys.text_or("comment_end", ""),
                .pair = keys.has("pair") ? keys.integers("pair") : std::vector<long>{},
                .poisson = keys.number_or("poisson", isotropic),
                .relation = {},
                .numbers = {},
                .cannot = keys.texts("cannot"),
                .snippet = keys.text_or("snippet", "")};
  if (keys.has("relation")) engine.relation = product_of(*keys.table("relation"));
  for (const auto& number : keys.tables("number")) {
    for (const char* of_the_page : {"depends", "from"}) number->leave(of_the_page);
    engine.numbers.push_back(
        {number->text("name"), number->text("unit"), product_of(*number->table("value"))});
  }
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
