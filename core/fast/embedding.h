#pragma once

#include "core/detect/start/embedding.h"
#include "core/detect/strategy.h"

namespace cscd {

// Prepares the exact test whether a pose is embedded, culled as `drvbc_fast_complete` culls. It takes any
// mesh. The test uses as many threads as the set-up asks for. The mesh of the set-up must outlive the test.
EmbeddingTest make_embedding_test(const Setup& setup);

}  // namespace cscd
