#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "bench/answer/answer_request.h"
#include "bench/answer/clip_answer.h"
#include "bench/query/view/sections.h"

namespace cscd::bench {

// The viewer's page with the engine for WebAssembly, without data. It is a file beside the program, because
// compilers for WebAssembly are optional and the engine would make the program a tenth larger. Throws
// InputError, saying how to make the file, where there is none, or one of another version than the program's.
std::string engine_page(const std::string& version);

// Throws InputError, naming the option, where the request says what the page's engine cannot be asked.
void require_page_answers(const AnswerRequest& request);

// Collects what the page's engine needs to answer a clip again: positions as exact as the program has them,
// and what the names of places do not tell of the surface.
class EngineRecording {
 public:
  // Bytes that a page takes for one vertex of one frame beside those of positions on the grid, counted
  // thrice, because they hardly compress.
  static std::size_t page_bytes(bool is_predicted) { return 3 * (is_predicted ? 48 : 24); }

  explicit EngineRecording(const ClipAnswer& answer) : answer_(answer) {}

  // Adds the next pose, and where the interval that begins there ends, unless that is the next pose. In
  // order.
  void add(std::span<const Vec3> start, std::span<const Vec3> predicted_end = {});

  // Adds the arrays, and returns what else the engine has to know. `request` says what was asked of the clip.
  nlohmann::json write(Sections& sections, const AnswerRequest& request) const;

 private:
  const ClipAnswer& answer_;
  std::vector<double> starts_, ends_;  // [poses, vertices, 3] and [intervals, vertices, 3]
};

}  // namespace cscd::bench
