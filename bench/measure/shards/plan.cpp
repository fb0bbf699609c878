#include "bench/measure/shards/plan.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "bench/cli/output/schema.h"
#include "core/base/error.h"
#include "scenes/clip/digest.h"

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

constexpr const char* kKinds[] = {"counts", "timings"};

const char* to_string(ReplayKind kind) {
  return kKinds[kind == ReplayKind::timings];
}

template <class T>
void append_bytes(const std::vector<T>& values, std::string& bytes) {
  bytes += std::to_string(values.size()) + ":";
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

std::string surface_digest(const Input& input) {
  const scenes::ClipHeader& header = input.clip->header();
  std::string bytes = std::to_string(input.clip->frame_count()) + (header.predicted ? " predicted " : " ");
  append_bytes(header.triangles, bytes);
  append_bytes(header.bone_parent, bytes);
  append_bytes(header.rest, bytes);
  return scenes::digest(bytes);
}

ordered_json to_json(const ReplayRequest& request) {
  return {{"scene", request.scene},
          {"strategies", request.strategies},
          {"elementary", request.elementary},
          {"pipeline", request.pipeline},
          {"frames", request.frames},
          {"repetitions", request.repetitions},
          {"count_every", request.count_every},
          {"time_every", request.time_every},
          {"time_contacts", request.time_contacts},
          {"verify_every", request.verify_every},
          {"seed", request.seed},
          {"threads", request.threads},
          {"model",
           {{"import", scenes::to_arguments(request.model.import)},
            {"import_memory_mib", request.model.memory_mib},
            {"import_seconds", request.model.seconds},
            {"memory_mib", request.model.answer_memory_mib}}}};
}

ReplayRequest request_from(const ordered_json& json) {
  ReplayRequest request;
  request.scene = json.at("scene");
  request.strategies = json.at("strategies").get<std::vector<std::string>>();
  request.elementary = json.at("elementary");
  request.pipeline = json.at("pipeline");
  request.frames = json.at("frames");
  request.repetitions = json.at("repetitions");
  request.count_every = json.at("count_every");
  request.time_every = json.at("time_every");
  request.time_contacts = json.at("time_contacts");
  request.verify_every = json.at("verify_every");
  request.seed = json.at("seed");
  request.threads = json.at("threads");
  const ordered_json& model = json.at("model");
  request.model.import = scenes::parse_arguments(model.at("import").get<std::vector<std::string>>());
  request.model.memory_mib = model.at("import_memory_mib");
  request.model.seconds = model.at("import_seconds");
  request.model.answer_memory_mib = model.at("memory_mib");
  return request;
}

ordered_json to_json(const ChosenIntervals& intervals) {
  return {{"frames", {intervals.range.first, intervals.range.last}},
          {"counted", intervals.counted},
          {"verified", intervals.verified},
          {"timed", intervals.timed}};
}

ChosenIntervals intervals_from(const ordered_json& json) {
  const auto list = [&](const char* key) { return json.at(key).get<std::vector<std::size_t>>(); };
  return {
      {json.at("frames").at(0), json.at("frames").at(1)}, list("verified"), list("counted"), list("timed")};
}

std::vector<std::size_t> within(const std::vector<std::size_t>& ascending, const IntervalRange& range) {
  return {std::ranges::lower_bound(ascending, range.first), std::ranges::lower_bound(ascending, range.last)};
}

std::string id_of(const Plan& plan, const ChosenIntervals& intervals) {
  const ReplayRequest& request = plan.replay.request;
  return scenes::digest(ordered_json{
      {"frames", plan.frames_digest},
      {"surface", plan.surface_digest},
      {"strategies", request.strategies},
      {"elementary", request.elementary},
      {"pipeline", request.pipeline},
      {"repetitions", request.repetitions},
      {"seed", request.seed},
      {"threads", request.threads},
      {"kind", to_string(plan.replay.kind)},
      {"intervals", to_json(intervals)},
      {"code", plan.code}}.dump());
}

Plan plan_from(const ordered_json& json) {
  Plan plan;
  plan.code = json.at("code");
  plan.frames_digest = json.at("input").at("frames");
  plan.surface_digest = json.at("input").at("surface");
  const bool with_times = json.at("kind") == kKinds[1];
  plan.replay = {with_times ? ReplayKind::timings : ReplayKind::counts, request_from(json.at("run")),
                 json.at("command").get<std::vector<std::string>>(), intervals_from(json.at("intervals"))};
  for (const ordered_json& cell : json.at("cells"))
    plan.cells.push_back({cell.at("id"), intervals_from(cell)});
  for (const PlanCell& cell : plan.cells)
    if (cell.id != id_of(plan, cell.intervals))
      throw InputError("cell " + cell.id + " is not what its id says");
  return plan;
}

}  // namespace

