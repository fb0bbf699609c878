#include "scenes/exchange/sequence_files.h"

#include <cctype>
#include <charconv>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>

#include "core/base/error.h"

namespace cscd::scenes {
namespace {

namespace fs = std::filesystem;

std::string in_lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool is_cache(const fs::path& path) {
  const std::string extension = in_lower_case(path.extension().string());
  return extension == ".pc2" || extension == ".mdd";
}

// A name cut at its last number: "walk.", 1, ".obj".
struct FrameName {
  std::string before, after;
  auto operator<=>(const FrameName&) const = default;
};
using Frames = std::multimap<std::int64_t, fs::path>;

bool joins_words(std::string_view before_dash) {
  return !before_dash.empty() && std::isalnum(static_cast<unsigned char>(before_dash.back())) != 0;
}

// Returns nothing for a name without a number, or with one of too many digits.
std::optional<std::pair<FrameName, std::int64_t>> cut(const fs::path& path) {
  constexpr std::string_view kDigits = "0123456789";
  const std::string stem = path.stem().string();
  const std::size_t last = stem.find_last_of(kDigits);
  if (last == std::string::npos) return std::nullopt;
  std::size_t first = stem.find_last_not_of(kDigits, last) + 1;  // npos + 1 is 0
  const std::string digits = stem.substr(first, last + 1 - first);
  std::int64_t number = 0;
  if (std::from_chars(digits.data(), digits.data() + digits.size(), number).ec != std::errc{})
    return std::nullopt;
  const char sign = first > 0 ? stem[first - 1] : ' ';
  if ((sign == '-' || sign == '+') && !joins_words(std::string_view(stem).substr(0, first - 1))) {
    --first;
    if (sign == '-') number = -number;
  }
  return std::pair(
      FrameName{stem.substr(0, first), stem.substr(last + 1) + in_lower_case(path.extension().string())},
      number);
}

// All files of a folder that lie in it by name, but for hidden ones.
std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (!entry.path().filename().string().starts_with('.')) files.push_back(entry.path());
  if (error) throw InputError("its folder cannot be read; check the permissions");
  return files;
}

std::map<FrameName, Frames> sequences_in(const std::vector<fs::path>& files) {
  std::map<FrameName, Frames> sequences;
  for (const fs::path& file : files) {
    if (!is_mesh_sequence_file(file)) continue;
    if (const auto name = cut(file)) sequences[name->first].emplace(name->second, file);
  }
  return sequences;
}

// Programs that put a number behind a word without a mark write cloth-1.obj, cloth0.obj and cloth1.obj. Where
// the numbers follow on one another if the dash is a sign, what is meant cannot be told.
void require_clear_dashes(const std::map<FrameName, Frames>& sequences, const FrameName& wanted) {
  const bool dashed = wanted.before.ends_with('-');
  FrameName other = wanted;
  if (dashed)
    other.before.pop_back();
  else
    other.before += '-';
  if (!joins_words(dashed ? other.before : wanted.before)) return;
  const auto mine = sequences.find(wanted), others = sequences.find(other);
  if (mine == sequences.end() || others == sequences.end()) return;
  const Frames &above = dashed ? others->second : mine->second,
               &below = dashed ? mine->second : others->second;
  std::set<std::int64_t> numbers;
  for (const auto& [number, file] : above) numbers.insert(number);
  for (const auto& [number, file] : below) numbers.insert(-number);
  const bool one_row = numbers.size() == above.size() + below.size() &&
                       *numbers.rbegin() - *numbers.begin() + 1 == static_cast<std::int64_t>(numbers.size());
  if (one_row)
    throw InputError(
        "whether the dash of " + below.begin()->second.filename().string() +
        " is a sign cannot be told beside " + above.begin()->second.filename().string() +
        "; write a point before the numbers, as in cloth.-1.obj, or move one sequence elsewhere");
}

// A name in which a mark stands for each number.
std::string without_numbers(const fs::path& path) {
  std::string shape;
  bool in_number = false;
  for (const char c : path.stem().string()) {
    const bool digit = c >= '0' && c <= '9';
    if (!digit || !in_number) shape += digit ? '#' : c;
    in_number = digit;
  }
  return shape;
}

// What to note of a file that is alone by its last number, where others differ from it in an earlier number,
// as w_0001_v2.obj and w_0002_v2.obj do.
std::string note_on_other_numbers(const fs::path& path, const std::vector<fs::path>& alike) {
  std::size_t others = 0;
  fs::path first;
  for (const fs::path& file : alike) {
    if (file.filename() == path.filename() || without_numbers(file) != without_numbers(path)) continue;
    if (others++ == 0 || file < first) first = file;
  }
  if (others == 0) return {};
  return "beside it " +
         (others == 1 ? "lies 1 file that differs" : "lie " + std::to_string(others) + " files that differ") +
         " in a number before the last, as " + first.filename().string() +
         " does; for frames of one sequence, let their number be the last in their names";
}

// Returns the first file of the one sequence, or the one cache, that a folder holds.
fs::path sequence_in_folder(const fs::path& folder) {
  const std::vector<fs::path> files = files_in(folder);
  std::set<fs::path> found, faces_of_caches;
  for (const fs::path& file : files)
    if (is_cache(file)) {
      found.insert(file);
      faces_of_caches.insert(fs::path(file).replace_extension(".obj"));
    }
  std::vector<fs::path> frames;
  for (const fs::path& file : files) {
    if (!is_mesh_sequence_file(file) || is_cache(file) || faces_of_caches.contains(file)) continue;
    if (cut(file))
      frames.push_back(file);
    else
      found.insert(file);
  }
  for (const auto& [name, numbered] : sequences_in(frames)) found.insert(numbered.begin()->second);
  if (found.empty())
    throw InputError(
        "is a folder without OBJ or PLY files and without a PC2 or MDD cache; name a model file, or a folder "
        "with one sequence of frames");
  if (found.size() > 1)
    throw InputError("is a folder with " + std::to_string(found.size()) + " sequences, such as those of " +
                     found.begin()->filename().string() + " and " +
                     std::next(found.begin())->filename().string() +
                     "; name one file of the sequence that is meant");
  return *found.begin();
}

}  // namespace

