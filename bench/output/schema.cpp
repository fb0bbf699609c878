#include "bench/output/schema.h"

#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include "bench/output/data.h"

namespace cscd::bench {

std::string schema_violation(const nlohmann::ordered_json& document, std::string_view schema_file) {
  // The adapter knows the unordered kind only.
  const nlohmann::json definition(data_json(schema_file)), plain(document);
  valijson::Schema schema;
  valijson::SchemaParser parser;
  parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(definition), schema);
  valijson::Validator validator;
  valijson::ValidationResults results;
  if (validator.validate(schema, valijson::adapters::NlohmannJsonAdapter(plain), &results)) return "";
  valijson::ValidationResults::Error error;
  results.popError(error);
  std::string place;
  for (const std::string& step : error.context) place += step;
  return place + ": " + error.description;
}

}  // namespace cscd::bench
