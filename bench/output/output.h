#pragma once

#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "bench/output/gzip.h"
#include "scenes/base/output_target.h"

namespace cscd::bench {

// Nobody reads standard output any more (`| head -1`). The program ends without a word.
class NobodyReads : public std::exception {
  const char* what() const noexcept override { return "nobody reads standard output"; }
};

// Where the answer of a command goes. It is opened before any work begins, so that an unwritable place is
// found at once. The name decides:
// - `-` (and /dev/stdout) is standard output. From then on, what is printed goes to standard error, so that
//   standard output holds the answer and nothing else.
// - A device or a pipe is written to as it is. It is opened when the answer is there.
// - A file appears whole or not at all. A symbolic link stays, and its target is what appears.
// - A file whose name ends in .gz after its extension is compressed with gzip.
// - An empty name is nowhere: an output that is not asked for takes whatever it is given.
class OutputFile {
 public:
  // Throws InputError if a file stands there (unless `force`), if nothing can be written there, or if the
  // name of a file ends in another extension than `extension`; a name without any is accepted.
  OutputFile(std::filesystem::path path, bool force, std::string_view extension = ".json");
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  // Takes the next piece of the content. Standard output, devices and pipes get nothing before the end.
  // Throws InputError if the place does not take it.
  void write(std::string_view piece);
  // Ends the content. Throws as write() does, and NobodyReads for a standard output that was closed.
  void commit();
  // The whole content at once.
  void commit(std::string_view content) {
    write(content);
    commit();
  }

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void copy_to(int descriptor);

  std::filesystem::path path_;
  int standard_output_ = -1;
  std::optional<UnfinishedFile> file_;
  std::optional<GzipStream> gzip_;
  std::unique_ptr<std::FILE, CloseFile> waiting_;  // for a place that gets nothing before the end
};

// Whether an output's name stands for standard output.
bool is_standard_output(const std::filesystem::path& path);

// Makes a folder where it is missing. Throws InputError, which says that `option` names it, where it cannot
// be made.
void make_folder(const std::filesystem::path& folder, std::string_view option);

// The extension of an output's name decides the format that is written. Returns it in lower case with its
// dot, one of `known` (".h5", ".glb", ...). Throws InputError, which lists the known ones, for any other
// extension and for a name without one.
std::string require_format(const std::filesystem::path& output, std::span<const std::string_view> known);

}  // namespace cscd::bench
