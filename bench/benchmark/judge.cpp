#include "bench/benchmark/judge.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <set>

#include "bench/statistics/statistics.h"
#include "core/base/error.h"

namespace cscd::bench {

namespace {

constexpr std::size_t kListedFaults = 1000;

std::string shown(double time) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", time);
  return text;
}

// Compares one answer with the truth.
class IntervalJudge {
 public:
  IntervalJudge(const IntervalTruth& truth, const IntervalAnswers& answer, double tolerance,
                std::vector<Fault>& faults)
      : truth_(truth), answer_(answer), tolerance_(tolerance), faults_(faults) {
    for (const TrueContact& contact : truth.contacts) times_.emplace(contact.pair, contact.time);
  }

  Score score() {
    score_.intervals = score_.answered = 1;
    if (answer_.contacts) look_at_pairs();
    switch (answer_.claim) {
      case Claim::complete:
      case Claim::none:
        count_missed_pairs();
        break;
      case Claim::first_contact:
        look_for_the_first();
        break;
      case Claim::collides:
        look_at_collides();
        break;
    }
    if (answer_.milliseconds) score_.milliseconds.push_back(*answer_.milliseconds);
    look_at_start();
    if (answer_.collides) {
      score_.collides_told = 1;
      score_.collides_wrong = *answer_.collides != truth_.collides();
      if (score_.collides_wrong > 0 && answer_.claim != Claim::collides) tell("collides is wrong");
    }
    score_.broken = answer_.claim != Claim::none && score_.misses > 0;
    return score_;
  }

 private:
  void tell(std::string what) { faults_.push_back({truth_.id, std::move(what)}); }

  void miss(const std::string& what) {
    ++score_.misses;
    tell("misses " + what);
  }
  void invent(const std::string& what) {
    ++score_.inventions;
    tell("invents " + what);
  }

  void look_at_time(double told, const exact::TimeEnclosure& truth, const std::string& what) {
    ++score_.timed;
    if (told > truth.hi) {
      score_.latest = std::max(score_.latest, told - truth.hi);
      if (told - truth.hi <= tolerance_) return;
      ++score_.late;
      tell("is late by " + shown(told - truth.hi) + " at " + what);
    } else if (told < truth.lo) {
      score_.earliest = std::max(score_.earliest, truth.lo - told);
      if (truth.lo - told <= tolerance_) return;
      ++score_.early;
      tell("is early by " + shown(truth.lo - told) + " at " + what);
    }
  }

  // Counts what is invented, undecided, late and early, under any claim.
  void look_at_pairs() {
    for (const AnsweredContact& contact : *answer_.contacts) {
      const auto truth = times_.find(contact.pair);
      if (!contact.time)
        ++score_.undecided;
      else if (truth == times_.end())
        invent(text(contact.pair));
      else
        look_at_time(*contact.time, truth->second, text(contact.pair));
    }
  }

  void count_missed_pairs() {
    score_.expected = truth_.contacts.size();
    std::set<PairName> named;
    for (const AnsweredContact& contact : *answer_.contacts) named.insert(contact.pair);
    for (const TrueContact& contact : truth_.contacts)
      if (!named.contains(contact.pair))
        miss(text(contact.pair) + ", which touches at " + shown(contact.time.lo));
  }

  void look_for_the_first() {
    const auto first = truth_.first_time();
    score_.expected = first.has_value();
    if (answer_.first_time) {
      const std::optional<double> told = *answer_.first_time;
      if (told && first) look_at_time(*told, *first, "the first contact");
      if (told && !first) invent("a first contact at " + shown(*told));
      if (!told && first) miss("the first contact, at " + shown(first->lo));
      return;
    }
    if (!first) return;
    // A pair may touch first if the enclosure of its time does not lie beyond that of the first time.
    const bool there = std::ranges::any_of(*answer_.contacts, [&](const AnsweredContact& contact) {
      const auto truth = times_.find(contact.pair);
      return truth != times_.end() && truth->second.lo <= first->hi;
    });
    if (!there) miss("the first contact, " + text(truth_.contacts.front().pair) + " at " + shown(first->lo));
  }

