// The studies of this room: what happens where cloth meets objects, and itself?
#pragma once

#include "convergence/study.h"

namespace foldproof {

Study filtered_order_study();  // filtered-order: order under contact and strain limits
// wrinkle-preservation: what each map of depth leaves of wrinkles inside an object
Study wrinkles_kept_study();
Study eps_needed_study();  // required-eps: how far out the deepest points must go
// folding-inside-objects: folds of cloth that may stay inside of an object
Study folds_inside_study();
// forecast-time: where a point is after its forecast, and what tau does
Study forecast_time_study();
Study resting_contact_study();      // resting-contact: what keeps moving under each response
Study self_collision_cost_study();  // self-collision-cost: search, zones, gaps at rest
// pointwise-contact: what lies between particles that are held out
Study pointwise_contact_study();
// crossing-queries: moving features that meet, and whether that is noticed
Study crossing_queries_study();
// contact-answers: contacts that repulsion, impulses and zones answer
Study contact_answers_study();
Study folding_study();  // folding: 0 % compression between ends that come together

}  // namespace foldproof
