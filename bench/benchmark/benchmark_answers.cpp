#include "bench/benchmark/benchmark_answers.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>
#include <sstream>
#include <utility>

#include "bench/output/gzip.h"
#include "core/base/error.h"
#include "scenes/base/closest_name.h"
#include "scenes/base/joined.h"

namespace cscd::bench {

using Kind = FeaturePair::Kind;

PairName PairName::vertex_face(std::int32_t vertex, std::int32_t triangle) {
  return {Kind::vertex_face, {vertex, triangle, -1, -1}};
}

PairName PairName::edge_edge(std::int32_t a0, std::int32_t a1, std::int32_t b0, std::int32_t b1) {
  std::pair<std::int32_t, std::int32_t> a = std::minmax(a0, a1), b = std::minmax(b0, b1);
  if (b < a) std::swap(a, b);
  return {Kind::edge_edge, {a.first, a.second, b.first, b.second}};
}

PairName PairName::of(const TriangleMesh& mesh, const FeaturePair& pair) {
  if (pair.kind == Kind::vertex_face) return vertex_face(pair.a, pair.b);
  const Edge &a = mesh.ends(EdgeId{pair.a}), &b = mesh.ends(EdgeId{pair.b});
  const auto number = [](VertexId vertex) { return static_cast<std::int32_t>(vertex); };
  return edge_edge(number(a[0]), number(a[1]), number(b[0]), number(b[1]));
}

const char* key_of(const PairName& pair) {
  return pair.kind == Kind::vertex_face ? "vf" : "ee";
}

nlohmann::ordered_json numbers_json(const PairName& pair) {
  const auto& i = pair.index;
  return pair.kind == Kind::vertex_face ? nlohmann::ordered_json{i[0], i[1]}
                                        : nlohmann::ordered_json{i[0], i[1], i[2], i[3]};
}

std::string text(const PairName& pair) {
  const auto number = [&](std::size_t i) { return std::to_string(pair.index[i]); };
  if (pair.kind == Kind::vertex_face) return "vertex " + number(0) + ", triangle " + number(1);
  return "edges " + number(0) + "-" + number(1) + " and " + number(2) + "-" + number(3);
}

namespace {

using nlohmann::ordered_json;

constexpr std::size_t kMostBytes = std::size_t{4} << 30;
constexpr std::array<std::string_view, 4> kClaims = {"complete", "first_contact", "collides", "none"};

// A part of the answers, and where it is: every refusal begins with the place.
class Part {
 public:
  Part(const ordered_json& json, std::string where) : json_(json), where_(std::move(where)) {}

  [[noreturn]] void refuse(const std::string& what) const { throw InputError(where_ + ": " + what); }

  // Refuses anything but an object with keys among these.
  void require_object(std::span<const std::string_view> known) const {
    if (!json_.is_object()) refuse("is " + shown() + "; give an object");
    for (const auto& [key, value] : json_.items())
      if (std::ranges::find(known, key) == known.end())
        refuse("has the unknown key '" + key + "'" + did_you_mean(key, known) + "; known are " +
               joined(known));
  }
  bool has(const char* key) const { return json_.contains(key); }
  Part at(const char* key) const {
    if (!has(key)) refuse(std::string("has no '") + key + "'; add it");
    return {json_.at(key), where_ + ", " + key};
  }
  std::vector<Part> items() const {
    if (!json_.is_array()) refuse("is " + shown() + "; give a list");
    std::vector<Part> out;
    for (std::size_t i = 0; i < json_.size(); ++i)
      out.push_back({json_[i], where_ + "[" + std::to_string(i) + "]"});
    return out;
  }
  std::string text() const {
    if (!json_.is_string()) refuse("is " + shown() + "; give a text");
    return json_.get<std::string>();
  }
  bool flag() const {
    if (!json_.is_boolean()) refuse("is " + shown() + "; give true or false");
    return json_.get<bool>();
  }
  bool is_null() const { return json_.is_null(); }
  std::int32_t index() const {
    if (!json_.is_number_integer() || json_ < 0 || json_ > std::numeric_limits<std::int32_t>::max())
      refuse("is " + shown() + "; give the number of a vertex or triangle, counted from 0");
    return json_.get<std::int32_t>();
  }
  std::vector<std::int32_t> indices(std::size_t count, const char* what) const {
    std::vector<std::int32_t> out;
    for (const Part& part : items()) out.push_back(part.index());
    if (out.size() != count) refuse("has " + std::to_string(out.size()) + " numbers; give " + what);
    return out;
  }
  double time() const {
    const double value = number("a time from 0 to 1");
    if (!(value >= 0 && value <= 1)) refuse("is " + shown() + "; give a time from 0 to 1");
    return value;
  }
  double milliseconds() const {
    const double value = number("milliseconds, at least 0");
    if (!(value >= 0)) refuse("is " + shown() + "; give milliseconds, at least 0");
    return value;
  }
  const ordered_json& json() const { return json_; }