  void look_at_collides() {
    score_.expected = truth_.collides();
    if (truth_.collides() && !*answer_.collides) miss("that it collides");
    if (!truth_.collides() && *answer_.collides) invent("a collision");
  }

  void look_at_start() {
    if (answer_.starts_embedded) {
      score_.starts_told = 1;
      score_.starts_wrong = *answer_.starts_embedded != truth_.starts_embedded();
      if (score_.starts_wrong > 0)
        tell(truth_.starts_embedded() ? "says that triangles cross at the start, and none do"
                                      : "says that no triangles cross at the start, and some do");
    }
    if (!answer_.start_pairs) return;
    std::vector<CrossingPair> told = *answer_.start_pairs, difference;
    std::ranges::sort(told);
    std::ranges::set_difference(truth_.start_pairs, told, std::back_inserter(difference));
    score_.start_pairs_missed = difference.size();
    difference.clear();
    std::ranges::set_difference(told, truth_.start_pairs, std::back_inserter(difference));
    score_.start_pairs_invented = difference.size();
    if (score_.start_pairs_missed + score_.start_pairs_invented > 0)
      tell("misses " + std::to_string(score_.start_pairs_missed) +
           " pairs of triangles that cross at the start, "
           "and invents " +
           std::to_string(score_.start_pairs_invented));
  }

  const IntervalTruth& truth_;
  const IntervalAnswers& answer_;
  double tolerance_;
  std::vector<Fault>& faults_;
  std::map<PairName, exact::TimeEnclosure> times_;
  Score score_;
};

// Refuses pairs of features that the mesh does not have.
class MeshCheck {
 public:
  explicit MeshCheck(const scenes::PosedMesh& posed)
      : mesh_(posed.triangles, posed.reference.positions.size()),
        edges_(mesh_.edges().begin(), mesh_.edges().end()) {}

  void check(const IntervalAnswers& answer, const std::string& where) const {
    const std::string whose = where + ", answer to " + answer.id + ": ";
    if (answer.contacts)
      for (const AnsweredContact& contact : *answer.contacts)
        if (const std::string fault = fault_of(contact.pair); !fault.empty())
          throw InputError(whose + text(contact.pair) + ": " + fault);
    if (answer.start_pairs)
      for (const CrossingPair& pair : *answer.start_pairs)
        if (+pair.second >= mesh_.triangle_count())
          throw InputError(whose + "the mesh has " + std::to_string(mesh_.triangle_count()) +
                           " triangles, counted from 0, and no triangle " + std::to_string(+pair.second));
  }

 private:
  std::string fault_of(const PairName& pair) const {
    const auto& i = pair.index;
    if (pair.kind == FeaturePair::Kind::vertex_face) {
      if (static_cast<std::size_t>(i[0]) >= mesh_.vertex_count() ||
          static_cast<std::size_t>(i[1]) >= mesh_.triangle_count())
        return "the mesh has " + std::to_string(mesh_.vertex_count()) + " vertices and " +
               std::to_string(mesh_.triangle_count()) + " triangles, counted from 0";
      const Triangle& corners = mesh_.corners(TriangleId{i[1]});
      if (std::ranges::find(corners, VertexId{i[0]}) != corners.end())
        return "the vertex is a corner of the triangle, and such pairs are no contacts; leave it out";
      return "";
    }
    for (const std::size_t k : {std::size_t{0}, std::size_t{2}})
      if (!edges_.contains({VertexId{i[k]}, VertexId{i[k + 1]}}))
        return "the mesh has no edge from " + std::to_string(i[k]) + " to " + std::to_string(i[k + 1]) +
               "; give the ends of an edge";
    if (i[0] == i[2] || i[0] == i[3] || i[1] == i[2] || i[1] == i[3])
      return "the edges share a vertex, and such pairs are no contacts; leave it out";
    return "";
  }

