#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/records/record.h"
#include "bench/tables/claims.h"
#include "bench/tables/shaped_table.h"

// Tables for people: in a terminal, and as the page tables.md.
namespace cscd::bench {

// Something that is said beneath tables: where the figures come from, of the claims, of the fast engine.
struct Remark {
  std::string name, text;
};
std::vector<Remark> remarks(std::span<const ShapedTable> tables, std::span<const ClaimResult> claims,
                            std::span<const Record> records);

// The tables in aligned columns at most 100 wide, and the times of all strategies where no scene is the
// paper's; then the remarks, and `page`, the place of a page with everything else (left out where it is
// empty).
std::string tables_text(std::span<const ShapedTable> tables, std::span<const Remark> remarks,
                        const std::string& page);

// The tables, the claims in one line each, and how all of this was measured.
std::string tables_markdown(std::span<const ShapedTable> tables, std::span<const ClaimResult> claims,
                            std::span<const Record> records);

// One float of a paper for \input{}: a table* as wide as both columns of an article, or as the text of an
// article of one column. It is set in \footnotesize, and shrunk only where that is too wide. Needs booktabs
// and graphicx.
std::string latex_table(const ShapedTable& table);

}  // namespace cscd::bench
