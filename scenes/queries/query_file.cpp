#include "scenes/queries/query_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <gmpxx.h>
#include <string>
#include <string_view>

#include "core/base/error.h"

namespace cscd {
namespace {

constexpr std::size_t kRowsPerQuery = 8;

// A line of a file, for error messages.
struct Place {
  const std::filesystem::path& file;
  std::size_t line;
};

// Throws an InputError about the place.
[[noreturn]] void fail(const Place& place, const std::string& what) {
  throw InputError(place.file.string() + ", line " + std::to_string(place.line) + ": " + what);
}

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string quoted(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string result("'");
  result.append(text.substr(0, longest));
  result.append(text.size() <= longest ? "'" : "...'");
  return result;
}

std::vector<std::string_view> columns(std::string_view row) {
  std::vector<std::string_view> cells;
  for (;;) {
    const std::size_t comma = row.find(',');
    cells.push_back(trimmed(row.substr(0, comma)));
    if (comma == std::string_view::npos) return cells;
    row.remove_prefix(comma + 1);
  }
}

mpz_class parse_integer(std::string_view cell, const Place& place) {
  const std::string_view digits = !cell.empty() && cell.front() == '-' ? cell.substr(1) : cell;
  const bool whole = !digits.empty() &&
                     std::all_of(digits.begin(), digits.end(), [](char c) { return '0' <= c && c <= '9'; });
  if (whole) return mpz_class(std::string(cell), 10);
  std::string lower(digits);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (lower == "inf" || lower == "infinity" || lower == "nan")
    fail(place, quoted(cell) + " is not finite; leave out queries with such coordinates");
  fail(place,
       quoted(cell) + " is not an integer; write each coordinate as the two integers numerator,denominator");
}

double parse_coordinate(std::string_view numerator, std::string_view denominator, const Place& place) {
  mpq_class value(parse_integer(numerator, place), parse_integer(denominator, place));
  if (value.get_den() == 0)
    fail(place, "the denominator of " + quoted(numerator) + " is zero; write a number other than zero");
  value.canonicalize();
  const double nearest = value.get_d();
  if (!std::isfinite(nearest))
    fail(place, quoted(numerator) + " over " + quoted(denominator) +
                    " is beyond the largest double; scale the query down by a power of two");
  if (mpq_class(nearest) != value)
    fail(place, quoted(numerator) + " over " + quoted(denominator) +
                    " is not exactly a double; round it and write the double's exact value");
  return nearest;
}

bool parse_truth(std::string_view cell, const Place& place) {
  if (cell != "0" && cell != "1")
    fail(place, "the truth " + quoted(cell) + " is neither 0 nor 1; write one of them");
  return cell == "1";
}

}  // namespace

MovingVertexFace as_vertex_face(const Query& query) {
  return {query.points[0], {query.points[1], query.points[2], query.points[3]}};
}

MovingEdgeEdge as_edge_edge(const Query& query) {
  return {{query.points[0], query.points[1]}, {query.points[2], query.points[3]}};
}

std::vector<Query> read_queries(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream || std::filesystem::is_directory(file))
    throw InputError(file.string() + ": cannot be read; name an existing file of queries");
  std::vector<Query> queries;
  std::size_t line_number = 0, rows = 0, width = 0;
  bool blank_before = false;
  for (std::string line; std::getline(stream, line);) {
    const Place place{file, ++line_number};
    if (trimmed(line).empty()) {
      blank_before = true;
      continue;
    }
    if (blank_before) fail({file, line_number - 1}, "the line is empty; remove it");
    const std::vector<std::string_view> cells = columns(line);
    if (cells.size() != 6 && cells.size() != 7)
      fail(place, "has " + std::to_string(cells.size()) +
                      " columns; write x_num,x_den,y_num,y_den,z_num,z_den and at most one more, the truth");
    if (width != 0 && cells.size() != width)
      fail(place, "has " + std::to_string(cells.size()) + " columns and the rows before have " +
                      std::to_string(width) + "; give the truth in every row or in none");
    width = cells.size();

    const std::size_t row = rows++ % kRowsPerQuery;
    if (row == 0) queries.emplace_back();
    Query& query = queries.back();
    Vec3& position = row < 4 ? query.points[row].start : query.points[row - 4].end;
    for (std::size_t k = 0; k < 3; ++k)
      position[static_cast<Eigen::Index>(k)] = parse_coordinate(cells[2 * k], cells[2 * k + 1], place);
    if (width == 7) {
      const bool truth = parse_truth(cells[6], place);
      if (row != 0 && truth != query.truth)
        fail(place, "the truth differs from the row before; give all eight rows of a query the same");
      query.truth = truth;
    }
  }
  if (stream.bad()) throw InputError(file.string() + ": reading failed; check the disk and try again");
  if (rows == 0) throw InputError(file.string() + ": the file has no rows; write eight for each query");
  if (rows % kRowsPerQuery != 0)
    fail({file, line_number}, "the file ends within a query, after " + std::to_string(rows) +
                                  " rows; write eight rows for each query");
  return queries;
}

std::string query_text(std::span<const Query> queries) {
  std::string text;
  for (const Query& query : queries)
    for (const bool end : {false, true})
      for (const MovingPoint& point : query.points) {
        const Vec3& p = end ? point.end : point.start;
        for (int axis = 0; axis < 3; ++axis) {
          const mpq_class value(p[axis]);
          text += (axis ? "," : "") + value.get_num().get_str() + "," + value.get_den().get_str();
        }
        if (query.truth) text += *query.truth ? ",1" : ",0";
        text += '\n';
      }
  return text;
}

}  // namespace cscd
