#include "scenes/shape/parameters.h"

#include <cmath>
#include <sstream>

#include "core/base/error.h"

namespace cscd::scenes {
namespace {

[[noreturn]] void refuse(const Parameters& parameters, std::string_view name, const std::string& what) {
  throw InputError(parameters.where() + ": parameter " + std::string(name) + " " + what);
}

std::string names(std::span<const ParameterRow> rows) {
  std::string text;
  for (const ParameterRow& row : rows) text += (text.empty() ? "" : ", ") + std::string(row.name);
  return text.empty() ? "none" : text;
}

std::string shown(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

// Returns the row of a name, or else the row of all names, or null.
const ParameterRow* row_of(std::string_view name, std::span<const ParameterRow> rows) {
  const ParameterRow* known = nullptr;
  for (const ParameterRow& row : rows)
    if (row.name == name || (row.name == "*" && !known)) known = &row;
  return known;
}

void check_value(const Parameters& parameters, std::string_view name, const ParameterRow& row) {
  switch (row.kind) {
    case ParameterKind::integer:
      (void)parameters.integer(name);
      [[fallthrough]];
    case ParameterKind::number: {
      const double value = parameters.number(name);
      if (value < row.range.least || value > row.range.most)
        refuse(parameters, name,
               "is " + shown(value) + "; it must be in [" + shown(row.range.least) + ", " +
                   shown(row.range.most) + "]");
      break;
    }
    case ParameterKind::vector:
      (void)parameters.vector(name);
      break;
    case ParameterKind::text:
      (void)parameters.text(name);
      break;
    case ParameterKind::objects:
      (void)parameters.objects(name);
      break;
    case ParameterKind::table:
      for (const std::vector<double>& line : parameters.table(name))
        if (line.size() != row.columns)
          refuse(parameters, name,
                 "has a row of " + std::to_string(line.size()) + " numbers; give " +
                     std::to_string(row.columns) + " (" + std::string(row.meaning) + ")");
      break;
  }
}

}  // namespace

std::string_view to_string(ParameterKind kind) {
  switch (kind) {
    case ParameterKind::number:
      return "number";
    case ParameterKind::integer:
      return "whole number";
    case ParameterKind::vector:
      return "vector";
    case ParameterKind::table:
      return "table";
    case ParameterKind::text:
      return "text";
    case ParameterKind::objects:
      break;
  }
  return "objects";
}

Parameters Parameters::with(const std::string& name, Value value) const {
  Parameters changed = *this;
  changed.values_.insert_or_assign(name, std::move(value));
  return changed;
}

const Parameters::Value& Parameters::at(std::string_view name) const {
  const auto found = values_.find(name);
  if (found == values_.end()) refuse(*this, name, "is missing; add it to the scene file");
  return found->second;
}

double Parameters::number(std::string_view name) const {
  const auto* value = std::get_if<double>(&at(name));
  if (!value || !std::isfinite(*value)) refuse(*this, name, "must be a finite number");
  return *value;
}

double Parameters::number(std::string_view name, double otherwise) const {
  return has(name) ? number(name) : otherwise;
}

int Parameters::integer(std::string_view name) const {
  const double value = number(name);
  if (value != std::floor(value) || std::abs(value) > 1e9) refuse(*this, name, "must be a whole number");
  return static_cast<int>(value);
}

Vec3 Parameters::vector(std::string_view name) const {
  const auto* value = std::get_if<std::vector<double>>(&at(name));
  if (!value || value->size() != 3) refuse(*this, name, "must be a list of three numbers");
  const Vec3 vector((*value)[0], (*value)[1], (*value)[2]);
  if (!vector.allFinite()) refuse(*this, name, "must be finite");
  return vector;
}

Vec3 Parameters::vector(std::string_view name, const Vec3& otherwise) const {
  return has(name) ? vector(name) : otherwise;
}

const std::string& Parameters::text(std::string_view name) const {
  const auto* value = std::get_if<std::string>(&at(name));
  if (!value) refuse(*this, name, "must be a text");
  return *value;
}

const Parameters::Table& Parameters::table(std::string_view name) const {
  const auto* value = std::get_if<Table>(&at(name));
  if (!value) refuse(*this, name, "must be a list of lists of numbers");
  return *value;
}

const std::vector<Parameters>& Parameters::objects(std::string_view name) const {
  const auto* value = std::get_if<std::vector<Parameters>>(&at(name));
  if (!value) refuse(*this, name, "must be a list of objects");
  return *value;
}

Parameters checked(const Parameters& parameters, std::span<const ParameterRow> rows) {
  // All names are looked at before any value: a misspelt name is the likelier mistake, and explains others.
  for (const auto& [name, value] : parameters.values())
    if (row_of(name, rows) == nullptr) refuse(parameters, name, "is unknown; known are: " + names(rows));
  Parameters filled = parameters;
  for (const auto& [name, value] : parameters.values()) {
    const ParameterRow& row = *row_of(name, rows);
    check_value(parameters, name, row);
    if (row.kind != ParameterKind::objects) continue;
    std::vector<Parameters> objects;
    for (const Parameters& object : parameters.objects(name)) objects.push_back(checked(object, row.items));
    filled = filled.with(name, std::move(objects));
  }
  for (const ParameterRow& row : rows) {
    if (parameters.has(row.name)) continue;
    if (row.required)
      refuse(parameters, row.name, "is missing (" + std::string(row.meaning) + "); add it to the scene file");
    if (row.otherwise.size() == 1)
      filled = filled.with(std::string(row.name), row.otherwise.front());
    else if (!row.otherwise.empty())
      filled = filled.with(std::string(row.name), row.otherwise);
  }
  return filled;
}

ParameterRow ParameterRow::optional() const {
  ParameterRow row = *this;
  row.required = false;
  return row;
}

ParameterRow ParameterRow::or_else(std::vector<double> value) const {
  ParameterRow row = optional();
  row.otherwise = std::move(value);
  return row;
}

ParameterRow number_row(std::string_view name, std::string_view unit, std::string_view meaning,
                        ParameterRange range) {
  return {.name = name, .kind = ParameterKind::number, .unit = unit, .meaning = meaning, .range = range};
}

ParameterRow integer_row(std::string_view name, std::string_view unit, std::string_view meaning,
                         ParameterRange range) {
  return {.name = name, .kind = ParameterKind::integer, .unit = unit, .meaning = meaning, .range = range};
}

ParameterRow vector_row(std::string_view name, std::string_view unit, std::string_view meaning) {
  return {.name = name, .kind = ParameterKind::vector, .unit = unit, .meaning = meaning};
}

ParameterRow table_row(std::string_view name, std::string_view unit, std::size_t columns,
                       std::string_view meaning) {
  return {.name = name, .kind = ParameterKind::table, .unit = unit, .meaning = meaning, .columns = columns};
}

ParameterRow text_row(std::string_view name, std::string_view meaning) {
  return {.name = name, .kind = ParameterKind::text, .meaning = meaning};
}

ParameterRow objects_row(std::string_view name, std::string_view meaning,
                         std::span<const ParameterRow> items) {
  return {.name = name, .kind = ParameterKind::objects, .meaning = meaning, .items = items};
}

}  // namespace cscd::scenes
