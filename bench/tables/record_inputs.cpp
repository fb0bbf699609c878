#include "bench/tables/record_inputs.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "bench/output/data.h"
#include "core/base/error.h"
#include "scenes/base/files_in.h"

namespace cscd::bench {
namespace {

namespace fs = std::filesystem;

// The schema that JSON names; empty where it names none.
std::string schema_of(const nlohmann::ordered_json& document) {
  const auto schema =
      document.is_object() ? document.value("schema", nlohmann::ordered_json()) : nlohmann::ordered_json();
  return schema.is_string() ? schema.get<std::string>() : "";
}

// Where a scene stands among others: the paper's scenes, their variants with contacts, all others.
std::size_t place_of(const std::string& scene) {
  const nlohmann::ordered_json published = data_json("published.json");
  std::size_t place = 0;
  for (const auto& [name, sizes] : published.at("scenes").items()) {
    if (scene == name) return place;
    if (scene == name + "_contact") return place + 100;
    ++place;
  }
  return 200;
}

}  // namespace

RecordFiles record_files(const std::vector<std::string>& named, const std::vector<std::string>& wanted,
                         bool any) {
  RecordFiles files;
  std::string left_out;  // said only where something is left
  const auto add = [&](const fs::path& file, bool named_itself) {
    nlohmann::ordered_json document = read_document(file);
    const std::string schema = schema_of(document);
    const auto kind = std::ranges::find_if(
        wanted, [&](const std::string& one) { return schema.starts_with("cscd." + one + "/"); });
    if (kind != wanted.end()) {
      files[*kind].push_back({file, std::move(document)});
    } else if (named_itself) {
      if (!schema.starts_with("cscd."))
        throw InputError("record " + file.string() + ": is no record; name what cscd run wrote");
      left_out += "left out: " + file.string() + " is no record of a run (" + schema + ")\n";
    }
  };
  for (const std::string& name : named) {
    std::error_code unknown;
    if (!fs::is_directory(name, unknown)) {
      add(name, true);
      continue;
    }
    for (const fs::path& file : files_in(name, {".json", ".json.gz"})) add(file, false);
  }
  if (any ? files.empty() : !files.contains(wanted.front()))
    throw InputError((named.size() == 1 ? named.front() + " holds no" : "none of these holds a") +
                     " record of cscd run; name what cscd run --json wrote, or a folder of it");
  std::fputs(left_out.c_str(), stderr);
  return files;
}

std::vector<Record> read_records(std::vector<RecordFile>& files) {
  std::vector<std::pair<Record, RecordFile>> read;
  for (RecordFile& file : files) {
    const fs::path& path = file.path;
    Record record = record_from(file.document, path.string());
    if (!record.verification.ok())
      throw InputError("record " + path.string() +
                       ": its verification failed, so it holds no times; mend the strategy and "
                       "run again");
    for (const auto& [other, other_file] : read)
      if (other.scene.name == record.scene.name && other.pipeline == record.pipeline)
        throw InputError("record " + path.string() + ": a second record of scene " + record.scene.name +
                         " in the pipeline " + std::string(to_string(record.pipeline)) +
                         "; give one a scene and pipeline");
    read.emplace_back(std::move(record), std::move(file));
  }
  std::ranges::stable_sort(read, {}, [](const auto& one) {
    return std::pair(place_of(one.first.scene.name), one.first.pipeline == Pipeline::published);
  });
  std::vector<Record> records;
  files.clear();
  for (auto& [record, file] : read) {
    records.push_back(std::move(record));
    files.push_back(std::move(file));
  }
  return records;
}

}  // namespace cscd::bench
