#include "bench/query/view/engine_recording.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include "bench/answer/answer_text.h"
#include "bench/inputs/thickness.h"
#include "bench/query/view/viewer_page.h"
#include "core/base/error.h"

namespace cscd::bench {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

// scripts/check wasm leaves the page in the build folder, and installing takes it to the prefix in whose bin/
// the program lies.
std::string page_beside_program() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const fs::path& folder : {program, program.parent_path()}) {
    std::ifstream file(folder / "share" / "cscd" / "engine_view.html", std::ios::binary);
    if (file) return {std::istreambuf_iterator<char>(file), {}};
  }
  return {};
}

void append(std::vector<double>& to, std::span<const Vec3> pose) {
  for (const Vec3& x : pose) to.insert(to.end(), {x.x(), x.y(), x.z()});
}

}  // namespace

std::string engine_page(const std::string& version) {
  std::string page = page_beside_program();
  const bool is_page = page.find(kDataPlace) != std::string::npos;
  if (!is_page || page.find("data-version=\"" + version + "\"") == std::string::npos)
    throw InputError(
        "--with-engine: " +
        std::string(is_page
                        ? "the share/cscd/engine_view.html beside this program is of another version"
                        : "there is no share/cscd/engine_view.html with the engine for WebAssembly beside "
                          "this program") +
        "; make it with `scripts/check wasm BUILD`, where BUILD is the folder that the program was built in, "
        "and install the program again if it was installed");
  return page;
}

void require_page_answers(const AnswerRequest& request) {
  const std::pair<bool, const char*> unknown[] = {
      {request.model.true_motion, "--true-motion"},
      {request.answers.first, "--first"},
      {request.new_contacts, "--new-contacts"},
      {!request.ignored.pairs.empty(), "--ignore"},
      {request.thickness.rings.value_or(0) > 0, "--exclude-rings"},
      {request.thickness.near_rest.number > 0, "--exclude-near-rest"}};
  for (const auto& [is_asked, option] : unknown)
    if (is_asked)
      throw InputError(std::string("--with-engine with ") + option +
                       ": the engine of a page is not asked this; leave out one of the two");
}

void EngineRecording::add(std::span<const Vec3> start, std::span<const Vec3> predicted_end) {
  append(starts_, start);
  append(ends_, predicted_end);
}

json EngineRecording::write(Sections& sections, const AnswerRequest& request) const {
  const Input& input = answer_.input;
  std::vector<double> rest;
  append(rest, input.rest());
  std::vector<std::int32_t> places;
  for (std::size_t t = 0; t < input.mesh.triangle_count(); ++t)
    places.push_back(answer_.names.place_number(TriangleId{static_cast<std::int32_t>(t)}));
  sections.add("exact.rest", rest);
  sections.add("exact.starts", starts_);
  sections.add("exact.ends", ends_);
  sections.add("exact.place_number", places);
  json parents = json::array();
  for (const BoneId parent : input.clip->header().bone_parent)
    parents.push_back(static_cast<std::int32_t>(parent));
  return {{"subject", subject_text(input)},
          {"one_pose", input.is_one_pose},
          {"rate", input.import ? json(rate_text(*input.import)) : json()},
          {"mean_edge", input.thickness.edge},
          {"bone_parent", std::move(parents)},
          {"asked",
           {{"thickness", request.thickness.thickness.text},
            {"neighbours", request.ignored.neighbours ? json(*request.ignored.neighbours) : json()}}}};
}

}  // namespace cscd::bench
