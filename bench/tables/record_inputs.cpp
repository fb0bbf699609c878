#include "bench/tables/record_inputs.h"

#include "core/base/error.h"

namespace cscd::bench {

std::vector<Record> read_records(const std::vector<std::string>& paths) {
  std::vector<Record> records;
  for (const std::string& path : paths) {
    Record record = read_record(path);
    if (!record.verification.ok())
      throw InputError("record " + path +
                       ": its verification failed, so it holds no times; mend the strategy and "
                       "run again");
    for (const Record& other : records)
      if (other.scene.name == record.scene.name && other.pipeline == record.pipeline)
        throw InputError("record " + path + ": a second record of scene " + record.scene.name +
                         " in the pipeline " + std::string(to_string(record.pipeline)) +
                         "; give one a scene and pipeline");
    records.push_back(std::move(record));
  }
  return records;
}

}  // namespace cscd::bench
