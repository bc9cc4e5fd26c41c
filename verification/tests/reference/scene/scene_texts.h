// Texts of small cases, for tests of their readers.
#pragma once

#include <catch2/catch.hpp>
#include <string>
#include <utility>
#include <vector>

#include "reference/scene/scene.h"

namespace foldproof {

/// Lines 1 to 5: four particles.
inline const std::string hinge_cloth =
    "[cloth]\nshape = \"hinge\"\nlength = 1.5\nangle = 9\ndensity = 0.2\n";

/// The hinge, the tables from line 6 on, and a time.
inline Scene scene_with(const std::string& tables, const SceneLimits& limits = {}) {
  return read_scene_text(hinge_cloth + tables + "[time]\nend = 0.7\n", "some.toml", {}, limits);
}

/// A cloth alone: its keys from line 3 on.
inline Scene scene_of_cloth(const std::string& keys, const SceneLimits& limits = {}) {
  return read_scene_text("[cloth]\ndensity = 0.2\n" + keys + "[time]\nend = 0.7\n", "some.toml", {},
                         limits);
}

/// A sheet of 3 x 4 squares of a quarter metre from (2, 0.5, -1), 20 particles, row by row from
/// below: lines 1 to 9.
inline const std::string sheet_cloth =
    "[cloth]\ndensity = 0.2\nshape = \"sheet\"\nwidth = 0.75\nheight = 1\ncolumns = 3\nrows = 4\n"
    "move = [2, 0.5, -1]\n\n";

/// The sheet, the tables from line 10 on, and a time.
inline Scene sheet_with(const std::string& tables) {
  return read_scene_text(sheet_cloth + tables + "[time]\nend = 0.7\n", "some.toml");
}

/// Each of the texts is refused by `read` with a message that has the piece beside it.
template <class Read>
void check_refused(const Read& read, const std::vector<std::pair<std::string, std::string>>& rows) {
  for (const auto& [text, piece] : rows) {
    INFO(text);
    CHECK_THROWS_WITH(read(text), Catch::Matchers::Contains(piece));
  }
}

}  // namespace foldproof
