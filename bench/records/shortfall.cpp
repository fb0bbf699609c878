#include "bench/records/shortfall.h"

#include <algorithm>
#include <array>

namespace cscd::bench {

bool needs_embedded_start(const std::string& guarantee) {
  using enum Guarantee;
  return std::ranges::any_of(
      std::array{complete, first_contact, all_from_embedded, heuristic},
      [&](Guarantee one) { return to_string(one) == guarantee && cscd::needs_embedded_start(one); });
}

bool is_short(const Shortfall& lacking) {
  return lacking.contacts_found < lacking.contacts_expected || lacking.void_intervals > 0;
}

std::optional<Shortfall> shortfall(const VerificationRecord& verification, const VerifiedStrategy& row) {
  const Shortfall lacking{row.contacts_expected, row.contacts_found, verification.intervals.size(),
                          needs_embedded_start(row.guarantee) ? verification.unembedded.size() : 0};
  return is_short(lacking) ? std::optional(lacking) : std::nullopt;
}

std::optional<Shortfall> shortfall(const Record& record, std::string_view strategy) {
  const VerifiedStrategy* row = record.verification.strategy(strategy);
  return row == nullptr ? std::nullopt : shortfall(record.verification, *row);
}

std::string shortfall_text(const Shortfall& lacking) {
  std::string out;
  if (lacking.contacts_found < lacking.contacts_expected)
    out = "kept " + std::to_string(lacking.contacts_found) + " of " +
          std::to_string(lacking.contacts_expected) + " contacts";
  if (lacking.void_intervals > 0)
    out += (out.empty() ? "promise void on " : "; promise void on ") +
           std::to_string(lacking.void_intervals) + " of " + std::to_string(lacking.intervals) + " intervals";
  return out;
}

std::string shortfall_note(std::span<const Record> records) {
  std::string out;
  bool is_void = false, is_thick = false;
  for (const Record& record : records) {
    std::string rows;
    for (const StrategyRecord& row : record.strategies)
      if (const auto lacking = shortfall(record, row.name)) {
        rows += (rows.empty() ? "" : ", ") + row.name + " (" + shortfall_text(*lacking) + ")";
        is_void = is_void || lacking->void_intervals > 0;
        is_thick = is_thick || record.thickness > 0;
      }
    if (!rows.empty())
      out += "- " + record.scene.name + ", pipeline " + std::string(to_string(record.pipeline)) + ": " +
             rows + "\n";
  }
  if (out.empty()) return out;
  return kShortfallMeaning +
         (is_void ? ".\nA promise is void on an interval whose start is not embedded: the surface crosses "
                    "itself there" +
                        std::string(is_thick ? ", or with a thickness, something is close" : "")
                  : "") +
         ".\n" + out;
}

}  // namespace cscd::bench
