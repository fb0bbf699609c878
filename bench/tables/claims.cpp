#include "bench/tables/claims.h"

#include <algorithm>

#include "bench/output/data.h"
#include "bench/output/markdown.h"
#include "bench/tables/distinct.h"
#include "bench/tables/filled_tables.h"
#include "bench/tables/run_times.h"
#include "core/base/number_text.h"
#include "scenes/base/joined.h"

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

bool within(double value, const ordered_json& expect) {
  return (!expect.contains("least") || value >= expect["least"].get<double>()) &&
         (!expect.contains("most") || value <= expect["most"].get<double>());
}

std::string bounds_text(const ordered_json& expect) {
  std::string out;
  if (expect.contains("least")) out += "at least " + exact_text(expect["least"]);
  if (expect.contains("most"))
    out += (out.empty() ? "at most " : " and at most ") + exact_text(expect["most"]);
  return out;
}

ClaimVerdict judge(const std::vector<Evidence>& evidence, bool somewhere) {
  std::size_t measured = 0, holding = 0;
  for (const Evidence& e : evidence) {
    measured += e.measured.value.has_value();
    holding += e.holds;
  }
  if (measured == 0) return ClaimVerdict::not_measured;
  if (holding == measured || (somewhere && holding > 0)) return ClaimVerdict::reproduced;
  return holding > 0 ? ClaimVerdict::partly : ClaimVerdict::not_reproduced;
}

// The paper's scenes alone: not a scene of the user's own, even if it has that name.
const Record* record_of(std::span<const Record> records, const std::string& scene, Pipeline pipeline) {
  const Record* record = find_record(records, scene, pipeline);
  return record != nullptr && record->scene.path.empty() ? record : nullptr;
}

// A claim is held against the pipeline `published` where there is such a record of a scene that the claim is
// about, and else against `today`.
Pipeline held_against(const ordered_json& claim, std::span<const Record> records) {
  if (claim.contains("scenes"))
    for (const std::string scene : claim["scenes"])
      if (record_of(records, scene, Pipeline::published) != nullptr) return Pipeline::published;
  return Pipeline::vectorised;
}

Measured no_record_in(Pipeline pipeline) {
  return {{}, {}, "no record in the pipeline " + std::string(to_string(pipeline))};
}

Measured measured_in(const ordered_json& definition, std::span<const Record> records,
                     const std::string& scene, Pipeline pipeline) {
  const auto find = [&](Pipeline wanted) { return record_of(records, scene, wanted); };
  if (!definition.contains("over_pipeline")) {
    const Record* record = find(pipeline);
    return record == nullptr ? no_record_in(pipeline) : measure(definition, *record);
  }
  const Pipeline first = pipeline_named(definition.at("pipeline").get<std::string>()),
                 second = pipeline_named(definition.at("over_pipeline").get<std::string>());
  for (const Pipeline wanted : {first, second})
    if (find(wanted) == nullptr) return no_record_in(wanted);
  return measure_over(definition, *find(first), *find(second));
}

bool is_about_times(const ordered_json& definition) {
  return definition.at("quantity").get<std::string>().starts_with("ms.");
}

// The paper's figure for a row of stages: a figure of its tables, or a product of two, as a total is the
// total of its own method times the speedup.
std::optional<double> paper_figure(const ordered_json& row, const std::string& strategy,
                                   const ordered_json& published, const std::string& scene) {
  const ordered_json not_of = row.value("published_not_of", ordered_json::array());
  if (std::ranges::find(not_of, ordered_json(strategy)) != not_of.end()) return std::nullopt;
  for (const ordered_json& paths : row.value("published", ordered_json::array())) {
    std::optional<double> product = 1;
    for (const std::string path : paths) {
      const ordered_json* figure = find_published(published, replaced(path, "{strategy}", strategy), scene);
      product = product && figure != nullptr ? std::optional(*product * figure->get<double>()) : std::nullopt;
    }
    if (product) return product;
  }
  return std::nullopt;
}

// Where the time goes in the strategies that a claim compares, on a scene where it is missed.
void add_stages(const ordered_json& rows, const std::vector<std::string>& strategies,
                const std::string& scene, std::span<const Record> records, std::vector<StageFigure>& out) {
  const ordered_json published = data_json("published.json");
  for (const std::string& strategy : strategies)
    for (ordered_json row : rows) {
      row["strategy"] = strategy;
      StageFigure figure{scene,
                         strategy + ": " + row.at("title").get<std::string>(),
                         {},
                         {},
                         paper_figure(row, strategy, published, scene)};
      for (const Pipeline pipeline : {Pipeline::published, Pipeline::vectorised})
        if (const Record* record = record_of(records, scene, pipeline))
          (pipeline == Pipeline::published ? figure.published : figure.today) = measure(row, *record);
      const auto has = [](const std::optional<Measured>& m) { return m && m->value; };
      if (has(figure.published) || has(figure.today)) out.push_back(std::move(figure));
    }
}

