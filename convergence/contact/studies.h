// The studies of this room: what happens where cloth meets objects, and itself?
#pragma once

#include "convergence/study.h"

namespace foldproof {

Study wrinkles_kept();  // wrinkle-preservation: what each map of depth leaves of wrinkles inside an object
Study eps_needed();     // required-eps: how far out the deepest points must go
Study folds_inside();   // folding-inside-objects: folds of cloth that may stay inside of an object
Study forecast_time_study();  // forecast-time: where a point is after its forecast, and what tau does
Study resting_contact();      // resting-contact: what keeps moving under each response
Study self_collision_cost();  // self-collision-cost: search, zones, gaps at rest
Study pointwise_contact();    // pointwise-contact: what lies between particles that are held out
Study crossing_queries();     // crossing-queries: moving features that meet, and whether that is noticed
Study folding();              // folding: 0 % compression between ends that come together

}  // namespace foldproof
