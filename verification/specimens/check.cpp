#include "verification/specimens/check.h"

#include "reference/dynamics/integrator.h"

namespace foldproof {

Table no_statements() { return {{"statement", "1"}, {"true", "1"}}; }

double count_false(const Table& statements) {
  double wrong = statements.rows() == 0 ? NAN : 0;
  for (const double one : statements.numbers("true")) wrong += 1 - one;
  return wrong;
}

SchemeCheck::SchemeCheck(std::string name, std::string claim, std::string source, OfSubject run)
    : name(std::move(name)),
      claim(std::move(claim)),
      source(std::move(source)),
      run(std::move(run)) {}

SchemeCheck::SchemeCheck(std::string name, std::string claim, std::string source, OfReference run)
    : SchemeCheck(std::move(name), std::move(claim), std::move(source),
                  OfSubject([run = std::move(run)](const Subject&, const std::string& scheme) {
                    return run(scheme);
                  })) {}

void add_for_each_scheme(std::vector<Check>& list, const std::vector<SchemeCheck>& patterns) {
  for (const SchemeCheck& pattern : patterns)
    for (const Integrator& integrator : paper_schemes()) {
      const std::string scheme(integrator.name);
      list.push_back(
          {pattern.name + "." + scheme, "Scheme " + scheme + ": " + pattern.claim, pattern.source,
           [run = pattern.run, scheme](const Subject& subject) { return run(subject, scheme); }});
    }
}

std::string rejection_message(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

int count_missing(const std::string& text, const std::vector<std::string>& parts) {
  int missing = 0;
  for (const std::string& part : parts) missing += text.find(part) == std::string::npos;
  return missing;
}

bool is_rejected(const std::function<void()>& act, const std::string& words) {
  const std::string message = rejection_message(act);
  return !message.empty() && count_missing(message, {words}) == 0;
}

}  // namespace foldproof
