#include "scripts/program/program_json.h"

#include "scripts/program/provenance.h"

namespace foldproof {

nlohmann::json program_json(const std::string& command) {
  const Provenance p = provenance(command);
  return {{"version", p.version}, {"commit", p.commit},
          {"tree", p.tree},       {"identity", program_identity()},
          {"cpu", p.cpu},         {"date", p.date},
          {"command", p.command}};
}

}  // namespace foldproof
