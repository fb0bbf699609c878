#include "bench/tables/claims.h"

#include <algorithm>

#include "bench/output/data.h"
#include "bench/output/markdown.h"

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

bool within(double value, const ordered_json& expect) {
  return (!expect.contains("least") || value >= expect["least"].get<double>()) &&
         (!expect.contains("most") || value <= expect["most"].get<double>());
}

std::string text_of(const ordered_json& expect) {
  std::string out;
  if (expect.contains("least")) out += "at least " + number_text(expect["least"]);
  if (expect.contains("most"))
    out += (out.empty() ? "at most " : " and at most ") + number_text(expect["most"]);
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

ClaimResult judge(const ordered_json& claim, std::span<const Record> records) {
  ClaimResult result;
  result.id = claim.at("id");
  result.quote = claim.at("quote");
  result.where = claim.at("where");
  if (!claim.contains("measure")) {
    result.not_measured_because = claim.at("not_measured_because");
    return result;
  }
  result.expectation = text_of(claim.at("expect"));
  for (const ordered_json& scene : claim.at("scenes")) {
    const auto record = std::find_if(records.begin(), records.end(), [&](const Record& candidate) {
      return candidate.scene.name == scene && candidate.scene.path.empty();
    });
    if (record == records.end()) continue;
    for (const ordered_json& definition : claim["measure"]) {
      Evidence& evidence = result.evidence.emplace_back();
      evidence.scene = scene;
      evidence.title = definition.at("title");
      evidence.measured = measure(definition, *record);
      evidence.holds = evidence.measured.value && within(*evidence.measured.value, claim["expect"]);
    }
  }
  result.verdict = judge(result.evidence, claim.value("somewhere", false));
  return result;
}

std::string figure(const Evidence& evidence) {
  if (!evidence.measured.value) return evidence.measured.reason;
  const std::string number = number_text(*evidence.measured.value);
  return evidence.holds ? number : "**" + number + "**";
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
  for (const ordered_json& claim : claims.at("claims")) results.push_back(judge(claim, records));
  return results;
}

std::vector<ClaimResult> judge_claims(std::span<const Record> records) {
  return judge_claims(data_json("claims.json"), records);
}

ordered_json claims_json(std::span<const ClaimResult> claims) {
  ordered_json out = ordered_json::array();
  for (const ClaimResult& claim : claims) {
    ordered_json evidence = ordered_json::array();
    for (const Evidence& e : claim.evidence) {
      ordered_json& row = evidence.emplace_back(ordered_json{{"scene", e.scene}, {"title", e.title}});
      if (e.measured.value)
        row.update({{"measured", *e.measured.value}, {"holds", e.holds}});
      else
        row["reason"] = e.measured.reason;
    }
    out.push_back({{"id", claim.id},
                   {"quote", claim.quote},
                   {"where", claim.where},
                   {"expectation", claim.expectation},
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
      "do not. What somebody has found out about the differences since stands in notes.md beside this page, "
      "if "
      "anywhere.\n";
  for (const ClaimResult& claim : claims) {
    out += "\n## " + claim.id + ": " + std::string(to_string(claim.verdict)) + "\n\n> " + claim.quote + " (" +
           claim.where + ")\n\n";
    std::vector<std::string> titles, scenes;
    for (const Evidence& e : claim.evidence) {
      if (std::find(titles.begin(), titles.end(), e.title) == titles.end()) titles.push_back(e.title);
      if (std::find(scenes.begin(), scenes.end(), e.scene) == scenes.end()) scenes.push_back(e.scene);
    }
    if (!scenes.empty()) {
      std::vector<std::string> head = {"expected " + claim.expectation};
      head.insert(head.end(), scenes.begin(), scenes.end());
      std::vector<std::vector<std::string>> rows;
      for (std::size_t t = 0; t < titles.size(); ++t) {
        std::vector<std::string>& row = rows.emplace_back(1, titles[t]);
        for (std::size_t s = 0; s < scenes.size(); ++s)
          row.push_back(figure(claim.evidence[s * titles.size() + t]));
      }
      out += markdown_table(head, rows);
      out += "\n";
    }
    if (!claim.not_measured_because.empty()) out += claim.not_measured_because + "\n";
  }
  return out;
}

}  // namespace cscd::bench