Plan make_plan(Input& input, Replay replay, std::size_t cell_intervals, ordered_json code) {
  Plan plan{std::move(replay), std::move(code), {}, surface_digest(input), {}};
  scenes::DigestSink frames;
  scenes::copy_frames(*input.clip, frames);
  plan.frames_digest = frames.text();
  const ChosenIntervals& all = plan.replay.intervals;
  for (std::size_t first = all.range.first; first < all.range.last; first += cell_intervals) {
    const IntervalRange range{first, std::min(first + cell_intervals, all.range.last)};
    ChosenIntervals part{range, within(all.verified, range), within(all.counted, range),
                         within(all.timed, range)};
    if (part.counted.empty()) continue;
    std::string id = id_of(plan, part);
    plan.cells.push_back({std::move(id), std::move(part)});
  }
  return plan;
}

ordered_json to_json(const Plan& plan) {
  ordered_json cells = ordered_json::array();
  for (const PlanCell& cell : plan.cells) {
    ordered_json row = {{"id", cell.id}};
    row.update(to_json(cell.intervals));
    cells.push_back(std::move(row));
  }
  return {{"schema", kPlanSchema},
          {"code", plan.code},
          {"kind", to_string(plan.replay.kind)},
          {"input", {{"frames", plan.frames_digest}, {"surface", plan.surface_digest}}},
          {"command", plan.replay.command},
          {"run", to_json(plan.replay.request)},
          {"intervals", to_json(plan.replay.intervals)},
          {"cells", std::move(cells)}};
}

Plan read_plan(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf()))
    throw InputError("plan " + path.string() + ": cannot be read; name a file that `cscd plan` wrote");
  try {
    const ordered_json json = ordered_json::parse(text.str());
    if (const std::string violation = schema_violation(json, "plan.schema.json"); !violation.empty())
      throw InputError("does not follow its schema at " + violation);
    return plan_from(json);
  } catch (const nlohmann::json::exception& error) {
    throw InputError("plan " + path.string() + ": is not what `cscd plan` writes (" + error.what() + ")");
  } catch (const InputError& error) {
    throw InputError("plan " + path.string() + ": " + error.what() + "; make it anew with `cscd plan`");
  }
}

std::string plan_id(const Plan& plan) {
  std::string ids;
  for (const PlanCell& cell : plan.cells) ids += cell.id;
  return scenes::digest(ids);
}

std::string frames_text(const PlanCell& cell) {
  return "frames " + std::to_string(cell.intervals.range.first) + ":" +
         std::to_string(cell.intervals.range.last);
}

std::string result_name(const PlanCell& cell) {
  return cell.id + ".json.gz";
}

Input open_input_of(const Plan& plan) {
  const ReplayRequest& request = plan.replay.request;
  Input input = open_input(request.scene, request.model);
  if (surface_digest(input) != plan.surface_digest)
    throw InputError("input " + request.scene +
                     ": is not what the plan was made for; make the plan anew with `cscd plan`");
  return input;
}

}  // namespace cscd::bench
