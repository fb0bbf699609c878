#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

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
  bool operator==(const ModelOptions&) const = default;
};

// Instead of a clip's name: every clip of the file, one after the other. A clip that has this name can be
// chosen by its number.
inline constexpr char kAllClips[] = "all";

struct ImportedModel {
  std::unique_ptr<scenes::ClipSource> clip;
  scenes::ImportReport report;
  scenes::SourceMap sources;
};

// Has cscd-import (beside this program) turn a model file into a temporary point cache, under limits, and
// opens that; the file is gone when the clip is. Throws InputError, in one line, for whatever goes wrong with
// the file or in the other process: a crash, too much time, too much memory.
ImportedModel import_model(const std::filesystem::path& path, const ModelOptions& options);

// When a frame is shown, in seconds after the clip's start; negative in the lead-in from the bind pose.
// `frames` is the number of all frames.
double second_of_frame(const scenes::ImportReport& report, std::size_t frame, std::size_t frames);

// Tells in a few lines what was read from the file and what was done to it.
std::string import_text(const scenes::ImportReport& report);
nlohmann::json import_json(const scenes::ImportReport& report);

}  // namespace cscd::bench