ClaimResult judge(const ordered_json& claim, const ordered_json& stage_rows,
                  std::span<const Record> records) {
  ClaimResult result;
  result.id = claim.at("id");
  result.quote = claim.at("quote");
  result.where = claim.at("where");
  result.held_against = held_against(claim, records);
  if (!claim.contains("measure")) {
    result.not_measured_because = claim.at("not_measured_because");
    return result;
  }
  result.expectation = bounds_text(claim.at("expect"));
  for (const std::string scene : claim.at("scenes")) {
    const Record* const today = record_of(records, scene, Pipeline::vectorised);
    if (today == nullptr && record_of(records, scene, Pipeline::published) == nullptr) continue;
    std::vector<std::string> compared;  // on this scene, in vain
    for (const ordered_json& definition : claim["measure"]) {
      Evidence& evidence = result.evidence.emplace_back();
      evidence.scene = scene;
      evidence.title = definition.at("title");
      evidence.measured = measured_in(definition, records, scene, result.held_against);
      evidence.holds = evidence.measured.value && within(*evidence.measured.value, claim["expect"]);
      if (result.held_against != Pipeline::vectorised && today != nullptr &&
          !definition.contains("over_pipeline"))
        evidence.today = measure(definition, *today);
      if (evidence.holds || !evidence.measured.value || !is_about_times(definition)) continue;
      for (const char* key : {"strategy", "over"}) {
        const std::string name = definition.value(key, "");
        if (!name.empty()) add_new(compared, name);
      }
    }
    add_stages(stage_rows, compared, scene, records, result.stages);
  }
  if (result.evidence.empty())
    result.not_measured_because = "No record of a scene that the claim is about was given: " +
                                  joined(claim.at("scenes").get<std::vector<std::string>>()) + ".";
  result.verdict = judge(result.evidence, claim.value("somewhere", false));
  if (result.verdict == ClaimVerdict::reproduced) result.stages.clear();
  return result;
}

std::string figure_or_reason(const Measured& measured) {
  return measured.value ? text_of(measured, false) : measured.reason;
}

std::string figure(const Evidence& evidence) {
  if (evidence.holds || !evidence.measured.value) return figure_or_reason(evidence.measured);
  const std::string mark(evidence.measured.marked ? kShortfallMark : "");
  return "**" + figure_text(*evidence.measured.value) + "**" + mark;
}

bool same(const Measured& a, const Measured& b) {
  return a.value && b.value && *a.value == *b.value;
}

constexpr auto kScene = [](const auto& part) { return part.scene; };
constexpr auto kTitle = [](const auto& part) { return part.title; };

// The row of one figure, and beneath it what it is in the pipeline `today`, where that differs.
void add_rows(const std::string& title, std::span<const Evidence> evidence, const ClaimResult& claim,
              std::vector<std::vector<std::string>>& rows) {
  std::vector<const Evidence*> of_title;
  for (const Evidence& e : evidence)
    if (e.title == title) of_title.push_back(&e);
  const bool two = std::ranges::any_of(
      of_title, [](const Evidence* e) { return e->today && !same(e->measured, *e->today); });
  std::vector<std::string> held(1, title + (two ? ", " + std::string(to_string(claim.held_against)) : "")),
      beside(1, title + ", today");
  for (const Evidence* e : of_title) {
    held.push_back(figure(*e));
    beside.push_back(figure_or_reason(e->today.value_or(no_record_in(Pipeline::vectorised))));
  }
  rows.push_back(std::move(held));
  if (two) rows.push_back(std::move(beside));
}

std::string stages_markdown(const ClaimResult& claim) {
  const std::vector<std::string> scenes = distinct(claim.stages, kScene);
  std::vector<std::string> head(1, "where the time goes: `published`, `today` (the paper)");
  head.insert(head.end(), scenes.begin(), scenes.end());
  std::vector<std::vector<std::string>> rows;
  for (const std::string& title : distinct(claim.stages, kTitle)) {
    std::vector<std::string>& row = rows.emplace_back(1, title);
    for (const std::string& scene : scenes) {
      const auto place = std::ranges::find_if(
          claim.stages, [&](const StageFigure& s) { return s.scene == scene && s.title == title; });
      if (place == claim.stages.end()) {
        row.push_back("");
        continue;
      }
      const auto text = [](const std::optional<Measured>& m) {
        return m ? figure_or_reason(*m) : std::string("–");
      };
      row.push_back(text(place->published) + ", " + text(place->today) +
                    (place->paper ? " (" + figure_text(*place->paper) + ")" : ""));
    }
  }
  return markdown_table(head, rows);
}

}  // namespace

