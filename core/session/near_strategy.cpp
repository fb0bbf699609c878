#include "core/session/near_strategy.h"

#include <optional>

#include "core/base/stopwatch.h"
#include "core/fast/drvbc_fast.h"
#include "core/session/near_pairs.h"

namespace cscd {
namespace {

class NearDetector : public Detector {
 public:
  NearDetector(const StrategyInput& setup, std::unique_ptr<Detector> complete)
      : setup_(setup), complete_(std::move(complete)) {}

  Report detect(const Step& step, ContactSet& out) override {
    const Stopwatch looking;
    const bool is_near = list_covers(step);
    const double looked_ms = looking.milliseconds();
    Report report = (is_near ? *answers_near_ : *complete_).detect(step, out);
    if (!is_near) near_->note_work(report.cull);
    report.ms.refit += looked_ms;  // it looks at all positions, as a refit does
    return report;
  }
  void forget() override {
    near_.reset();
    complete_->forget();
  }
  std::vector<std::byte> saved_preparation() const override { return complete_->saved_preparation(); }

 private:
  bool list_covers(const Step& step) {
    if (!near_ || step.thickness.largest() != thickness_) {
      thickness_ = step.thickness.largest();
      near_.emplace(setup_.mesh, setup_.reference, step.thickness);
      answers_near_ = make_near_detector(*near_, setup_);
    }
    return near_->covers(step.motion, [&] { return complete_.get(); });
  }

  StrategyInput setup_;
  std::unique_ptr<Detector> complete_;
  double thickness_ = 0;  // that the list is for
  std::optional<NearPairs> near_;
  std::unique_ptr<Detector> answers_near_;
};

}  // namespace

Prepared make_drvbc_fast_near(const StrategyInput& setup) {
  Prepared out = kDrvbcFastComplete.make(setup);
  out.detector = std::make_unique<NearDetector>(setup, std::move(out.detector));
  return out;
}

}  // namespace cscd
