#pragma once

#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/vec3.h"

namespace cscd::scenes {

// What a parameter of a shape or an effect may be.
enum class ParameterKind { number, integer, vector, table, text, objects };

// One parameter that a shape or an effect takes.
struct ParameterRow {
  std::string_view name;  // "*" for any name that no other row has: a bone's, say
  ParameterKind kind;
  std::string_view meaning;  // with units, in a line
  bool required = true;
  double least = std::numeric_limits<double>::lowest();  // of a number or an integer
  double most = std::numeric_limits<double>::max();
  std::size_t columns = 0;  // of a table
};

// Named values out of a scene file, without the file's format. `where` ("scene rope, effect skinning_linear")
// begins the error texts.
class Parameters {
 public:
  using Table = std::vector<std::vector<double>>;
  using Value = std::variant<double, std::vector<double>, Table, std::string, std::vector<Parameters>>;

  Parameters() = default;
  Parameters(std::string where, std::map<std::string, Value, std::less<>> values)
      : where_(std::move(where)), values_(std::move(values)) {}

  const std::string& where() const { return where_; }
  bool has(std::string_view name) const { return values_.find(name) != values_.end(); }

  // Each throws InputError when the value is missing or of another kind.
  double number(std::string_view name) const;
  double number(std::string_view name, double otherwise) const;
  int integer(std::string_view name) const;
  int integer(std::string_view name, int otherwise) const;
  Vec3 vector(std::string_view name) const;
  Vec3 vector(std::string_view name, const Vec3& otherwise) const;
  const std::string& text(std::string_view name) const;
  const Table& table(std::string_view name) const;  // rows of numbers
  const std::vector<Parameters>& objects(std::string_view name) const;

  const std::map<std::string, Value, std::less<>>& values() const { return values_; }

  // The same but for one value.
  Parameters with(const std::string& name, Value value) const;

 private:
  const Value& at(std::string_view name) const;
  std::string where_;
  std::map<std::string, Value, std::less<>> values_;
};

// Throws InputError that names the first parameter which no row knows, which is missing, of another kind, or
// out of its range.
void check(const Parameters& parameters, std::span<const ParameterRow> rows);

}  // namespace cscd::scenes
