#include "bench/inputs/own_output.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>

#include "bench/output/gzip.h"
#include "core/base/error.h"

namespace cscd::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostCompressed = std::uintmax_t{1}
                                           << 26;  // of a compressed file that is looked into
constexpr std::size_t kMostUnpacked = std::size_t{1} << 28;

struct Kind {
  std::string_view schema, is, then;  // FILE stands for the path
};
constexpr Kind kKinds[] = {
    {"cscd.run/", "is a record of cscd run",
     "cscd tables FILE shows it, cscd report FILE -o site makes a page of it"},
    {"cscd.query/", "is an answer of cscd query", "name the input that was asked about"},
    {"cscd.accuracy/", "is a record of cscd accuracy",
     "scripts/figures accuracy FILE --out FOLDER makes a page of it"},
    {"cscd.scale/", "is a record of cscd scale",
     "scripts/figures scale FILE --out FOLDER makes a page of it"},
    {"cscd.history/", "is an entry of a history", "cscd history FOLDER shows all of a folder"},
    {"cscd.compare/", "is a comparison by cscd compare", "cscd compare OLD NEW makes one of two records"},
    {"cscd.tables/", "holds tables that cscd tables wrote", "cscd tables RECORDS makes them of records"},
    {"cscd.benchmark/", "is the list of a benchmark",
     "cscd benchmark answer FOLDER takes the folder that it lies in"},
    {"cscd.answers/", "holds answers to a benchmark", "cscd benchmark judge BENCHMARK FILE judges them"},
    {"cscd.score/", "is a score of cscd benchmark judge",
     "cscd benchmark judge BENCHMARK ANSWERS makes one"}};
constexpr Kind kExtensions[] = {
    {".csv", "is a table", "cscd elementary FILE --kind vf reads queries of elementary tests"},
    {".html", "is a page", "open it in a browser"}};

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::error_code error;
  if (path.extension() == ".gz") {
    if (fs::file_size(path, error) > kMostCompressed || error) return "";
    try {
      return without_gzip({std::istreambuf_iterator<char>(file), {}}, path.string(), kMostUnpacked);
    } catch (const InputError&) {
      return "";  // whoever opens the file says what is wrong with it
    }
  }
  if (fs::file_size(path, error) > kMostUnpacked || error) return "";
  return {std::istreambuf_iterator<char>(file), {}};
}

// The schema that a JSON file names, before or behind all that it holds; empty for other files.
std::string schema_in(std::string_view text) {
  const std::size_t brace = text.find_first_not_of(" \t\r\n");
  if (brace == std::string_view::npos || text[brace] != '{') return "";
  const std::size_t key = text.find("\"schema\"");
  if (key == std::string_view::npos) return "";
  const std::size_t colon = text.find(':', key), from = text.find('"', colon);
  if (from == std::string_view::npos) return "";
  const std::size_t to = text.find('"', from + 1);
  return to == std::string_view::npos ? "" : std::string(text.substr(from + 1, to - from - 1));
}

std::string said(const Kind& kind, const std::string& path) {
  std::string then(kind.then);
  for (std::size_t at = 0; (at = then.find("FILE", at)) != std::string::npos; at += path.size())
    then.replace(at, 4, path);
  return std::string(kind.is) + "; " + then;
}

}  // namespace

std::string why_own_output(const std::string& name) {
  const fs::path path(name);
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return "";
  for (const Kind& kind : kExtensions)
    if (path.extension() == kind.schema) return said(kind, name);
  if (path.extension() != ".json" && path.extension() != ".gz") return "";
  const std::string schema = schema_in(content(path));
  for (const Kind& kind : kKinds)
    if (schema.starts_with(kind.schema)) return said(kind, name);
  if (schema.starts_with("cscd.") && !schema.starts_with("cscd.scene/"))
    return "was written by cscd (" + schema +
           ") and is no input; name a scene, a scene file, a point cache or a model file";
  return "";
}

}  // namespace cscd::bench
