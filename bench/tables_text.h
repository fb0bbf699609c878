#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

#include "bench/claims.h"
#include "bench/paper_tables.h"
#include "bench/record.h"

namespace cscd::bench {

inline constexpr std::string_view kTablesSchema = "cscd.tables/1";

// Everything, for machines: one object a cell, one a claim. Valid under bench/tables.schema.json.
nlohmann::ordered_json tables_json(std::span<const PaperTable> tables, std::span<const ClaimResult> claims,
                                   std::span<const Record> records);
// For people: quantities down, scenes across; preceded by where the records come from.
std::string tables_markdown(std::span<const PaperTable> tables, std::span<const Record> records);
// For papers: the same tables for LaTeX with booktabs.
std::string tables_latex(std::span<const PaperTable> tables);
// One line a cell.
std::string tables_csv(std::span<const PaperTable> tables);

}  // namespace cscd::bench
