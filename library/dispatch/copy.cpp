#include "library/dispatch/copy.h"

#include <memory>
#include <utility>

// Compiled once for each copy, with the name of its table.
using cscd::SelfCollision;

const cscd::Copy CSCD_COPY = {
    .set = cscd::kCompiledFor,
    .make =
        [](const SelfCollision::Faces& faces, const SelfCollision::Positions& reference,
           SelfCollision::Options&& options) {
          return std::make_unique<SelfCollision>(faces, reference, std::move(options)).release();
        },
    .destroy = [](SelfCollision* body) { delete body; },
    .place_obstacle = &SelfCollision::place_obstacle,
    .move_obstacle = &SelfCollision::move_obstacle,
    .is_free = &SelfCollision::is_free,
    .first_contact = &SelfCollision::first_contact,
    .all_contacts = &SelfCollision::all_contacts,
    .largest_step = &SelfCollision::largest_step,
    .candidates = &SelfCollision::candidates,
    .vertex_bounds = &SelfCollision::vertex_bounds,
    .crossings = &SelfCollision::crossings,
    .true_motion = &SelfCollision::true_motion,
    .preparation = &SelfCollision::preparation,
    .vertex_count = &SelfCollision::vertex_count,
    .face_count = &SelfCollision::face_count,
    .closed = &SelfCollision::closed};
