#include "scenes/effects/keys.h"

#include <cmath>

#include "core/base/error.h"

namespace cscd::scenes {

Envelope Envelope::from(const Parameters& parameters) {
  Envelope envelope;
  envelope.start = parameters.number("start");
  if (parameters.has("end")) envelope.end = parameters.number("end");
  envelope.fade = parameters.number("fade");
  envelope.weight = parameters.number("weight");
  if (!(envelope.end > envelope.start))
    throw InputError(parameters.where() + ": parameter end must be above start");
  return envelope;
}

double Envelope::at(double frame) const {
  const auto faded = [&](double since) {
    if (since <= 0) return 0.0;
    if (since >= fade) return 1.0;
    const double t = since / fade;
    return t * t * (3 - 2 * t);
  };
  return weight * faded(frame - start) * faded(end - frame);
}

std::vector<ParameterRow> with_envelope(std::vector<ParameterRow> rows) {
  for (ParameterRow& row : std::vector<ParameterRow>{
           number_row("start", "frame", "frame before which the effect does nothing").or_else({0}),
           number_row("end", "frame",
                      "frame after which the effect does nothing; without it the effect goes on")
               .optional(),
           number_row("fade", "frame", "frames in which the effect comes, and in which it goes", {0, 1e9})
               .or_else({0}),
           number_row("weight", "", "factor on the whole effect").or_else({1})})
    rows.push_back(std::move(row));
  return rows;
}

}  // namespace cscd::scenes
