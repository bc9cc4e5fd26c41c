// The cloth of small cases, to which each test adds its keys and tables.
#pragma once

#include <string>

namespace foldproof {

/// Four lines. 12 particles, four in a row along x, rows along y: 0.3 m x 0.2 m, 0.2 kg/m^2,
/// 40 N/m; six frames until 0.05 s.
inline const std::string small_sheet =
    R"(cloth = { shape = "sheet", width = 0.3, height = 0.2, columns = 3, rows = 2, density = 0.2 }
stretch = { stiffness = 40 }
time = { end = 0.05, frames_per_second = 100 }
gravity = { acceleration = [0, -9.5, 0] }
)";

}  // namespace foldproof
