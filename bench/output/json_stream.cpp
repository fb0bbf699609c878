#include "bench/output/json_stream.h"

namespace cscd::bench {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 16;  // bytes that are handed on together

std::string text_of(const nlohmann::json& value) {
  return value.dump(1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

void JsonStream::say(std::string_view text) {
  room_ += text;
  if (room_.size() < kPiece) return;
  write_(room_);
  room_.clear();
}

// Separates what comes from what came before it on this level.
void JsonStream::next_line() {
  say(levels_.back().is_empty ? "\n" : ",\n");
  say(std::string(levels_.size(), ' '));
  levels_.back().is_empty = false;
}

void JsonStream::begin_value() {
  if (!levels_.empty() && !levels_.back().is_object) next_line();
}

void JsonStream::key(std::string_view name) {
  next_line();
  say(text_of(name) + ": ");
}

void JsonStream::value(const nlohmann::json& value) {
  begin_value();
  // Within texts, a new line is written as an escape.
  for (const char c : text_of(value)) {
    say(std::string_view(&c, 1));
    if (c == '\n') say(std::string(levels_.size(), ' '));
  }
}

void JsonStream::begin(char bracket) {
  begin_value();
  say(std::string_view(&bracket, 1));
  levels_.push_back({bracket == '{', true});
}

void JsonStream::end() {
  const Level ended = levels_.back();
  levels_.pop_back();
  if (!ended.is_empty) say("\n" + std::string(levels_.size(), ' '));
  say(ended.is_object ? "}" : "]");
}

void JsonStream::finish() {
  write_(room_ + "\n");
  room_.clear();
}

}  // namespace cscd::bench
