#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

#include "bench/records/record.h"
#include "bench/tables/claims.h"
#include "bench/tables/filled_tables.h"
#include "bench/tables/shaped_table.h"

namespace cscd::bench {

inline constexpr std::string_view kTablesSchema = "cscd.tables/2";

// The one document of figures: one object a cell and a claim, each with its text, and the tables as people
// read them, with those of pages. Terminal, LaTeX, Markdown, scripts and the page place these texts as they
// are. Valid under bench/tables/tables.schema.json.
nlohmann::ordered_json tables_json(std::span<const FilledTable> tables, std::span<const ShapedTable> shaped,
                                   std::span<const ClaimResult> claims, std::span<const Record> records);
// The same cells for spreadsheets, one line a cell.
std::string tables_csv(std::span<const FilledTable> tables);

}  // namespace cscd::bench
