// Validations: is what is simulated like something measured, or like the continuum that the paper
// means? Studies of a kind of their own.
#pragma once

#include "convergence/study.h"

namespace foldproof {

Study heavy_cantilever_study();    // heavy-cantilever: over five decades of weight
Study free_fold_study();           // free-fold: a strip folded back over itself, held by nothing
Study lateral_buckling_study();    // lateral-buckling: a ribbon on edge tips under its weight
Study stretched_wrinkles_study();  // stretched-wrinkles: a sheet under tension, compressed across
Study hanging_chain_study();       // hanging-chain: limp strips hang and swing
Study friction_tests_study();      // friction-tests: an incline, and a belt on a drum
Study fold_tests_study();          // fold-tests: strips folded over on a floor
Study pressed_strip_study();       // pressed-strip: when the tip of a strip on a floor slips
Study fabric_strip_study();        // fabric-strip: a simulated strip in the laboratory's test
Study strip_tests_study();         // strip-tests: a laboratory's loops, rings and wrinkles
Study hung_disc_study();           // hung-disc: a disc that hangs from its centre
Study cusick_drape_study();        // cusick-drape: a disc of cloth over a smaller plate

}  // namespace foldproof
