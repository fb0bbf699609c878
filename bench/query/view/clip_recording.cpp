#include "bench/query/view/clip_recording.h"

#include <span>
#include <string>

#include "bench/answer/clip_answer.h"
#include "core/base/error.h"

namespace cscd::bench {
namespace {

using nlohmann::json;

// Of positions before compression. Browsers hold a page in one text, whose length they limit.
constexpr std::size_t kMostBytes = std::size_t{700} << 20;
constexpr double kScenesFps = 30;  // at which clips that tell no rate are played

}  // namespace

void require_page_room(std::size_t frames, std::size_t vertices, std::size_t more_bytes,
                       const std::string& what, const std::string& remedy) {
  const std::size_t most = kMostBytes / ((6 + more_bytes) * vertices);
  if (frames > most)
    throw InputError(what + " of " + std::to_string(frames) + " frames of " + std::to_string(vertices) +
                     " vertices is more than a browser opens; choose up to " + std::to_string(most) +
                     " frames " + remedy);
}

ClipRecording::ClipRecording(const Input& input, const IntervalRange& range, std::size_t more_bytes)
    : input_(input), range_(range) {
  require_page_room(range.last - range.first + 1, input.mesh.vertex_count(), more_bytes,
                    input.name + ": a page", "with --frames A:B");
  for (std::size_t f = range.first; f <= range.last; ++f) {
    grid_.include(input.clip->load_frame(f).positions);
    if (input.clip->header().predicted && f < range.last) grid_.include(input.clip->load(f).motion.end());
  }
}

void ClipRecording::add_frame(const scenes::ClipInterval& interval) {
  frames_.append(interval.motion.start());
  for (const Bone& bone : interval.bones ? interval.bones->start : std::span<const Bone>())
    for (const Vec3& x : {bone.head, bone.tail})
      for (int axis = 0; axis < 3; ++axis) bones_.push_back(static_cast<float>(x[axis]));
  ++added_;
}

void ClipRecording::add_other_end(std::span<const Vec3> end) {
  interval_of_end_.push_back(static_cast<std::uint32_t>(added_ - 1));
  ends_.append(end);
}

json ClipRecording::write(Sections& sections) const {
  const TriangleMesh& mesh = input_.mesh;
  std::vector<std::uint32_t> corners;
  for (const Triangle& triangle : mesh.triangles())
    for (const VertexId v : triangle) corners.push_back(static_cast<std::uint32_t>(v));
  sections.add("corners", corners);
  sections.add("positions", frames_.bytes());
  sections.add("predicted_ends", ends_.bytes());
  sections.add("interval_of_end", interval_of_end_);
  sections.add("bones", bones_);

  json numbers = json::array(), seconds = json::array();
  for (std::size_t f = range_.first; f <= range_.last; ++f) {
    const bool last = f == range_.last;
    const ClipMoment moment{last ? f - 1 : f, last ? 1.0 : 0.0};
    numbers.push_back(frame_of(input_, moment));
    if (input_.import) seconds.push_back(*second_of(input_, moment));
  }
  const Vec3 origin = grid_.origin();
  return {{"frames", added_},
          {"first_interval", range_.first},
          {"all_intervals", input_.clip->interval_count()},
          {"vertices", mesh.vertex_count()},
          {"triangles", mesh.triangle_count()},
          {"bones", input_.clip->header().bone_parent.size()},
          {"fps", input_.import ? input_.import->fps : kScenesFps},
          {"first_frame", input_.import ? frame_at(*input_.import, 0) : 0},
          {"frame_number", std::move(numbers)},
          {"seconds", input_.import ? std::move(seconds) : json()},
          {"grid", {{"origin", {origin.x(), origin.y(), origin.z()}}, {"step", grid_.step()}}}};
}

}  // namespace cscd::bench
