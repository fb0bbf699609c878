#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace cscd::bench {

// Writes one JSON document piece by piece, so that it need not fit into memory. The text is that of
// nlohmann::json::dump(1), if keys come in ascending order, and bytes that are no UTF-8 are replaced.
class JsonStream {
 public:
  // Hands the text on in pieces. The last ones come with finish().
  explicit JsonStream(std::function<void(std::string_view)> write) : write_(std::move(write)) {}

  // A value follows each key of an object. In an array, values follow one another.
  void key(std::string_view name);
  void value(const nlohmann::json& value);
  void begin_object() { begin('{'); }
  void begin_array() { begin('['); }
  void end();
  // Ends the document with a new line.
  void finish();

 private:
  struct Level {
    bool is_object, is_empty;
  };
  void begin(char bracket);
  void begin_value();
  void next_line();
  void say(std::string_view text);

  std::function<void(std::string_view)> write_;
  std::string room_;
  std::vector<Level> levels_;
};

}  // namespace cscd::bench
