// cscd-import MODEL CACHE.h5 REPORT SOURCES [options]: turns a model file into a point cache, a report and
// a source map. `cscd` runs this program under limits (bench/inputs/import.h), so that a reader of model
// files never runs in the program that answers queries.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <new>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "scenes/base/temporaries.h"
#include "scenes/character/report.h"
#include "scenes/exchange/mesh_sequence.h"
#include "scenes/import/convert.h"
#include "scenes/import/read_model.h"

namespace {

constexpr int kBadInput = 2;
constexpr char kNoMemory[] = "does not fit into the memory that imports may use; raise --import-memory";

int complain(const std::string& what) {
  std::fprintf(stderr, "%s\n", cscd::scenes::printable(what, 1000).c_str());
  return kBadInput;
}

// Ends the process instead of throwing. assimp may catch bad_alloc and go on without the data that did not
// fit, and the file would then seem to hold no triangles.
[[noreturn]] void end_without_memory() {
  std::fprintf(stderr, "%s\n", kNoMemory);
  std::_Exit(kBadInput);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace cscd::scenes;
  std::set_new_handler(end_without_memory);
  cscd::remove_temporaries_at_signals();
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() < 4)
    return complain("usage: cscd-import MODEL CACHE.h5 REPORT SOURCES [options]; run by cscd");
  try {
    const CharacterLimits limits;
    const ImportOptions options = parse_arguments(std::span(words).subspan(4));
    const ImportReport report =
        is_mesh_sequence(words[0])
            ? import_sequence(words[0], options, limits, words[1], words[3])
            : convert(read_model(words[0], limits), options, limits, words[1], words[3]);
    std::ofstream out(words[2], std::ios::binary);
    out << to_text(report);
    out.close();
    return out ? 0 : complain("its report cannot be written; choose another place for temporary files");
  } catch (const cscd::InputError& error) {
    return complain(error.what());
  } catch (const std::bad_alloc&) {
    return complain(kNoMemory);
  } catch (const std::exception& error) {
    return complain(std::string("cannot be imported: ") + error.what());
  }
}
