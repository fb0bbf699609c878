#include "bench/answer/answer_request.h"

#include "bench/inputs/thickness.h"
#include "bench/strategies/catalogue.h"
#include "core/base/error.h"

namespace cscd::bench {

void require_sound(const AnswerRequest& request) {
  if (request.resolution.is_given() && !request.model.true_motion)
    throw InputError("--resolution: is for --true-motion; leave it out, or add that");
  if (request.resolution.is_given() && request.resolution.number == 0)
    throw InputError(
        "--resolution 0: what only touches would be looked at without end; give a length above 0");
  const ElementaryTest& elementary = elementary_test_named(request.elementary);
  require_fit(request.thickness, elementary);
  for (const std::string& name : request.strategies) require_fit(request.thickness, strategy_named(name));
  // With --first, the time up to which pairs are looked at has to be right.
  if (request.answers.first && (!elementary.apart_is_proof || !elementary.contact_is_proof))
    throw InputError("--first: elementary test '" + std::string(elementary.name) +
                     "' may be wrong about what touches; choose filtered_exact or exact");
  if (request.new_contacts && request.model.true_motion)
    throw InputError("--new-contacts with --true-motion: is about straight lines; leave out one of the two");
  if (request.new_contacts && request.answers.first)
    throw InputError(
        "--new-contacts with --first: the earliest contact may be an old one, after which --first "
        "looks for no other; leave out one of the two");
  if (!request.preparation.empty() && request.strategies.size() > 1)
    throw InputError("--preparation: is that of one strategy; name one alone with --strategy");
}

}  // namespace cscd::bench
