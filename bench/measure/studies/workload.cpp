#include "bench/measure/studies/workload.h"

#include <algorithm>
#include <fstream>
#include <map>

#include "bench/inputs/input.h"
#include "bench/strategies/catalogue.h"
#include "core/base/error.h"
#include "core/base/split.h"
#include "scenes/hard/disturbance.h"

namespace cscd::bench {
namespace {

constexpr Kind kKinds[] = {Kind::vertex_face, Kind::edge_edge};

// Where the elementary test that records what it is asked puts it, null for the kind that is not wanted: a
// row's functions carry no state.
thread_local std::vector<Question>* g_vertex_face = nullptr;
thread_local std::vector<Question>* g_edge_edge = nullptr;

constexpr ElementaryTest kRecorder{
    "recorder",
    "keeps what it is asked",
    false,
    false,
    one_by_one<[](const MovingVertexFace& q) -> Answer {
      if (g_vertex_face) g_vertex_face->push_back({{{q.vertex, q.corner[0], q.corner[1], q.corner[2]}, {}}});
      return {Verdict::apart, 0};
    }>,
    one_by_one<[](const MovingEdgeEdge& q) -> Answer {
      if (g_edge_edge) g_edge_edge->push_back({{{q.first[0], q.first[1], q.second[0], q.second[1]}, {}}});
      return {Verdict::apart, 0};
    }>};

// A scene's pairs of one kind, interval by interval.
class ScenePairs {
 public:
  ScenePairs(const std::string& scene, Kind kind, std::size_t every, std::size_t most)
      : input_(open_input(scene)), kind_(kind), every_(every), left_(most) {
    detector_ = complete_reference().make(input_.setup(kRecorder)).detector;
  }
  void next(std::vector<Question>& block) {
    while (waiting_.empty() && left_ > 0 && interval_ < input_.clip->interval_count()) load();
    const std::size_t count = std::min({kBlock, waiting_.size(), left_});
    block.assign(waiting_.end() - static_cast<std::ptrdiff_t>(count), waiting_.end());
    waiting_.resize(waiting_.size() - count);
    left_ -= count;
  }

 private:
  void load() {
    const scenes::ClipInterval interval = input_.clip->load(interval_);
    g_vertex_face = kind_ == Kind::vertex_face ? &waiting_ : nullptr;
    g_edge_edge = kind_ == Kind::edge_edge ? &waiting_ : nullptr;
    ContactSet found;
    detector_->detect({interval.motion, interval.bones ? &*interval.bones : nullptr}, found);
    interval_ += every_;
  }

  Input input_;
  Kind kind_;
  std::size_t every_, left_, interval_ = 0;
  std::unique_ptr<Detector> detector_;
  std::vector<Question> waiting_;
};

Question question(const Query& query) {
  return {query};
}
Question question(const scenes::hard::CloseQuery& close) {
  return {close.query, close.r};
}

// The next block of queries that a function makes by number.
template <class Make>
auto numbered(std::size_t count, const Make& make) {
  return [count, make, i = std::size_t{0}](std::vector<Question>& block) mutable {
    block.clear();
    for (const std::size_t last = std::min(count, i + kBlock); i < last; ++i)
      block.push_back(question(make(i)));
  };
}

}  // namespace

std::vector<Workload> scene_workloads(const std::string& scene, std::size_t every, std::size_t most) {
  std::vector<Workload> workloads;
  for (const Kind kind : kKinds)
    // Each kind replays the scene: millions of pairs of the other kind need not wait in memory.
    workloads.push_back({"scenes",
                         scene,
                         kind,
                         {},
                         [scene, every, most, kind,
                          pairs = std::shared_ptr<ScenePairs>()](std::vector<Question>& block) mutable {
                           if (!pairs) pairs = std::make_shared<ScenePairs>(scene, kind, every, most);
                           pairs->next(block);
                         }});
  return workloads;
}

std::vector<Workload> open_workloads(const std::filesystem::path& set, std::size_t most) {
  std::ifstream index(set / "index.csv");
  if (!index) throw InputError((set / "index.csv").string() + ": cannot be read; name the folder of the set");
  std::map<std::pair<std::string, Kind>, std::shared_ptr<std::vector<Query>>> groups;
  std::map<std::string, std::vector<Query>> files;
  std::string line;
  std::getline(index, line);  // the names of the columns
  while (std::getline(index, line)) {
    const std::vector<std::string> cells = split(line, ',');
    if (cells.size() < 7)
      throw InputError((set / "index.csv").string() +
                       ": a line has fewer than 7 columns; fetch the set anew");
    const Kind kind = cells[3] == "vf" ? Kind::vertex_face : Kind::edge_edge;
    auto& group = groups[{cells[2], kind}];
    if (!group) group = std::make_shared<std::vector<Query>>();
    if (group->size() >= most) continue;
    if (!files.contains(cells[0])) files[cells[0]] = read_queries(set / cells[0]);
    const auto& file = files[cells[0]];
    const std::size_t row = std::stoul(cells[1]);
    if (row >= file.size())
      throw InputError((set / "index.csv").string() + ": names query " + cells[1] + " of " + cells[0] +
                       ", which has fewer; fetch the set anew");
    group->push_back(file[row]);
    group->back().truth = cells[6] == "1";
  }
  std::vector<Workload> workloads;
  for (const auto& [key, queries] : groups)
    workloads.push_back(
        {"open", key.first, key.second, {}, numbered(queries->size(), [queries = queries](std::size_t i) {
           return (*queries)[i];
         })});
  return workloads;
}

std::vector<Workload> hard_workloads(std::size_t count, std::uint64_t seed) {
  std::vector<Workload> workloads;
  for (const scenes::hard::Family& family : scenes::hard::families())
    for (const Kind kind : kKinds)
      workloads.push_back({"hard", std::string(family.name), kind, {}, numbered(count, [=](std::size_t i) {
                             return scenes::hard::suite_query(family, kind, i, seed);
                           })});
  return workloads;
}

std::vector<Workload> close_workloads(std::size_t count, std::uint64_t seed) {
  std::vector<Workload> workloads;
  for (const scenes::hard::CloseFamily& family : scenes::hard::close_families())
    for (const Kind kind : kKinds)
      workloads.push_back({"close", std::string(family.name), kind, {}, numbered(count, [=](std::size_t i) {
                             return scenes::hard::close_suite_query(family, kind, i, seed);
                           })});
  return workloads;
}

std::vector<Workload> random_workloads(const std::vector<double>& hardnesses, std::size_t count,
                                       std::uint64_t seed) {
  std::vector<Workload> workloads;
  for (const double hardness : hardnesses)
    for (const scenes::hard::Family& family : scenes::hard::families())
      for (const Kind kind : kKinds)
        workloads.push_back(
            {"random", std::string(family.name), kind, hardness, numbered(count, [=](std::size_t i) {
               return scenes::hard::random_query(family, kind, hardness, i, seed);
             })});
  return workloads;
}

}  // namespace cscd::bench
