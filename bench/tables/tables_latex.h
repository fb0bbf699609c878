#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "bench/tables/paper_tables.h"

namespace cscd::bench {

// One float of a paper: `text` goes to NAME.tex, to be taken in by \input{NAME}.
struct LatexTable {
  std::string name, text;
};

// Returns the tables for a two-column article, each as a table* of its own: quantities down, scenes across,
// measured figures and the paper's in columns of their own, intervals in small type beneath. They need
// booktabs, tabularx and siunitx. A table that does not fit on a page or in its width goes on in further
// files, NAME-2.tex and so on. Tables of more than kMostLatexRows quantities are left out.
inline constexpr std::size_t kMostLatexRows = 60;
std::vector<LatexTable> latex_tables(std::span<const PaperTable> tables);

}  // namespace cscd::bench