  TriangleMesh mesh_;
  std::set<Edge> edges_;
};

using nlohmann::ordered_json;

std::string brief(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

ordered_json score_json(const Score& score) {
  ordered_json out = {{"intervals", score.intervals},
                      {"answered", score.answered},
                      {"broken", score.broken},
                      {"expected", score.expected},
                      {"misses", score.misses},
                      {"inventions", score.inventions},
                      {"undecided", score.undecided},
                      {"timed", score.timed},
                      {"late", score.late},
                      {"early", score.early},
                      {"latest", score.latest},
                      {"earliest", score.earliest},
                      {"starts_told", score.starts_told},
                      {"starts_wrong", score.starts_wrong},
                      {"start_pairs_missed", score.start_pairs_missed},
                      {"start_pairs_invented", score.start_pairs_invented},
                      {"collides_told", score.collides_told},
                      {"collides_wrong", score.collides_wrong}};
  if (!score.milliseconds.empty())
    out["milliseconds"] = {
        {"answers", score.milliseconds.size()},
        {"median", median(score.milliseconds)},
        {"sum", std::accumulate(score.milliseconds.begin(), score.milliseconds.end(), 0.0)}};
  return out;
}

std::vector<std::string> cells(const std::string& name, const Score& score) {
  const auto count = [](std::size_t n) { return std::to_string(n); };
  const bool has_times = !score.milliseconds.empty();
  return {
      name,
      count(score.answered) + " of " + count(score.intervals),
      count(score.expected),
      count(score.misses),
      count(score.inventions),
      count(score.undecided),
      count(score.broken),
      count(score.late),
      brief(score.latest),
      count(score.early),
      brief(score.earliest),
      score.starts_told == 0 ? "-" : count(score.starts_wrong) + " of " + count(score.starts_told),
      has_times ? brief(median(score.milliseconds)) : "-",
      has_times ? brief(std::accumulate(score.milliseconds.begin(), score.milliseconds.end(), 0.0)) : "-"};
}

}  // namespace

void Score::add(const Score& other) {
  intervals += other.intervals;
  answered += other.answered;
  broken += other.broken;
  expected += other.expected;
  misses += other.misses;
  inventions += other.inventions;
  undecided += other.undecided;
  timed += other.timed;
  late += other.late;
  early += other.early;
  latest = std::max(latest, other.latest);
  earliest = std::max(earliest, other.earliest);
  starts_told += other.starts_told;
  starts_wrong += other.starts_wrong;
  start_pairs_missed += other.start_pairs_missed;
  start_pairs_invented += other.start_pairs_invented;
  collides_told += other.collides_told;
  collides_wrong += other.collides_wrong;
  milliseconds.insert(milliseconds.end(), other.milliseconds.begin(), other.milliseconds.end());
}

Score Judgement::set(const std::string& name) const {
  Score sum;
  for (const std::string& family : family_order)
    if (set_of.at(family) == name) sum.add(families.at(family));
  return sum;
}

Score Judgement::all() const {
  Score sum;
  for (const std::string& family : family_order) sum.add(families.at(family));
  return sum;
}

Score judge_interval(const IntervalTruth& truth, const IntervalAnswers& answer, double time_tolerance,
                     std::vector<Fault>& faults) {
  return IntervalJudge(truth, answer, time_tolerance, faults).score();
}

Judgement judge(const Benchmark& benchmark, const Answers& answers, const std::string& where,
                double time_tolerance) {
  if (answers.benchmark && *answers.benchmark != benchmark.sha256)
    throw InputError(where + ", benchmark: is " + *answers.benchmark + ", and this benchmark is " +
                     benchmark.sha256 +
                     " (the checksum of its manifest); answer this one, or judge by that one");
  std::map<std::string, const IntervalAnswers*> answer_to;
  for (const IntervalAnswers& answer : answers.intervals) answer_to.emplace(answer.id, &answer);
  std::set<std::string> known;
  for (const ListedInterval& interval : benchmark.intervals) known.insert(interval.id);
  for (const IntervalAnswers& answer : answers.intervals)
    if (!known.contains(answer.id))
      throw InputError(where + ": answers " + answer.id +
                       ", which is no interval of this benchmark; its manifest lists their ids");

  Judgement out;
  out.program = answers.program;
  out.version = answers.version;
  out.benchmark = benchmark.sha256;
  out.notes = answers.notes;
  for (const SubjectFamily& family : benchmark.families) {
    out.family_order.push_back(family.name);
    out.set_of[family.name] = family.set;
    out.families[family.name];
    if (std::ranges::find(out.set_order, family.set) == out.set_order.end())
      out.set_order.push_back(family.set);
  }
  const std::vector<IntervalTruth> truth = read_truth(benchmark);
  std::vector<Fault> faults;
  for_each_mesh(benchmark, [&](const scenes::PosedMesh& posed, std::span<const std::size_t> intervals) {
    const MeshCheck check(posed);
    for (const std::size_t i : intervals)
      if (const auto answer = answer_to.find(benchmark.intervals[i].id); answer != answer_to.end())
        check.check(*answer->second, where);
  });
  for (std::size_t i = 0; i < benchmark.intervals.size(); ++i) {
    Score& score = out.families[benchmark.intervals[i].family];
    const auto answer = answer_to.find(benchmark.intervals[i].id);
    if (answer == answer_to.end()) {
      ++score.intervals;
      out.unanswered.push_back(benchmark.intervals[i].id);
      continue;
    }
    faults.clear();
    score.add(judge_interval(truth[i], *answer->second, time_tolerance, faults));
    out.fault_count += faults.size();
    for (Fault& fault : faults)
      if (out.faults.size() < kListedFaults) out.faults.push_back(std::move(fault));
  }
  return out;
}

ordered_json to_json(const Judgement& judgement) {
  ordered_json sets = ordered_json::object(), families = ordered_json::object(),
               faults = ordered_json::array();
  for (const std::string& set : judgement.set_order) sets[set] = score_json(judgement.set(set));
  for (const std::string& family : judgement.family_order)
    families[family] = score_json(judgement.families.at(family));
  for (const Fault& fault : judgement.faults) faults.push_back({{"id", fault.id}, {"what", fault.what}});
  return {{"schema", "cscd.score/1"},
          {"program", judgement.program},
          {"version", judgement.version},
          {"benchmark", judgement.benchmark},
          {"notes", judgement.notes},
          {"all", score_json(judgement.all())},
          {"sets", std::move(sets)},
          {"families", std::move(families)},
          {"unanswered", judgement.unanswered},
          {"fault_count", judgement.fault_count},
          {"faults", std::move(faults)}};
}

std::string describe(const Judgement& judgement, bool by_family) {
  static const std::vector<std::string> kHead = {
      "",     "answered", "expected", "misses",   "inventions",   "undecided", "broken",
      "late", "latest",   "early",    "earliest", "starts wrong", "median ms", "sum of ms"};
  std::vector<std::vector<std::string>> rows;
  if (by_family) {
    for (const std::string& family : judgement.family_order)
      rows.push_back(cells(family, judgement.families.at(family)));
  } else {
    for (const std::string& set : judgement.set_order) rows.push_back(cells(set, judgement.set(set)));
  }
  rows.push_back(cells("all", judgement.all()));

  std::vector<std::size_t> width;
  for (std::size_t column = 0; column < kHead.size(); ++column) {
    width.push_back(kHead[column].size());
    for (const auto& row : rows) width[column] = std::max(width[column], row[column].size());
  }
  const auto line = [&](const std::vector<std::string>& row) {
    std::string out = row[0] + std::string(width[0] - row[0].size(), ' ');
    for (std::size_t column = 1; column < row.size(); ++column)
      out += "  " + std::string(width[column] - row[column].size(), ' ') + row[column];
    return out + "\n";
  };
  std::string out =
      judgement.program + (judgement.version.empty() ? "" : " " + judgement.version) + "\n" + line(kHead);
  for (const auto& row : rows) out += line(row);
  constexpr std::size_t kShown = 10;
  for (std::size_t i = 0; i < std::min(kShown, judgement.faults.size()); ++i)
    out += judgement.faults[i].id + " " + judgement.faults[i].what + "\n";
  if (judgement.fault_count > kShown)
    out += "and " + std::to_string(judgement.fault_count - kShown) +
           " faults more; --json lists the first 1000\n";
  if (!judgement.unanswered.empty())
    out += std::to_string(judgement.unanswered.size()) + " intervals are not answered, the first is " +
           judgement.unanswered.front() + "; --json lists all\n";
  return out;
}

}  // namespace cscd::bench