 private:
  double number(const char* what) const {
    if (!json_.is_number() || !std::isfinite(json_.get<double>())) refuse("is " + shown() + "; give " + what);
    return json_.get<double>();
  }
  std::string shown() const {
    const std::string text = json_.dump(-1, ' ', true, ordered_json::error_handler_t::replace);
    return text.size() <= 40 ? text : text.substr(0, 37) + "...";
  }

  const ordered_json& json_;
  std::string where_;
};

Claim claim_from(const Part& part) {
  const auto found = std::ranges::find(kClaims, part.text());
  if (found == kClaims.end())
    part.refuse("is '" + part.text() + "'" + did_you_mean(part.text(), kClaims) + "; give one of " +
                joined(kClaims));
  return static_cast<Claim>(found - kClaims.begin());
}

AnsweredContact contact_from(const Part& part) {
  static constexpr std::array<std::string_view, 4> kKeys = {"vf", "ee", "time", "undecided"};
  part.require_object(kKeys);
  if (part.has("vf") == part.has("ee"))
    part.refuse(
        "names no pair, or two; give either 'vf', a vertex and a triangle, or 'ee', the ends of two edges");
  AnsweredContact contact;
  if (part.has("vf")) {
    const auto i = part.at("vf").indices(2, "a vertex and a triangle");
    contact.pair = PairName::vertex_face(i[0], i[1]);
  } else {
    const auto i = part.at("ee").indices(4, "the two ends of one edge, then those of the other");
    contact.pair = PairName::edge_edge(i[0], i[1], i[2], i[3]);
  }
  const bool undecided = part.has("undecided") && part.at("undecided").flag();
  if (undecided && part.has("time")) part.refuse("is undecided and has a time; leave out one of the two");
  if (!undecided) contact.time = part.at("time").time();
  return contact;
}

std::vector<AnsweredContact> contacts_from(const Part& part) {
  std::vector<AnsweredContact> out;
  std::set<PairName> seen;
  for (const Part& one : part.items()) {
    out.push_back(contact_from(one));
    if (!seen.insert(out.back().pair).second)
      one.refuse("names " + bench::text(out.back().pair) + " for the second time; name each pair once");
  }
  return out;
}

std::vector<CrossingPair> start_pairs_from(const Part& part) {
  std::vector<CrossingPair> out;
  std::set<CrossingPair> seen;
  for (const Part& one : part.items()) {
    const auto i = one.indices(2, "two triangles");
    if (i[0] == i[1]) one.refuse("names triangle " + std::to_string(i[0]) + " twice; give two triangles");
    out.push_back({TriangleId{std::min(i[0], i[1])}, TriangleId{std::max(i[0], i[1])}});
    if (!seen.insert(out.back()).second)
      one.refuse("names these two triangles for the second time; name each pair once");
  }
  return out;
}

IntervalAnswers interval_from(const Part& part, std::optional<Claim> claim) {
  static constexpr std::array<std::string_view, 9> kKeys = {"id",          "guarantee",    "contacts",
                                                            "first_time",  "collides",     "starts_embedded",
                                                            "start_pairs", "milliseconds", "notes"};
  part.require_object(kKeys);
  IntervalAnswers out;
  out.id = part.at("id").text();
  if (part.has("guarantee")) claim = claim_from(part.at("guarantee"));
  if (!claim) part.refuse("has no 'guarantee', and the head has none either; add one of " + joined(kClaims));
  out.claim = *claim;
  if (part.has("contacts")) out.contacts = contacts_from(part.at("contacts"));
  if (part.has("first_time")) {
    const Part first = part.at("first_time");
    out.first_time.emplace();
    if (!first.is_null()) *out.first_time = first.time();
  }
  if (part.has("collides")) out.collides = part.at("collides").flag();
  if (part.has("starts_embedded")) out.starts_embedded = part.at("starts_embedded").flag();
  if (part.has("start_pairs")) out.start_pairs = start_pairs_from(part.at("start_pairs"));
  if (part.has("milliseconds")) out.milliseconds = part.at("milliseconds").milliseconds();
  if (out.claim == Claim::collides && !out.collides)
    part.refuse("claims 'collides' and does not say whether; add 'collides': true or false");
  if ((out.claim == Claim::complete || out.claim == Claim::none) && !out.contacts)
    part.refuse("claims '" + std::string(to_string(out.claim)) +
                "' and has no 'contacts'; add the list, which may be empty");
  if (out.claim == Claim::first_contact && !out.contacts && !out.first_time)
    part.refuse("claims 'first_contact' and has neither 'contacts' nor 'first_time'; add one of the two");
  if (out.contacts && out.first_time)
    part.refuse("has 'contacts' and 'first_time'; leave out one of the two");
  return out;
}

// Refuses what JSON has no number for, in the words of whoever wrote it.
[[noreturn]] void refuse_text(const std::string& text, const std::string& where) {
  for (const char* word : {"NaN", "nan", "Infinity", "inf"})
    if (const std::size_t at = text.find(word); at != std::string::npos) {
      const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
      throw InputError(where + ", line " + std::to_string(line) + ": is no JSON, which has no " + word +
                       "; leave out the contact, or say \"undecided\": true of it");
    }
  throw InputError(where +
                   ": is neither a JSON document nor JSON lines; write it as bench/BENCHMARK.md says");
}

ordered_json document_of(const std::string& text, const std::string& where) {
  ordered_json whole = ordered_json::parse(text, nullptr, false);
  if (!whole.is_discarded()) return whole;
  ordered_json head;
  std::istringstream lines(text);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    ordered_json json = ordered_json::parse(line, nullptr, false);
    if (json.is_discarded()) refuse_text(text, where);
    if (head.is_null()) {
      if (!json.is_object() || json.contains("answers")) refuse_text(text, where);
      head = std::move(json);
      head["answers"] = ordered_json::array();
    } else {
      head["answers"].push_back(std::move(json));
    }
  }
  if (head.is_null()) refuse_text(text, where);
  return head;
}

}  // namespace

