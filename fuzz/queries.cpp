// Files of elementary queries in the public format. What is read is written and read again as it was.
#include "core/base/error.h"
#include "fuzz/target.h"
#include "scenes/queries/query_file.h"

namespace cscd::fuzz {
namespace {

std::vector<Query> read(Bytes bytes) {
  const InputFile file(bytes);
  return read_queries(file.path());
}

}  // namespace

void target(Bytes bytes) {
  std::vector<Query> queries;
  try {
    queries = read(bytes);
  } catch (const InputError&) {
    return;
  }
  if (queries.empty()) return;
  for (const Query& query : queries)
    if (query.truth.has_value() != queries[0].truth.has_value()) return;  // not to be written
  const std::string text = query_text(queries);
  const std::vector<Query> again = read({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  if (query_text(again) != text) broken("a query is not read as it was written");
}

}  // namespace cscd::fuzz
