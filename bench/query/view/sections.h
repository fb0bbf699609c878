#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace cscd::bench {

// Arrays of numbers for a page, each compressed by itself, one behind the other. A table says where each
// array lies and of what numbers it is.
class Sections {
 public:
  // Adds an array of numbers in this machine's order of bytes, which is the order of every browser's machine.
  template <class T>
  void add(const std::string& name, const std::vector<T>& values) {
    static_assert(std::is_arithmetic_v<T>);
    const char* kind = std::is_floating_point_v<T> ? "f" : std::is_signed_v<T> ? "i" : "u";
    add_bytes(name, kind + std::to_string(8 * sizeof(T)),
              {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
  }

  // Begins the names of all arrays that are added from here on: the arrays of one clip of several.
  void set_prefix(std::string prefix) { prefix_ = std::move(prefix); }

  // [{name, type, raw, offset, bytes}]: bytes before and after compression, and where the array begins.
  const nlohmann::json& table() const { return table_; }
  const std::string& bytes() const { return bytes_; }

 private:
  void add_bytes(const std::string& name, const std::string& type, std::string_view raw);

  nlohmann::json table_ = nlohmann::json::array();
  std::string bytes_, prefix_;
};

// Writes bytes as base64 (RFC 4648).
std::string base64(std::string_view bytes);

}  // namespace cscd::bench