std::string_view to_string(ClaimVerdict verdict) {
  switch (verdict) {
    case ClaimVerdict::reproduced:
      return "reproduced";
    case ClaimVerdict::partly:
      return "partly";
    case ClaimVerdict::not_reproduced:
      return "not reproduced";
    case ClaimVerdict::not_measured:
      break;
  }
  return "not measured";
}

std::vector<ClaimResult> judge_claims(const ordered_json& claims, std::span<const Record> records) {
  std::vector<ClaimResult> results;
  const ordered_json stage_rows = claims.value("stages", ordered_json::array());
  for (const ordered_json& claim : claims.at("claims")) results.push_back(judge(claim, stage_rows, records));
  return results;
}

std::vector<ClaimResult> judge_claims(std::span<const Record> records) {
  std::vector<Record> whole;
  std::string why;  // the first that any record gives
  for (const Record& record : records) {
    const std::string text = no_claims_text(record);
    if (text.empty())
      whole.push_back(record);
    else if (why.empty())
      why = text;
  }
  std::vector<ClaimResult> results = judge_claims(data_json("claims.json"), whole);
  for (ClaimResult& claim : results)
    if (!why.empty() && claim.evidence.empty()) claim.not_measured_because += " Left out: " + why + ".";
  return results;
}

bool any_measured(std::span<const ClaimResult> claims) {
  return std::ranges::any_of(
      claims, [](const ClaimResult& claim) { return claim.verdict != ClaimVerdict::not_measured; });
}

ordered_json claims_json(std::span<const ClaimResult> claims) {
  ordered_json out = ordered_json::array();
  for (const ClaimResult& claim : claims) {
    ordered_json evidence = ordered_json::array();
    for (const Evidence& e : claim.evidence) {
      ordered_json& row = evidence.emplace_back(ordered_json{{"scene", e.scene}, {"title", e.title}});
      if (e.measured.value)
        row.update(
            {{"measured", *e.measured.value}, {"text", text_of(e.measured, false)}, {"holds", e.holds}});
      else
        row["reason"] = e.measured.reason;
      if (e.today && e.today->value)
        row.update({{"today", *e.today->value}, {"today_text", text_of(*e.today, false)}});
    }
    out.push_back({{"id", claim.id},
                   {"quote", claim.quote},
                   {"where", claim.where},
                   {"expectation", claim.expectation},
                   {"pipeline", to_string(claim.held_against)},
                   {"verdict", to_string(claim.verdict)},
                   {"evidence", std::move(evidence)},
                   {"why", claim.not_measured_because}});
  }
  return out;
}

std::string claims_markdown(std::span<const ClaimResult> claims) {
  std::string out =
      "# The paper's claims, held against the records\n\n"
      "A claim is *reproduced* when every measured figure lies where it says, *partly* when some do. Figures "
      "in bold\n"
      "do not. " +
      (std::ranges::all_of(claims,
                           [](const ClaimResult& c) { return c.held_against == Pipeline::vectorised; })
           ? std::string("The records are of the pipeline `today`: this project's code around every method.")
           : std::string("Claims are held against the pipeline `published`, the paper's code around every "
                         "method; `today` is\nthis project's, and stands beside it where it differs.")) +
      " Where a claim about times is missed, a\n"
      "second table shows the stages in milliseconds an interval, beside those of the paper, and the work "
      "that they do.\n"
      "There a dash stands where no record of that pipeline was given, and a cell is empty where the claim "
      "holds or the\n"
      "strategy has no such stage. The paper gives one refit for all methods with 16-DOPs. Its totals of "
      "base, mcd, aabb and\n"
      "selfccd are its speedups times its own total.\n"
      "What somebody has found out about the differences since stands in notes.md beside this page, "
      "if "
      "anywhere.\n";
  for (const ClaimResult& claim : claims) {
    out += "\n## " + claim.id + ": " + std::string(to_string(claim.verdict)) + "\n\n> " + claim.quote + " (" +
           claim.where + ")\n\n";
    const std::vector<std::string> titles = distinct(claim.evidence, kTitle),
                                   scenes = distinct(claim.evidence, kScene);
    if (!scenes.empty()) {
      std::vector<std::string> head = {"expected " + claim.expectation};
      head.insert(head.end(), scenes.begin(), scenes.end());
      std::vector<std::vector<std::string>> rows;
      for (const std::string& title : titles) add_rows(title, claim.evidence, claim, rows);
      out += markdown_table(head, rows) + "\n";
    }
    if (!claim.stages.empty()) out += stages_markdown(claim) + "\n";
    const auto marked = [](const Evidence& e) { return e.measured.marked || (e.today && e.today->marked); };
    if (std::ranges::any_of(claim.evidence, marked)) out += std::string("\\") + kShortfallMeaning + "\n";
    if (!claim.not_measured_because.empty()) out += claim.not_measured_because + "\n";
  }
  return out;
}

}  // namespace cscd::bench
