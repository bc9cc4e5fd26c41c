// The studies of this room: what happens where cloth meets objects, and itself?
#pragma once

#include "convergence/study.h"

namespace foldproof {

Study wrinkles_kept_study();  // wrinkle-preservation: what each map of depth leaves of wrinkles inside an object
Study eps_needed_study();     // required-eps: how far out the deepest points must go
Study folds_inside_study();     // folding-inside-objects: folds of cloth that may stay inside of an object
Study forecast_time_study();    // forecast-time: where a point is after its forecast, and what tau does
Study resting_contact_study();  // resting-contact: what keeps moving under each response
Study self_collision_cost_study();  // self-collision-cost: search, zones, gaps at rest
Study pointwise_contact_study();    // pointwise-contact: what lies between particles that are held out
Study crossing_queries_study();  // crossing-queries: moving features that meet, and whether that is noticed
Study folding_study();           // folding: 0 % compression between ends that come together

}  // namespace foldproof
