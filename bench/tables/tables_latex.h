#pragma once

#include <span>
#include <string>

#include "bench/tables/shaped_table.h"

namespace cscd::bench {

// One float of a paper for \input{}: a table* as wide as both columns of an article, or as the text of an
// article of one column. It is set in \footnotesize, and shrunk only where that is too wide. Needs booktabs
// and graphicx.
std::string latex_table(const ShapedTable& table);

}  // namespace cscd::bench
