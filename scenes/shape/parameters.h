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

// The kinds of value that a parameter of a shape or an effect may have.
enum class ParameterKind { number, integer, vector, table, text, objects };

struct ParameterRange {
  double least = std::numeric_limits<double>::lowest(), most = std::numeric_limits<double>::max();
};

// One parameter that a shape or an effect takes.
struct ParameterRow {
  std::string_view name;  // "*" stands for any name that no other row has, such as the name of a bone
  ParameterKind kind;
  // Such as "length" or "1 / frame"; empty for a count, a share, a direction or a text. A length is one of
  // the scene's own, and the mean edge is that of the shape at rest. A table names the units of its columns.
  std::string_view unit = "";
  std::string_view meaning;  // in one line, with what happens without a parameter that has no default
  bool required = true;
  ParameterRange range = {};                 // of a number or an integer
  std::size_t columns = 0;                   // columns of a table
  std::vector<double> otherwise = {};        // default: one number, or three for a vector; empty for none
  std::span<const ParameterRow> items = {};  // the parameters of each object of a list

  ParameterRow optional() const;                          // the same parameter, not required
  ParameterRow or_else(std::vector<double> value) const;  // the same parameter with a default
};
ParameterRow number_row(std::string_view name, std::string_view unit, std::string_view meaning,
                        ParameterRange range = {});
ParameterRow integer_row(std::string_view name, std::string_view unit, std::string_view meaning,
                         ParameterRange range = {});
ParameterRow vector_row(std::string_view name, std::string_view unit, std::string_view meaning);
ParameterRow table_row(std::string_view name, std::string_view unit, std::size_t columns,
                       std::string_view meaning);
ParameterRow text_row(std::string_view name, std::string_view meaning);
ParameterRow objects_row(std::string_view name, std::string_view meaning,
                         std::span<const ParameterRow> items);
std::string_view to_string(ParameterKind kind);

// Named values from a scene file, independent of the file's format. `where` ("scene rope, effect
// skinning_linear") begins the texts of errors.
class Parameters {
 public:
  using Table = std::vector<std::vector<double>>;
  using Value = std::variant<double, std::vector<double>, Table, std::string, std::vector<Parameters>>;

  Parameters() = default;
  Parameters(std::string where, std::map<std::string, Value, std::less<>> values)
      : where_(std::move(where)), values_(std::move(values)) {}

  const std::string& where() const { return where_; }
  bool has(std::string_view name) const { return values_.find(name) != values_.end(); }

  // Return the value of that name, or `otherwise` if it is given and the value is missing. They throw
  // InputError if the value is missing without an `otherwise`, is not finite, or is of another kind.
  double number(std::string_view name) const;
  double number(std::string_view name, double otherwise) const;
  int integer(std::string_view name) const;
  Vec3 vector(std::string_view name) const;
  Vec3 vector(std::string_view name, const Vec3& otherwise) const;
  const std::string& text(std::string_view name) const;
  const Table& table(std::string_view name) const;  // rows of numbers
  const std::vector<Parameters>& objects(std::string_view name) const;

  const std::map<std::string, Value, std::less<>>& values() const { return values_; }

  // A copy with one value set.
  Parameters with(const std::string& name, Value value) const;

 private:
  const Value& at(std::string_view name) const;
  std::string where_;
  std::map<std::string, Value, std::less<>> values_;
};

// Returns the parameters with the defaults of their rows where they are missing, in the objects of lists too.
// Throws InputError if a parameter has no row, is missing although its row requires it, is of another kind,
// or is out of its range. The error names the first such parameter.
Parameters checked(const Parameters& parameters, std::span<const ParameterRow> rows);

}  // namespace cscd::scenes
