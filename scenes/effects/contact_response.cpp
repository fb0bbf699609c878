#include "scenes/effects/contact_response.h"

#include "core/base/error.h"
#include "core/detect/compose.h"
#include "core/detect/plain_culler.h"
#include "core/detect/start/embedding.h"
#include "core/drvbc/drvbc.h"
#include "core/elementary/catalogue.h"
#include "scenes/effects/contact_step.h"
#include "scenes/effects/effect.h"

namespace cscd::scenes {
namespace {

// Keeps the animated surface from running into itself. The previous effects of the scene make the target,
// to which the surface is drawn. The surface itself starts at the end of its last step. The predicted end
// of a step follows the motion of the target and goes a part of the way back to the target:
//   predicted = target at the end + (1 - pull) (surface - target) at the start.
// A detector is asked about the step to the prediction, so the contacts are real. The next frame is the
// corrected end.
class ContactResponse final : public Effect {
 public:
  ContactResponse(const Parameters& p, const Shape& shape, const MakeDetector& first)
      : where_(p.where()),
        pull_(p.number("pull")),
        mesh_(shape.triangles, shape.positions.size(), p.where()),
        setup_{mesh_, shape.positions, shape.rig.parent.empty() ? nullptr : &shape.rig,
               *find_elementary_test("filtered_exact")},
        embedding_(mesh_, shape.positions),
        step_(mesh_, shape.positions, first(setup_),
              compose(std::make_unique<PlainCuller<Kdop16>>(setup_), setup_, {.relative_boxes = true}),
              options(p)),
        surface_(shape.positions),
        target_(shape.positions),
        bones_(shape.rig.reference) {
    require_embedded("frame 0");
  }

  void step(SceneState& state) override {
    predicted_.resize(surface_.size());
    for (std::size_t v = 0; v < surface_.size(); ++v)
      predicted_[v] = state.positions[v] + (1 - pull_) * (surface_[v] - target_[v]);
    target_ = state.positions;
    end_ = predicted_;
    step_.resolve(surface_, end_, {bones_, state.bones});
    surface_ = end_;
    bones_ = state.bones;
    require_embedded("frame " + std::to_string(static_cast<int>(state.time)));
    state.positions = surface_;
    state.predicted = predicted_;
  }

 private:
  static ContactStepOptions options(const Parameters& p) {
    ContactStepOptions options;
    options.push = p.number("push");
    options.spread = p.number("spread");
    options.back_off = p.number("back_off");
    options.rounds = p.integer("rounds");
    return options;
  }
  void require_embedded(const std::string& frame) {
    if (const auto found = embedding_.find_intersection(surface_))
      throw InputError(
          where_ + ": " + frame + ": triangles " + std::to_string(+found->first) + " and " +
          std::to_string(+found->second) +
          " meet, so the next step has no embedded start; mend the shape at rest, or what detects "
          "contacts");
  }

  std::string where_;
  double pull_;
  TriangleMesh mesh_;
  StrategyInput setup_;
  EmbeddingTest embedding_;
  ContactStep step_;
  std::vector<Vec3> surface_, target_, predicted_, end_;
  std::vector<Bone> bones_;
};

const ParameterRow kRows[] = {
    number_row("pull", "", "share of the way back to the animation that a step tries to make up for", {0, 1})
        .or_else({0.3}),
    number_row("push", "mean edge", "gap that is left at a contact", {0, 1e3})
        .or_else({ContactStepOptions{}.push}),
    number_row("spread", "mean edge", "how far along the surface a contact is felt", {1e-3, 1e6})
        .or_else({ContactStepOptions{}.spread}),
    number_row("back_off", "", "share of the time before contact that a step keeps if it is cut as a whole",
               {0.01, 0.99})
        .or_else({ContactStepOptions{}.back_off}),
    integer_row("rounds", "", "corrections of a step before it is cut as a whole", {0, 100})
        .or_else({double(ContactStepOptions{}.rounds)}),
};

}  // namespace

std::unique_ptr<Effect> make_contact_response(const Parameters& parameters, const Shape& shape,
                                              const MakeDetector& first) {
  return std::make_unique<ContactResponse>(parameters, shape, first);
}

EffectRow contact_response_row() {
  return {"contact_response",
          "keeps the surface off itself as a simulator does: detects contacts of the predicted step, cuts it "
          "short, "
          "pushes apart",
          Pace::frame,
          kRows,
          [](const Parameters& parameters, const Shape& shape) -> std::unique_ptr<Effect> {
            // A scene's frames must not change with the reading of the paper that the strategy `drvbc`
            // follows.
            return make_contact_response(
                parameters, shape, [](const StrategyInput& setup) -> std::unique_ptr<Detector> {
                  if (!setup.rig || !setup.mesh.closed_and_oriented())
                    return compose(std::make_unique<PlainCuller<Kdop16>>(setup), setup,
                                   {.relative_boxes = true});
                  return make_drvbc(setup, {.division = radial::Division::none}).detector;
                });
          },
          true};
}

}  // namespace cscd::scenes
