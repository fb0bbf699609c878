#include "baselines/embree/embree.h"

#if __has_include(<embree3/rtcore.h>)
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/thread_pool.h"
#include "core/detect/compose.h"
#include "core/hierarchy/package_box.h"

// Idea: a ray tracer's hierarchy, vectorised and with four children a node, as a user would take it for the
// broad phase. Every triangle is a user primitive with the swept box of its path.
//
// The manual says little about rtcCollide; the following was found by trying it. A scene with itself reports
// every pair in both orders, and no pair of a primitive with itself. Leaves hold several primitives, whose
// boxes are not compared with each other. So this strategy takes one order and compares the boxes itself. The
// manual does not say either that rtcCollide finds all pairs; the test compares its answer with all pairs of
// boxes. rtcCollide calls back with a processor mode that takes subnormal numbers for zero, so the callback
// computes nothing. A device that is told to use one thread limits all of oneTBB to one thread, our own pool
// included. So the device is not told, and its functions are called where there is only one thread.
//
// Fidelity: the package as it is. The boxes are those of the strategy `aabb`, rounded outward. Filter
// and elementary test follow as for all strategies. The package's counters are not accessible, so there
// is no number of overlap tests.
//
// Tuning: one thread; the hierarchy is built once in the reference pose and refitted at every interval, as
// all hierarchies here. On the rope that is much cheaper in all than building it anew.
//
// The claim that a dropped pair is apart rests on Embree's own code.
namespace cscd {
namespace {

// Embree takes a box that reaches farther for a mistake and leaves the box out.
constexpr float kFarthest = 1.8e18F;

class EmbreeCuller : public Culler {
 public:
  explicit EmbreeCuller(const StrategyInput& setup)
      : mesh_(setup.mesh), of_vertex_(mesh_.vertex_count()), box_(mesh_.triangle_count()) {
    device_ = rtcNewDevice("start_threads=0,set_affinity=0");
    if (device_ == nullptr)
      throw InputError("strategy embree: Embree has no device here (error " +
                       std::to_string(rtcGetDeviceError(nullptr)) +
                       "); choose another strategy, such as aabb");
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_DYNAMIC);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_LOW);  // lets the geometry's own quality count
    geometry_ = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryBuildQuality(geometry_, RTC_BUILD_QUALITY_REFIT);
    rtcSetGeometryUserPrimitiveCount(geometry_, static_cast<unsigned>(box_.size()));
    rtcSetGeometryUserData(geometry_, this);
    rtcSetGeometryBoundsFunction(geometry_, write_bounds, nullptr);
    rtcAttachGeometry(scene_, geometry_);
    refit({Motion(setup.reference, setup.reference)});
  }
  EmbreeCuller(const EmbreeCuller&) = delete;
  EmbreeCuller& operator=(const EmbreeCuller&) = delete;
  ~EmbreeCuller() override {
    rtcReleaseGeometry(geometry_);
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }

  bool keeps_all() const override { return true; }
  void refit(const Step& step) override {
    swept_vertex_bounds(step.motion, std::span(of_vertex_));
    for (std::size_t t = 0; t < box_.size(); ++t)
      box_[t] = swept_triangle<Aabb>(mesh_.triangles()[t], of_vertex_);
    on_this_thread([this] {
      rtcCommitGeometry(geometry_);
      rtcCommitScene(scene_);
    });
    require_success();
  }

  CullCounts cull(TrianglePairSink& sink) override {
    reported_.clear();
    on_this_thread([this] { rtcCollide(scene_, scene_, take_pairs, this); });
    require_success();
    for (const auto& [a, b] : reported_)
      if (overlap(box_[+a], box_[+b])) sink.add(a, b);
    CullCounts counts;
    counts.bvot.reset();
    return counts;
  }

 private:
  static void write_bounds(const RTCBoundsFunctionArguments* arguments) {
    const auto& culler = *static_cast<const EmbreeCuller*>(arguments->geometryUserPtr);
    const PackageBox box(culler.box_[arguments->primID], kFarthest);
    *arguments->bounds_o = {box.low[0], box.low[1], box.low[2], 0, box.high[0], box.high[1], box.high[2], 0};
  }
  static void take_pairs(void* self, RTCCollision* pairs, unsigned count) {
    auto& culler = *static_cast<EmbreeCuller*>(self);
    for (const RTCCollision& pair : std::span(pairs, count))
      if (pair.primID0 < pair.primID1)
        culler.reported_.push_back({TriangleId{static_cast<std::int32_t>(pair.primID0)},
                                    TriangleId{static_cast<std::int32_t>(pair.primID1)}});
  }
  // Throws if a call of Embree has failed. Embree catches what is thrown in its calls
  // but remembers that something was.
  void require_success() {
    if (const RTCError error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE)
      throw std::runtime_error("strategy embree: Embree failed (error " + std::to_string(error) + ")");
  }

  const TriangleMesh& mesh_;
  std::vector<Aabb> of_vertex_, box_;  // [vertices], [triangles]
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
  RTCGeometry geometry_ = nullptr;
  std::vector<TrianglePair> reported_;  // in one order; their boxes are not yet compared
};

}  // namespace

Prepared make_embree(const StrategyInput& setup) {
  return {compose(std::make_unique<EmbreeCuller>(setup), setup, {.owners = true}), {}};
}

}  // namespace cscd
