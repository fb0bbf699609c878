#include "scenes/character/source_map.h"

#include <fstream>

#include "core/base/error.h"

namespace cscd::scenes {
namespace {

// Numbers are stored as they lie in memory, because writer and reader are one build on one machine.
using Number = std::int32_t;
constexpr std::size_t kNumbersOfTriangle = 4;

}  // namespace

void write_source_map(const SourceMap& map, const std::filesystem::path& path) {
  std::vector<Number> numbers;
  numbers.reserve(kNumbersOfTriangle * map.triangle.size() + map.bone.size());
  for (const SourceMap::Corners& corners : map.triangle) {
    numbers.push_back(corners.part);
    numbers.insert(numbers.end(), corners.vertex.begin(), corners.vertex.end());
  }
  numbers.insert(numbers.end(), map.bone.begin(), map.bone.end());
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(numbers.data()),
             static_cast<std::streamsize>(numbers.size() * sizeof(Number)));
  file.close();
  if (!file) throw InputError("where its vertices come from cannot be written; is the disk full?");
}

SourceMap read_source_map(const std::filesystem::path& path, const SourceMapSizes& sizes) {
  std::vector<Number> numbers(kNumbersOfTriangle * sizes.triangles + sizes.vertices);
  const std::size_t bytes = numbers.size() * sizeof(Number);
  std::error_code error;
  std::ifstream file(path, std::ios::binary);
  if (std::filesystem::file_size(path, error) != bytes || error ||
      !file.read(reinterpret_cast<char*>(numbers.data()), static_cast<std::streamsize>(bytes)))
    throw InputError("source map: does not fit the surface");
  const auto checked = [](Number number, std::size_t count) {
    if (number < -1 || number >= static_cast<std::int64_t>(count))
      throw InputError("source map: " + std::to_string(number) + " is outside [-1, " + std::to_string(count) +
                       ")");
    return number;
  };
  SourceMap map;
  auto next = numbers.begin();
  map.triangle.reserve(sizes.triangles);
  for (std::size_t t = 0; t < sizes.triangles; ++t, next += kNumbersOfTriangle)
    map.triangle.push_back({checked(next[0], sizes.parts), {next[1], next[2], next[3]}});
  map.bone.reserve(sizes.vertices);
  for (; next != numbers.end(); ++next) map.bone.push_back(checked(*next, sizes.bones));
  return map;
}

}  // namespace cscd::scenes
