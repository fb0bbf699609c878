#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/command_line/written_length.h"
#include "bench/inputs/import.h"
#include "bench/inputs/outside_truth.h"
#include "core/detect/exclusions.h"
#include "core/detect/step.h"
#include "core/detect/strategy.h"
#include "core/detect/thickness.h"
#include "core/mesh/rig.h"
#include "core/mesh/triangle_mesh.h"
#include "scenes/clip/clip.h"

namespace cscd::bench {

// What a user asks to be ignored.
struct IgnoreRequest {
  // Each is "A:B". A and B name bones, parts or meshes, and * in them stands for any letters. Names may hold
  // colons, as long as one way alone to cut the text gives two names that the input has.
  std::vector<std::string> pairs = {};
  std::optional<int> neighbours = {};  // bones that are at most so many joints apart
};

// The same for one input.
struct Ignored {
  IgnoreRequest asked;
  std::vector<std::pair<std::string, std::string>> names;  // the pairs that are asked, cut in two
  Exclusions triangles;                                    // the pairs of triangles that all this comes to
};

// How near features may come before they count, and which pairs are left out because they are near by
// construction: as a user asks for it.
struct ThicknessRequest {
  WrittenLength thickness = {};
  std::optional<int> rings = {};  // vertices that at most so many edges join do not collide
  WrittenLength near_rest = {};   // nor do vertices that are nearer than this at rest

  bool leaves_out() const { return rings.value_or(0) > 0 || near_rest.number > 0; }
};

// The same for one input.
struct InputThickness {
  ThicknessRequest asked = {};
  double edge = 0;                                       // mean length of an edge at rest
  double length = 0;                                     // of the thickness; 0 where touching alone counts
  std::shared_ptr<const Exclusions> left_out = nullptr;  // null where nothing is

  Thickness thickness() const { return Thickness(length); }
};

// Which axis of an input points up, for whoever looks at it. No answer depends on it.
struct Up {
  std::string axis = "y";    // one of scenes::kUpAxes
  std::string because = {};  // who says so, as in "z, because the file says so"; empty where nothing does
};

// The input of a command: a scene, given by its name, or a point cache or model file, given by its path.
struct Input {
  std::string name;
  std::unique_ptr<scenes::ClipSource> clip;
  TriangleMesh mesh;
  std::vector<Vec3> reference;  // positions of frame 0
  std::optional<Rig> rig;
  std::optional<scenes::ImportReport> import = std::nullopt;  // of a model file
  std::optional<scenes::SourceMap> sources = std::nullopt;    // of a model file
  // How the vertices of a model file move between frames; null where that is not asked for.
  std::shared_ptr<const VertexPaths> motion = nullptr;
  bool clip_was_named = true;                 // else it is the first clip that moves
  bool is_one_pose = false;                   // nothing moves: all frames are this pose
  int threads = 1;                            // for whatever can use them
  std::vector<std::byte> preparation = {};    // of an earlier run; empty for none
  std::vector<std::string> bone_names = {};   // [bones], of a scene or a model file that names them, or none
  std::vector<std::string> cloth_names = {};  // of the last components, which no bone carries
  Up up = {};
  std::shared_ptr<const Ignored> ignored = nullptr;     // null where nothing is
  std::shared_ptr<const OutsideTruth> truth = nullptr;  // null where none is to be held against
  InputThickness thickness = {};

  // In which crossing triangles are how the surface is made: the clip's pose at rest, or else frame 0.
  std::span<const Vec3> rest() const {
    const std::vector<Vec3>& named = clip->header().rest;
    return named.empty() ? std::span<const Vec3>(reference) : std::span<const Vec3>(named);
  }

  // An interval as a detector is asked about it.
  Step step(const scenes::ClipInterval& interval) const {
    return {.motion = interval.motion,
            .bones = interval.bones ? &*interval.bones : nullptr,
            .thickness = thickness.thickness()};
  }

  StrategyInput setup(const ElementaryTest& elementary, bool first_only = false,
                      Pipeline pipeline = Pipeline::vectorised) const {
    return {mesh,       reference,  rig ? &*rig : nullptr,    elementary,
            threads,    first_only, thickness.left_out.get(), pipeline,
            preparation};
  }
};

// Throws InputError. Generates a scene whose cache is missing; imports a model file. Options are for model
// files only.
Input open_input(const std::string& name_or_path, const ModelOptions& options = {});

// Calls `work`, which is about an input, and lets its InputErrors begin with that input's name. Want of
// memory becomes such an error.
void name_input(const std::string& name, const std::function<void()>& work);

// Says what was made of a model file, a few lines, and which of its clips this is; nothing of other inputs.
void say_what_was_read(const Input& input, std::FILE* to);

// Is it the path of a file that has to be imported, rather than a point cache or the name of a scene?
bool is_model_file(const std::string& name_or_path);
bool is_point_cache(const std::filesystem::path& path);
// The last part of a path, by which sentences name an input; of "." and "frames/" too.
std::string short_name(const std::string& name_or_path);

// Half-open range of intervals.
struct IntervalRange {
  std::size_t first, last;
};
// "A:B" stands for the intervals between frames A and B, by the numbers that frame_number() gives; either may
// be left out. Throws InputError.
IntervalRange parse_frames(const std::string& text, const Input& input);
// Returns the text that parse_frames() reads back as the range.
std::string frames_text(const IntervalRange& range, const Input& input);
// Returns the number by which people know a frame: of a model file, that of the file's own time line (see
// frame_at); of other inputs, the index.
double frame_number(const Input& input, std::size_t frame);

// Whether the input has what a strategy needs.
bool allows(const Input& input, const Strategy& strategy);

// What answers where no strategy is named: a row that promises the first contact alone if `first` says that
// no other is asked for, otherwise one that promises all of them. The last such row without a group that the
// input allows, or else the complete fallback, as where pairs are left out by InputThickness.
const Strategy& default_strategy(const Input& input, bool first);

}  // namespace cscd::bench
