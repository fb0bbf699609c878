#include "bench/measure/shards/cell_run.h"

#include <cerrno>

#include "bench/cli/output/gzip.h"
#include "bench/cli/output/json_text.h"
#include "core/base/error.h"
#include "scenes/base/output_target.h"

namespace cscd::bench {
namespace {

// The file exists for the moment of writing only, so that a process that is killed seldom leaves one behind.
void write_unless_there(const std::filesystem::path& path, const std::string& content) {
  try {
    UnfinishedFile file(path, false);
    file.write(content);
    file.finish();
  } catch (const OutputError& error) {
    if (error.reason != EEXIST) throw;
  }
}

}  // namespace

bool run_cell(const Plan& plan, const PlanCell& cell, const std::filesystem::path& folder) {
  const std::filesystem::path result = folder / result_name(cell);
  if (std::filesystem::exists(result)) return read_record(result).verification.ok();
  Input input = open_input_of(plan);
  Replay part = plan.replay;
  part.intervals = cell.intervals;
  const Record record = execute(input, part);
  if (record.scene.digest != plan.frames_digest)
    throw InputError("input " + input.name +
                     ": its frames are not those that the plan was made for; make it anew with `cscd plan`");
  write_unless_there(result, gzipped(json_text(to_json(record))));
  return record.verification.ok();
}

}  // namespace cscd::bench