bool is_mesh_sequence_file(const fs::path& path) {
  const std::string extension = in_lower_case(path.extension().string());
  return extension == ".obj" || extension == ".ply" || is_cache(path);
}

SequenceFiles files_of_sequence(const fs::path& path) {
  const auto wanted = cut(path);
  if (!wanted) return {{path}};
  std::vector<fs::path> alike;
  for (const fs::path& file : files_in(path.has_parent_path() ? path.parent_path() : fs::path(".")))
    if (in_lower_case(file.extension().string()) == in_lower_case(path.extension().string()))
      alike.push_back(file);
  const std::map<FrameName, Frames> sequences = sequences_in(alike);
  require_clear_dashes(sequences, wanted->first);
  const auto frames = sequences.find(wanted->first);
  if (frames == sequences.end()) return {{path}};  // it is not in its folder: reading it says why
  SequenceFiles sequence;
  const std::int64_t first = frames->second.begin()->first;
  for (const auto& [number, file] : frames->second) {
    const std::int64_t expected = first + static_cast<std::int64_t>(sequence.files.size());
    if (number < expected)
      throw InputError("frame " + std::to_string(number) + " is there twice, as " +
                       sequence.files.back().filename().string() + " and " + file.filename().string() +
                       "; remove one");
    if (number != expected)
      throw InputError("frame " + std::to_string(expected) + " of its sequence is missing before " +
                       file.filename().string() + "; export it again");
    sequence.files.push_back(file);
  }
  sequence.first_frame = static_cast<double>(first);
  if (sequence.files.size() == 1) sequence.note = note_on_other_numbers(path, alike);
  return sequence;
}

fs::path sequence_file(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error) ? sequence_in_folder(path) : path;
}

}  // namespace cscd::scenes
