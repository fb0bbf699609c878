// Prints a digest of what every row of the catalogue of elementary tests answers to files of queries, bit by
// bit, and of the contacts of meshes made of the same points: scripts/check stability compares compilers by
// it.
//
//   digest vf.csv ee.csv ...      the kind of a query is in the name of its file
#include "core/base/digest.h"

#include <array>
#include <bit>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/detect/compose.h"
#include "core/detect/plain_culler.h"
#include "core/elementary/catalogue.h"
#include "core/elementary/question/query_scale.h"
#include "core/hierarchy/bounds.h"
#include "scenes/queries/query_file.h"

using namespace cscd;

namespace {

template <class AskQuery>
void print_digest(const std::string& name, const std::vector<Query>& queries, const AskQuery& ask) {
  std::uint64_t sum = kDigestOfNothing;
  const auto add = [&](std::uint64_t word) { sum = digest_of(std::as_bytes(std::span(&word, 1)), sum); };
  int contacts = 0;
  for (const Query& query : queries) {
    const Answer answer = ask(query);
    add(static_cast<std::uint64_t>(answer.verdict));
    if (answer.verdict != Verdict::apart) add(std::bit_cast<std::uint64_t>(answer.time + 0.0));
    contacts += answer.verdict == Verdict::contact;
  }
  std::printf("%s %d %s\n", name.c_str(), contacts, hex_text(sum).c_str());
}

// A distance is a 64th of the query's extent.
template <class Ask>
Answer at_distance(const ElementaryTest& test, const Ask& query) {
  return test.answer_close(query, 0x1p-6 * extent(query));
}

void ask_all(const std::string& name, const std::vector<Query>& queries, bool vertex_face) {
  for (const ElementaryTest& test : elementary_tests()) {
    const std::string row = name + " " + std::string(test.name);
    print_digest(row, queries, [&](const Query& query) {
      return vertex_face ? test.vertex_face(as_vertex_face(query)) : test.edge_edge(as_edge_edge(query));
    });
    if (!test.knows_distance()) continue;
    print_digest(row + " at a distance", queries, [&](const Query& query) {
      return vertex_face ? at_distance(test, as_vertex_face(query)) : at_distance(test, as_edge_edge(query));
    });
  }
}

// A tetrahedron of every query's four points.
void detect(const std::string& name, const std::vector<Query>& queries) {
  std::vector<Vec3> start, end;
  std::vector<Triangle> triangles;
  for (const Query& query : queries) {
    const auto first = static_cast<std::int32_t>(start.size());
    for (const MovingPoint& p : query.points) start.push_back(p.start), end.push_back(p.end);
    const auto corner = [first](int i) { return VertexId{first + i}; };
    for (const auto& [a, b, c] :
         {std::array{0, 1, 2}, std::array{0, 2, 3}, std::array{0, 3, 1}, std::array{1, 3, 2}})
      triangles.push_back({corner(a), corner(b), corner(c)});
  }
  const TriangleMesh mesh(triangles, start.size());
  const StrategyInput setup{mesh, start, nullptr, *find_elementary_test("filtered_exact")};
  PairOptions options;
  options.relative_boxes = true;
  const auto detector = compose(std::make_unique<PlainCuller<Kdop16>>(setup), setup, std::move(options));
  ContactSet contacts;
  const Report report = detector->detect({Motion(start, end)}, contacts);
  contacts.sort();
  std::printf("%s mesh %zu contacts of %llu pairs %s\n", name.c_str(), contacts.contacts.size(),
              static_cast<unsigned long long>(report.pairs.elementary_tests), digest(contacts).c_str());
}

}  // namespace

int main(int count, char** files) {
  for (int i = 1; i < count; ++i) {
    const std::string path = files[i], name = path.substr(path.find_last_of('/') + 1);
    const std::vector<Query> queries = read_queries(path);
    ask_all(name, queries, name.find("vf") != std::string::npos);
    detect(name, queries);
  }
}
