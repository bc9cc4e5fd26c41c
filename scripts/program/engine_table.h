// cases/engines.toml: what a fabric's numbers are called in each engine, and what they are.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace foldproof {

using Values = std::map<std::string, double>;  // by name, SI

/// A factor times powers of named quantities.
struct Product {
  double factor = 1;
  std::map<std::string, double> powers = {};
};

/// A number that an engine takes.
struct EngineNumber {
  std::string name, unit;
  Product value;
};

struct Engine {
  std::string name, words;           // as typed; the engine and the version meant
  std::string comment, comment_end;  // in its language
  std::vector<long> pair;            // substeps, iterations; empty: it has none
  double poisson;                    // for Y = 8/3 G [1]
  Product relation;                  // is 1; without powers: Y and G are free
  std::vector<EngineNumber> numbers;
  std::vector<std::string> cannot;  // represent, in words
  std::string snippet;              // with {names}; empty: there is none
};

/// Throws InputError "file:line: ..." for what the file's head does not describe.
std::vector<Engine> read_engines(const std::string& path);

/// Throws InputError with the known names.
const Engine& engine_named(const std::vector<Engine>& engines, const std::string& name);

/// plate, stretch, lame and oblique of a Poisson's ratio; poisson itself.
void add_poisson(Values& values, double poisson);

/// NaN where a quantity has no value.
double value_of(const Product& product, const Values& values);

/// As code: the known part as one number, names for the rest: "3.7e-06 * length / area".
std::string code_of(const Product& product, const Values& values);

/// The unknown that makes the product `number`, where it is the only one: adds it to the values.
/// Whether it was added.
bool solve(const Product& product, double number, Values& values);

}  // namespace foldproof