std::string_view to_string(Claim claim) {
  return kClaims[static_cast<std::size_t>(claim)];
}

Answers parse_answers(const std::string& text, const std::string& where) {
  static constexpr std::array<std::string_view, 7> kKeys = {"schema",    "program", "version", "guarantee",
                                                            "benchmark", "notes",   "answers"};
  const ordered_json document = document_of(text, where);
  const Part whole(document, where);
  whole.require_object(kKeys);
  if (const Part schema = whole.at("schema"); schema.text() != kAnswersSchema)
    schema.refuse("is '" + schema.text() + "'; give " + kAnswersSchema);
  Answers out;
  out.program = whole.at("program").text();
  if (out.program.empty()) whole.at("program").refuse("is empty; name the program");
  if (whole.has("version")) out.version = whole.at("version").text();
  if (whole.has("benchmark")) out.benchmark = whole.at("benchmark").text();
  if (whole.has("notes")) out.notes = whole.at("notes").json();
  std::optional<Claim> claim;
  if (whole.has("guarantee")) claim = claim_from(whole.at("guarantee"));
  std::set<std::string> ids;
  const ordered_json& answers = whole.at("answers").json();
  if (!answers.is_array()) whole.at("answers").items();
  for (std::size_t i = 0; i < answers.size(); ++i) {
    std::string place = where + ", answer " + std::to_string(i);
    if (answers[i].is_object() && answers[i].value("id", ordered_json()).is_string())
      place += " (" + answers[i]["id"].get<std::string>() + ")";
    const Part part(answers[i], place);
    out.intervals.push_back(interval_from(part, claim));
    if (!ids.insert(out.intervals.back().id).second)
      part.refuse("answers this interval for the second time; answer each once");
  }
  return out;
}

Answers read_answers(const std::filesystem::path& path) {
  const std::string where = "answers " + path.string();
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file.good() && !file.eof())
    throw InputError(where + ": cannot be read (" + std::strerror(errno) + "); check the name");
  return parse_answers(without_gzip(std::move(text), where, kMostBytes), where);
}

ordered_json to_json(const Answers& answers) {
  ordered_json intervals = ordered_json::array();
  for (const IntervalAnswers& one : answers.intervals) {
    ordered_json& out =
        intervals.emplace_back(ordered_json{{"id", one.id}, {"guarantee", to_string(one.claim)}});
    if (one.collides) out["collides"] = *one.collides;
    if (one.first_time) out["first_time"] = *one.first_time ? ordered_json(**one.first_time) : ordered_json();
    if (one.starts_embedded) out["starts_embedded"] = *one.starts_embedded;
    if (one.start_pairs) {
      out["start_pairs"] = ordered_json::array();
      for (const CrossingPair& pair : *one.start_pairs)
        out["start_pairs"].push_back(
            {static_cast<std::int32_t>(pair.first), static_cast<std::int32_t>(pair.second)});
    }
    if (one.contacts) {
      out["contacts"] = ordered_json::array();
      for (const AnsweredContact& contact : *one.contacts) {
        ordered_json& pair =
            out["contacts"].emplace_back(ordered_json{{key_of(contact.pair), numbers_json(contact.pair)}});
        if (contact.time)
          pair["time"] = *contact.time;
        else
          pair["undecided"] = true;
      }
    }
    if (one.milliseconds) out["milliseconds"] = *one.milliseconds;
  }
  ordered_json out = {{"schema", kAnswersSchema}, {"program", answers.program}};
  if (!answers.version.empty()) out["version"] = answers.version;
  if (answers.benchmark) out["benchmark"] = *answers.benchmark;
  if (!answers.notes.is_null()) out["notes"] = answers.notes;
  out["answers"] = std::move(intervals);
  return out;
}

}  // namespace cscd::bench
