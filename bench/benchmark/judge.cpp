#include "bench/benchmark/judge.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <variant>

#include "bench/statistics/statistics.h"
#include "core/base/error.h"
#include "core/base/number_text.h"

namespace cscd::bench {

namespace {

constexpr std::size_t kListedFaults = 1000;

// Compares one answer with the truth.
class IntervalJudge {
 public:
  IntervalJudge(const IntervalTruth& truth, const IntervalAnswers& answer, double tolerance,
                std::vector<Fault>& faults)
      : truth_(truth), answer_(answer), tolerance_(tolerance), faults_(faults) {
    for (const TrueContact& contact : truth.contacts) times_.emplace(contact.pair, contact.time);
    if (answer.contacts)
      for (const AnsweredContact& contact : *answer.contacts) named_.insert(contact.pair);
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
    count_kept();
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
      tell("is late by " + exact_text(told - truth.hi) + " at " + what);
    } else if (told < truth.lo) {
      score_.earliest = std::max(score_.earliest, truth.lo - told);
      if (truth.lo - told <= tolerance_) return;
      ++score_.early;
      tell("is early by " + exact_text(truth.lo - told) + " at " + what);
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
    for (const TrueContact& contact : truth_.contacts)
      if (!named_.contains(contact.pair))
        miss(text(contact.pair) + ", which touches at " + exact_text(contact.time.lo));
  }

  // What a complete answer lists, whatever this one claims.
  void count_kept() {
    score_.contacts = truth_.contacts.size();
    score_.kept = static_cast<std::size_t>(std::ranges::count_if(
        truth_.contacts, [&](const TrueContact& contact) { return named_.contains(contact.pair); }));
    score_.unpromised = answer_.claim == Claim::none && !truth_.starts_embedded();
  }

  void look_for_the_first() {
    const auto first = truth_.first_time();
    score_.expected = first.has_value();
    if (answer_.first_time) {
      const std::optional<double> told = *answer_.first_time;
      if (told && first) look_at_time(*told, *first, "the first contact");
      if (told && !first) invent("a first contact at " + exact_text(*told));
      if (!told && first) miss("the first contact, at " + exact_text(first->lo));
      return;
    }
    if (!first) return;
    // A pair may touch first if the enclosure of its time does not lie beyond that of the first time.
    const bool there = std::ranges::any_of(*answer_.contacts, [&](const AnsweredContact& contact) {
      const auto truth = times_.find(contact.pair);
      return truth != times_.end() && truth->second.lo <= first->hi;
    });
    if (!there)
      miss("the first contact, " + text(truth_.contacts.front().pair) + " at " + exact_text(first->lo));
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
  std::set<PairName> named_;
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

// A row for each number of a score: JSON, sums and columns follow from it.
constexpr struct {
  const char* name;                                            // in JSON, and above its column
  std::variant<std::size_t Score::*, double Score::*> member;  // a count, or the largest of an error
  bool is_column = false;
} kScoreRows[] = {{"intervals", &Score::intervals},
                  {"answered", &Score::answered},
                  {"expected", &Score::expected, true},
                  {"misses", &Score::misses, true},
                  {"inventions", &Score::inventions, true},
                  {"undecided", &Score::undecided, true},
                  {"broken", &Score::broken, true},
                  {"timed", &Score::timed},
                  {"late", &Score::late, true},
                  {"latest", &Score::latest, true},
                  {"early", &Score::early, true},
                  {"earliest", &Score::earliest, true},
                  {"starts_told", &Score::starts_told},
                  {"starts_wrong", &Score::starts_wrong},
                  {"start_pairs_missed", &Score::start_pairs_missed},
                  {"start_pairs_invented", &Score::start_pairs_invented},
                  {"collides_told", &Score::collides_told},
                  {"collides_wrong", &Score::collides_wrong},
                  {"contacts", &Score::contacts},
                  {"kept", &Score::kept},
                  {"unpromised", &Score::unpromised}};

double sum_of(const std::vector<double>& samples) {
  return std::accumulate(samples.begin(), samples.end(), 0.0);
}

ordered_json score_json(const Score& score) {
  ordered_json out;
  for (const auto& row : kScoreRows)
    std::visit([&](const auto& member) { out[row.name] = score.*member; }, row.member);
  if (is_short(score.shortfall())) out["shortfall"] = shortfall_text(score.shortfall());
  if (!score.milliseconds.empty())
    out["milliseconds"] = {{"answers", score.milliseconds.size()},
                           {"median", median(score.milliseconds)},
                           {"sum", sum_of(score.milliseconds)}};
  return out;
}

std::vector<std::string> cells(const std::string& name, const Score& score) {
  std::vector<std::string> out = {name,
                                  std::to_string(score.answered) + " of " + std::to_string(score.intervals)};
  const auto shown_as = [](const auto& value) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>)
      return figure_text(value);
    else
      return std::to_string(value);
  };
  for (const auto& row : kScoreRows)
    if (row.is_column)
      std::visit([&](const auto& member) { out.push_back(shown_as(score.*member)); }, row.member);
  out.push_back(score.starts_told == 0
                    ? "-"
                    : std::to_string(score.starts_wrong) + " of " + std::to_string(score.starts_told));
  const std::string mark(is_short(score.shortfall()) ? kShortfallMark : "");
  for (const auto statistic : {+[](const std::vector<double>& ms) { return median(ms); }, sum_of})
    out.push_back(score.milliseconds.empty() ? "-" : figure_text(statistic(score.milliseconds)) + mark);
  return out;
}

}  // namespace

void Score::add(const Score& other) {
  for (const auto& row : kScoreRows) {
    if (const auto* const count = std::get_if<std::size_t Score::*>(&row.member))
      this->** count += other.**count;
    else
      this->*std::get<double Score::*>(row.member) = std::max(this->*std::get<double Score::*>(row.member),
                                                              other.*std::get<double Score::*>(row.member));
  }
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
  return {{"schema", "cscd.score/2"},
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
  std::vector<std::string> head = {"", "answered"};
  for (const auto& row : kScoreRows)
    if (row.is_column) head.emplace_back(row.name);
  head.insert(head.end(), {"starts wrong", "median ms", "sum of ms"});
  std::vector<std::vector<std::string>> rows;
  std::string marked;
  const auto add = [&](const std::string& name, const Score& score) {
    rows.push_back(cells(name, score));
    if (!score.milliseconds.empty() && is_short(score.shortfall()))
      marked += "- " + name + ": " + shortfall_text(score.shortfall()) + "\n";
  };
  for (const std::string& name : by_family ? judgement.family_order : judgement.set_order)
    add(name, by_family ? judgement.families.at(name) : judgement.set(name));
  add("all", judgement.all());

  std::vector<std::size_t> width;
  for (std::size_t column = 0; column < head.size(); ++column) {
    width.push_back(head[column].size());
    for (const auto& row : rows) width[column] = std::max(width[column], row[column].size());
  }
  const auto line = [&](const std::vector<std::string>& row) {
    std::string out = row[0] + std::string(width[0] - row[0].size(), ' ');
    for (std::size_t column = 1; column < row.size(); ++column)
      out += "  " + std::string(width[column] - row[column].size(), ' ') + row[column];
    return out + "\n";
  };
  std::string out =
      judgement.program + (judgement.version.empty() ? "" : " " + judgement.version) + "\n" + line(head);
  for (const auto& row : rows) out += line(row);
  if (!marked.empty()) out += kShortfallMeaning + (".\n" + marked);
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
