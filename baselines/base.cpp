#include "baselines/base.h"

#include "core/detect/compose.h"
#include "core/detect/plain_culler.h"

namespace cscd {

Prepared make_base(const StrategyInput& setup) {
  return {compose(std::make_unique<PlainCuller<Kdop16>>(setup), setup), {}};
}

}  // namespace cscd
