#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/mesh/vertex_paths.h"
#include "scenes/character/options.h"
#include "scenes/character/report.h"
#include "scenes/character/source_map.h"
#include "scenes/clip/clip.h"

namespace cscd::bench {

// How a model file is to be read, and with how much.
struct ModelOptions {
  scenes::ImportOptions import;
  std::size_t memory_mib = 4096;
  double seconds = 60;
  std::size_t answer_memory_mib = 8192;  // of this process, once the file has been read
  bool true_motion = false;              // the motion between frames is asked for, too
  bool operator==(const ModelOptions&) const = default;
};

// Instead of a clip's name: every clip of the file, one after the other. A clip that has this name can be
// chosen by its number.
inline constexpr char kAllClips[] = "all";

struct ImportedModel {
  std::unique_ptr<scenes::ClipSource> clip;
  scenes::ImportReport report;
  scenes::SourceMap sources;
  std::shared_ptr<const VertexPaths> motion = nullptr;  // where it is asked for
};

// Has cscd-import (beside this program) turn a model file into a temporary point cache, under limits, and
// opens that; the file is gone when the clip is. Throws InputError, in one line, for whatever goes wrong with
// the file or in the other process: a crash, too much time, too much memory.
ImportedModel import_model(const std::filesystem::path& path, const ModelOptions& options);

// When a frame is shown, in seconds after the clip's start; negative in the lead-in from the bind pose.
// `frames` is the number of all frames.
double second_of_frame(const scenes::ImportReport& report, std::size_t frame, std::size_t frames);

// The number, on the time line of the file, of the frame that is shown so many seconds after the start of the
// clip. A clip may start at any number. The lead-in is no part of that time line, and its numbers are
// negative.
double frame_at(const scenes::ImportReport& report, double seconds);

// Tells in a few lines which clip was read, and what was done to the surface.
std::string import_text(const scenes::ImportReport& report);
std::string surface_text(const scenes::ImportReport& report);
// "24 frames a second, as the file says".
std::string rate_text(const scenes::ImportReport& report);
// "clip 'walk' (3rd of 14 clips)"; empty where the file has no clips.
std::string clip_title(const scenes::ImportReport& report);
nlohmann::json import_json(const scenes::ImportReport& report);

}  // namespace cscd::bench
