#include "core/base/pipeline.h"

#include <string>

#include "core/base/error.h"

namespace cscd {

Pipeline pipeline_named(std::string_view name) {
  for (const Pipeline pipeline : {Pipeline::vectorised, Pipeline::published})
    if (to_string(pipeline) == name) return pipeline;
  throw InputError("pipeline '" + std::string(name) + "' is not known; choose one of today, published");
}

}  // namespace cscd
