#pragma once

#include <string>

#include "scenes/catalog/scene.h"
#include "scenes/character/report.h"
#include "scenes/clip/clip.h"

namespace cscd::bench {

// Which axis of an input points up, for whoever looks at it. No answer depends on it.
struct Up {
  std::string axis = "y";    // one of scenes::kUpAxes
  std::string because = {};  // who says so, as in "z, because the file says so"; empty where nothing does
};

// What a scene, a model file or a point cache says. A scene in which things fall says it by its gravity,
// unless its file has a member `up`.
Up up_of(const scenes::Scene& scene);
Up up_of(const scenes::ImportReport& report);
Up up_of(const scenes::ClipHeader& header);

}  // namespace cscd::bench
