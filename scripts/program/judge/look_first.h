// Which cause a pattern of failing laws has, by a table of planted bugs and the laws they fail.
#pragma once

#include <string>
#include <vector>

#include "verification/verdict.h"

namespace foldproof {

struct PlantedBug {
  std::string name, kind;          // kind: the class of bugs that it is one of
  std::vector<std::string> fails;  // laws that do not hold with it
};

/// Of a file of JSON lines, {"bug": NAME, "class": CLASS, "fails": [LAW, ...]}; none if there is no
/// such file. Throws InputError naming the line.
std::vector<PlantedBug> read_planted_bugs(const std::string& path);

struct LikelyCause {
  std::string kind, nearest;  // nearest: the bug of the class whose laws are most like the pattern
  double odds;                // of the class, among all [1]
};

/// Classes of bugs, the likeliest first. Naive Bayes over the words in the names of laws that do
/// not hold: a word is as frequent with a class as with its bugs, counted with one more bug that
/// has half of it; classes are as frequent as their bugs. Laws that were not decided do not count.
/// Empty if no law fails that has a word in common with one that a bug fails.
std::vector<LikelyCause> likely_causes(const std::vector<PlantedBug>& bugs,
                                       const std::vector<Record>& records);

/// "Look first at:" and up to three causes with their odds; "" if there are none.
std::string look_first_text(const std::vector<LikelyCause>& causes);

}  // namespace foldproof
