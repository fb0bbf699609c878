#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "scenes/base/text_encoding.h"
#include "scenes/exchange/surface_file.h"
#include "scenes/exchange/text_lines.h"

namespace cscd::scenes {
namespace {

// Statements of OBJ files that say nothing of faces and their vertices.
constexpr std::string_view kOtherStatements[] = {
    "vt",         "vn",        "vp",    "cstype",   "deg",    "bmat",     "step",   "parm",
    "trim",       "hole",      "scrv",  "sp",       "end",    "con",      "g",      "s",
    "mg",         "o",         "bevel", "c_interp", "lod",    "d_interp", "usemtl", "mtllib",
    "shadow_obj", "trace_obj", "ctech", "stech",    "usemap", "maplib",   "res",    "csh"};
constexpr std::string_view kLines[] = {"p", "l"};
constexpr std::string_view kCurves[] = {"curv", "curv2", "surf", "bsp", "bzp", "cdc", "cdp"};

template <std::size_t Count>
bool is_one_of(std::string_view word, const std::string_view (&words)[Count]) {
  return std::find(std::begin(words), std::end(words), word) != std::end(words);
}

// Programs that join files leave the byte order mark of each before its first line.
std::string_view without_mark(std::string_view word) {
  return word.starts_with("\xEF\xBB\xBF") ? word.substr(3) : word;
}

// Whether a word may be meant as the statement of a vertex or a face, with its first number behind it or not.
bool looks_like_vertex_or_face(std::string_view word) {
  if (word == "fo") return true;
  const char letter = word.empty() ? ' ' : static_cast<char>(word.front() | 0x20);  // in lower case
  return (letter == 'v' || letter == 'f') &&
         (word.size() == 1 || std::string_view("+-.,0123456789/").find(word[1]) != word.npos);
}

bool is_foreign(char c) {
  return c < '!' || c > '~';
}

// A word without quotation marks and without what is not seen, such as a no-break space.
std::string plain(std::string_view word) {
  std::string letters;
  std::ranges::copy_if(word, std::back_inserter(letters),
                       [](char c) { return !is_foreign(c) && c != '"' && c != '\'' && c != '`'; });
  return letters;
}

class ObjReader {
 public:
  explicit ObjReader(std::string_view text) : lines_(text) {}

  SurfaceFile read() {
    while (lines_.next()) {
      const std::string_view kind = without_mark(word());
      const bool goes_on = std::exchange(goes_on_, false);
      if (kind == "v")
        read_vertex();
      else if (kind == "f" || kind == "fo")  // fo: the old name of a face
        read_face();
      else if (!kind.empty())
        pass_over(kind, goes_on);
    }
    require_vertices();
    if (curves_ > 0)
      surface_.notes.push_back(std::to_string(curves_) +
                               " curves and surfaces that are no polygons left out");
    if (unknown_ == 1)
      surface_.notes.push_back("line " + std::to_string(first_unknown_) +
                               " begins with a word that OBJ files do not have, and is left out");
    if (unknown_ > 1)
      surface_.notes.push_back(std::to_string(unknown_) +
                               " lines begin with words that OBJ files do not have, as line " +
                               std::to_string(first_unknown_) + " does, and are left out");
    return std::move(surface_);
  }

 private:
  // The next word of a statement, which a backslash at the end of a line continues on the next line; empty at
  // its end. A comment goes from # to the end of the line. The # of 1.#IND, which is how Windows writes what
  // is not a number, begins none.
  std::string_view word() {
    for (;;) {
      std::string_view word = lines_.word();
      std::size_t comment = word.find('#');
      while (comment != word.npos && comment > 0 && word[comment - 1] == '.')
        comment = word.find('#', comment + 1);
      if (comment != word.npos) {
        lines_.leave_line();
        word = word.substr(0, comment);
      }
      if (!word.ends_with('\\')) return word;
      word.remove_suffix(1);
      if (const std::string_view rest = lines_.word(); !rest.empty() && !rest.starts_with('#'))
        lines_.fail("a backslash stands before the end of the line");
      lines_.next();
      if (!word.empty()) return word;
    }
  }

