#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/records/record.h"
#include "bench/tables/quantity.h"

// What the paper claims in its text and tables, held against records. The claims are data:
// bench/tables/claims.json.
namespace cscd::bench {

enum class ClaimVerdict { reproduced, partly, not_reproduced, not_measured };
std::string_view to_string(ClaimVerdict verdict);

// One measured figure that a claim speaks about.
struct Evidence {
  std::string scene, title;
  Measured measured;
  bool holds = false;  // false too where nothing was measured
  // The figure in the pipeline `today`, to be shown beside. There is none if the claim is held against that
  // pipeline, if that pipeline has no record of the scene, or if the figure compares the two pipelines.
  std::optional<Measured> today = std::nullopt;
};

// Where the time goes in one strategy on one scene, for a claim about times that is missed somewhere.
struct StageFigure {
  std::string scene, title;
  std::optional<Measured> published, today;  // by pipeline; none without a record
  std::optional<double> paper;
};

struct ClaimResult {
  std::string id, quote, where, expectation;
  ClaimVerdict verdict = ClaimVerdict::not_measured;
  Pipeline held_against = Pipeline::vectorised;
  std::vector<Evidence> evidence;
  std::vector<StageFigure> stages;   // of the scenes on which the claim is missed, by scene, then by title
  std::string not_measured_because;  // empty for a claim that is measured
};

// A claim has `quote`, `where`, `scenes`, `measure` (definitions as in bench/tables/quantity.h, each with a
// title; all must hold in a scene), `expect` ({"least": .., "most": ..}, either may be left out). A
// claim without `measure` cannot be measured here, for the reason in `not_measured_because`. Explanations of
// what differs belong to a scene and a record, and stand in notes beside the record. With `somewhere`, one
// scene is enough. Reproduced: every figure that was measured holds; partly: some; scenes without a record do
// not count. Claims are held against the pipeline `published` where there is any record of it, and else
// against `today`. A row of `stages` names the paper's figures for it (`published`: lists of factors, of
// which the first that is complete counts) and the strategies that they are not of (`published_not_of`). A
// definition with `over_pipeline` divides the figure of its `pipeline` by that of another.
// A record from which nothing is to be claimed (no_claims_text) counts as none, and the claims that it would
// be about say why.
std::vector<ClaimResult> judge_claims(std::span<const Record> records);
// The same with other claims.
std::vector<ClaimResult> judge_claims(const nlohmann::ordered_json& claims, std::span<const Record> records);

// Whether any claim could be held against a record at all.
bool any_measured(std::span<const ClaimResult> claims);

nlohmann::ordered_json claims_json(std::span<const ClaimResult> claims);
std::string claims_markdown(std::span<const ClaimResult> claims);

}  // namespace cscd::bench
