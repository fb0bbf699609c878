#include "bench/query/input/up.h"

namespace cscd::bench {

Up up_of(const scenes::Scene& scene) {
  if (!scene.up.empty()) return {scene.up, "the scene file says so"};
  for (const scenes::EffectCall& effect : scene.effects) {
    if (!effect.parameters.has("gravity")) continue;
    const Vec3 gravity = effect.parameters.vector("gravity");
    int axis = 0;
    if (gravity.cwiseAbs().maxCoeff(&axis) == 0) continue;
    return {std::string(gravity[axis] < 0 ? "" : "-") + "xyz"[axis], "things fall the other way"};
  }
  return {};
}

Up up_of(const scenes::ImportReport& report) {
  if (report.up.empty()) return {};
  if (report.format == "glTF 2") return {report.up, "glTF files have it so"};
  return {report.up, report.format == "Collada" ? "Collada files are turned so" : "the file says so"};
}

Up up_of(const scenes::ClipHeader& header) {
  if (header.up.empty()) return {};
  return {header.up, "the file says so"};
}

}  // namespace cscd::bench