  void read_vertex() {
    Vec3 x;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view coordinate = word();
      if (coordinate.empty()) lines_.fail("has " + std::to_string(axis) + " coordinates of 3");
      x[axis] = lines_.number(coordinate, "coordinate");
    }
    surface_.positions.push_back(x);
    // A weight, which is of curves alone, or a colour may follow, or both.
    std::size_t further = 0;
    for (std::string_view more = word(); !more.empty(); more = word(), ++further)
      if (const std::optional<double> number = number_of(more); !number || !std::isfinite(*number))
        lines_.fail(lines_.quoted(more) + " stands behind a vertex and is no number");
    if (further == 2 || further > 4)
      lines_.fail("a vertex has " + std::to_string(3 + further) +
                  " numbers; write three, or a colour behind them");
  }

  void read_face() {
    const std::size_t first = surface_.faces.corners.size();
    for (std::string_view corner = word(); !corner.empty(); corner = word())
      surface_.faces.corners.push_back(read_corner(corner));
    if (surface_.faces.corners.size() - first < 3) lines_.fail("a face has fewer than three corners");
    surface_.faces.ends.push_back(surface_.faces.corners.size());
  }

  // Returns the vertex of a corner such as 7, 7/1, 7//3 or -1.
  std::int32_t read_corner(std::string_view corner) {
    std::string_view digits = corner.substr(0, corner.find('/'));
    if (digits.starts_with('+') && !digits.starts_with("+-")) digits.remove_prefix(1);
    std::int64_t index = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
    if (digits.empty() || error != std::errc{} || end != digits.data() + digits.size())
      lines_.fail(lines_.quoted(corner) + " is no vertex number");
    // Negative numbers count back from the vertex read last.
    const std::int64_t vertex =
        index < 0 ? static_cast<std::int64_t>(surface_.positions.size()) + index : index - 1;
    if (vertex < 0 || vertex >= static_cast<std::int64_t>(kMostInSurfaceFile))
      lines_.fail(lines_.quoted(corner) + " names no vertex");
    if (vertex > highest_) {
      highest_ = vertex;
      line_of_highest_ = lines_.line_number();
    }
    return static_cast<std::int32_t>(vertex);
  }

  [[noreturn]] void refuse(std::string_view kind) const {
    if (kind.find('\0') != kind.npos) lines_.fail("holds a byte 0, so it is no text");
    const std::string shown = lines_.quoted(kind) + " is no statement";
    lines_.fail(looks_like_vertex_or_face(plain(kind))
                    ? shown + ", although it looks like a vertex or a face"
                    : shown + "; it holds bytes that no statement has, each shown as a question mark");
  }

  // Passes over a line that is neither a vertex nor a face, but for one that may be meant as such.
  void pass_over(std::string_view kind, bool goes_on) {
    const bool known =
        is_one_of(kind, kOtherStatements) || is_one_of(kind, kLines) || is_one_of(kind, kCurves);
    if (looks_like_vertex_or_face(plain(kind)) && !known) refuse(kind);
    // The words of a name that goes on from the line before may be of any letters.
    if (!goes_on && std::ranges::any_of(kind, is_foreign)) refuse(kind);
    if (kind == "call") lines_.fail("has another file read in its place, which is not followed");
    surface_.points_and_lines += is_one_of(kind, kLines);
    curves_ += is_one_of(kind, kCurves);
    if (!known && !goes_on && unknown_++ == 0) first_unknown_ = lines_.line_number();
    for (std::string_view last = lines_.word(); !last.empty(); last = lines_.word())
      goes_on_ = last.ends_with('\\');
  }

  // Faces may come before the vertices that they name.
  void require_vertices() const {
    const std::size_t count = surface_.positions.size();
    if (count > 0 && highest_ >= static_cast<std::int64_t>(count))
      throw InputError("line " + std::to_string(line_of_highest_) + ": a face names vertex " +
                       std::to_string(highest_ + 1) + ", and the file has " + std::to_string(count) +
                       " vertices; export the file again");
    require_sound(surface_);
  }

  TextLines lines_;
  SurfaceFile surface_;
  bool goes_on_ = false;       // the line before ends with a backslash and was passed over
  std::int64_t highest_ = -1;  // of all vertices that faces name
  std::size_t line_of_highest_ = 0, first_unknown_ = 0;
  std::size_t curves_ = 0, unknown_ = 0;  // counts
};

}  // namespace

SurfaceFile read_obj(std::string_view text) {
  return ObjReader(without_byte_order_mark(text)).read();
}

}  // namespace cscd::scenes
