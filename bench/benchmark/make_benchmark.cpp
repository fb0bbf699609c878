#include <algorithm>
#include <map>
#include <memory>

#include "bench/benchmark/benchmark.h"
#include "bench/output/json_text.h"
#include "bench/output/output.h"
#include "bench/output/sha256.h"
#include "core/base/error.h"
#include "scenes/catalog/scene.h"
#include "scenes/random/random_interval.h"

namespace cscd::bench {
namespace {

namespace fs = std::filesystem;
namespace hard = scenes::hard;
using nlohmann::ordered_json;

// The parts of a hundred that each set has of the intervals of small meshes.
constexpr std::size_t kRandomShare = 40, kTornShare = 15, kHardShare = 33;

// How many intervals of small meshes each set has.
struct Shares {
  std::size_t random, torn, hard, shapes;
  explicit Shares(std::size_t small)
      : random(small * kRandomShare / 100),
        torn(small * kTornShare / 100),
        hard(small * kHardShare / 100),
        shapes(small - random - torn - hard) {}
};

std::vector<SubjectFamily> small_families() {
  std::vector<SubjectFamily> out;
  for (const std::string_view name : scenes::random_families())
    out.push_back({"random/" + std::string(name), "random",
                   "small noisy closed meshes with bones in large motion, of the kind " + std::string(name)});
  for (const std::string_view name : scenes::random_families())
    out.push_back({"torn/" + std::string(name), "torn",
                   "meshes of the kind " + std::string(name) +
                       " backwards, with triangles that are missing, turned round or there twice"});
  out.push_back(
      {"torn/open_sheet", "torn", "open sheets that are flat, waved or rolled at one end of the interval"});
  for (const hard::Family& family : hard::families())
    out.push_back({"hard/" + std::string(family.name), "hard",
                   "two tetrahedra that carry the features of a hard query. " + std::string(family.story)});
  for (const ShapeFamily& family : shape_families())
    out.push_back({"shapes/" + std::string(family.name), "shapes", std::string(family.story)});
  return out;
}

class Maker {
 public:
  Maker(const BenchmarkPlan& plan, const std::function<void(std::size_t, std::size_t)>& progress)
      : plan_(plan), progress_(progress), all_(plan.small + plan.scenes.size() * plan.scene_intervals) {
    make_folder(plan_.folder, "--out");
    // What stands in the way of any file is found before the work.
    manifest_ = open(kManifestName, ".json");
    truth_ = open(kTruthName, ".jsonl");
    sums_ = open(kSumsName, "");
    for (const char* set : {"random", "torn", "hard", "shapes"}) mesh_file(set);
    for (const std::string& name : plan.scenes) {
      scenes_.push_back(scenes::load_scene(name));
      mesh_file("scene-" + scenes_.back().name);
    }
  }

  void make() {
    Benchmark benchmark;
    benchmark.made_by = {{"program", "cscd benchmark make"},
                         {"small", plan_.small},
                         {"seed", plan_.seed},
                         {"scenes", plan_.scenes},
                         {"scene_intervals", plan_.scene_intervals}};
    benchmark.families = small_families();
    add_small(benchmark);
    for (std::size_t i = 0; i < scenes_.size(); ++i) {
      Input input = open_input(plan_.scenes[i]);
      const scenes::Scene& scene = scenes_[i];
      benchmark.families.push_back({"scenes/" + scene.name, "scenes", scene.story});
      add(benchmark, scene_subject(input, scene.name, plan_.scene_intervals), "scene-" + scene.name);
    }
    // Of a small benchmark some families have no interval.
    std::erase_if(benchmark.families, [&](const SubjectFamily& family) {
      return std::ranges::none_of(benchmark.intervals,
                                  [&](const ListedInterval& i) { return i.family == family.name; });
    });
    finish(benchmark);
  }

 private:
  std::unique_ptr<OutputFile> open(const char* name, std::string_view extension) const {
    return std::make_unique<OutputFile>(plan_.folder / name, plan_.force, extension);
  }

  scenes::MeshFileWriter& mesh_file(const std::string& stem) {
    const auto known = meshes_.find(stem);
    if (known != meshes_.end()) return known->second;
    order_.push_back(stem);
    return meshes_.emplace(stem, scenes::MeshFileWriter(plan_.folder / (stem + ".h5"), plan_.force))
        .first->second;
  }

  void add_small(Benchmark& benchmark) {
    const Shares shares(plan_.small);
    for (std::size_t i = 0; i < shares.random; ++i) add(benchmark, random_subject(plan_.seed + i), "random");
    for (std::size_t i = 0; i < shares.torn; ++i) add(benchmark, torn_subject(plan_.seed + i), "torn");
    const auto hard_families = hard::families();
    for (std::size_t i = 0; i < shares.hard; ++i) {
      const std::size_t number = i / 2 / hard_families.size();
      add(benchmark,
          hard_subject(hard_families[i / 2 % hard_families.size()],
                       i % 2 == 0 ? hard::Kind::vertex_face : hard::Kind::edge_edge, number, plan_.seed),
          "hard");
    }
    const auto shapes = shape_families();
    for (std::size_t i = 0; i < shares.shapes; ++i)
      add(benchmark, shape_subject(shapes[i % shapes.size()], i / shapes.size(), plan_.seed), "shapes");
  }

  void add(Benchmark& benchmark, const Subject& subject, const std::string& file) {
    const TriangleMesh mesh(subject.mesh.triangles, subject.mesh.reference.positions.size(), subject.name);
    mesh_file(file).add(subject.name, subject.mesh);
    for (std::size_t row = 0; row < subject.ids.size(); ++row) {
      benchmark.intervals.push_back({subject.ids[row], subject.family, file + ".h5", subject.name, row,
                                     mesh.vertex_count(), mesh.triangle_count(),
                                     subject.mesh.bone_parent.size(), mesh.closed_and_oriented()});
      IntervalTruth truth = find_truth(mesh, subject.mesh, row);
      truth.id = subject.ids[row];
      truth_text_ += to_json(truth).dump() + "\n";
      progress_(benchmark.intervals.size(), all_);
    }
  }

  void finish(Benchmark& benchmark) {
    for (const std::string& stem : order_) {
      const std::string name = stem + ".h5";
      meshes_.at(stem).finish();
      benchmark.files.push_back(
          {name, fs::file_size(plan_.folder / name), sha256_of_file(plan_.folder / name)});
    }
    truth_->commit(truth_text_);
    benchmark.files.push_back({kTruthName, truth_text_.size(), sha256(truth_text_)});
    const std::string manifest = json_text(to_json(benchmark));
    benchmark.sha256 = sha256(manifest);
    sums_->commit(sums_text(benchmark));
    manifest_->commit(manifest);
  }

  const BenchmarkPlan& plan_;
  const std::function<void(std::size_t, std::size_t)>& progress_;
  std::size_t all_;
  std::vector<scenes::Scene> scenes_;
  std::unique_ptr<OutputFile> manifest_, truth_, sums_;
  std::map<std::string, scenes::MeshFileWriter> meshes_;
  std::vector<std::string> order_;
  std::string truth_text_;
};

}  // namespace

void make_benchmark(const BenchmarkPlan& plan,
                    const std::function<void(std::size_t, std::size_t)>& progress) {
  Maker(plan, progress).make();
}

}  // namespace cscd::bench
