#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

#include "bench/paper_tables.h"
#include "bench/record.h"

namespace cscd::bench {

inline constexpr std::string_view kTablesSchema = "cscd.tables/1";

// Everything, for machines: one object a cell.
nlohmann::ordered_json tables_json(std::span<const PaperTable> tables, std::span<const Record> records);
// For people: published, measured, 95 % interval; preceded by where the records come from.
std::string tables_markdown(std::span<const PaperTable> tables, std::span<const Record> records);
// One line a cell.
std::string tables_csv(std::span<const PaperTable> tables);

}  // namespace cscd::bench
